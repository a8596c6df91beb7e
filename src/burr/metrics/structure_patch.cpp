#include "burr/metrics/structure_patch.h"

#include <cmath>
#include <string>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using math::Vec3;

int free_faces(const VoxelSet& set, const Ijk& v) {
  int faces = 0;
  for (int a = 0; a < 3; ++a)
    for (const int way : {-1, 1}) faces += set.has(v + way * Ijk::Unit(a)) ? 0 : 1;
  return faces;
}

bool at_border(const volume::Grid& grid, const Ijk& v) {
  return (v.array() < 1).any() || (v.array() >= grid.size.array() - 1).any();
}

// Out of the structure, grid axes; zero where it looks alike from all sides.
Vec3 outward(const volume::Grid& grid, const VoxelSet& set, const Ijk& v) {
  // beyond the grid a structure goes on as it ends there
  const auto inside = [&grid](const Ijk& w) -> Ijk {
    return w.cwiseMax(Ijk::Zero()).cwiseMin(grid.size - Ijk::Ones());
  };
  Ijk sum = Ijk::Zero();
  for (int dk = -2; dk <= 2; ++dk)
    for (int dj = -2; dj <= 2; ++dj)
      for (int di = -2; di <= 2; ++di)
        if (set.has(inside(v + Ijk(di, dj, dk)))) sum += Ijk(di, dj, dk);
  return math::normalized(Vec3(-sum.cast<double>()));
}

bool faces_any(const Vec3& normal, const std::vector<Vec3>& towards) {
  if (towards.empty()) return true;
  for (const Vec3& a : towards)
    if (math::dot(normal, math::normalized(a)) >= kSteepest) return true;
  return false;
}

}  // namespace

Assessed<Patch> patch_of(const volume::Grid& grid, const VoxelSet& structure, const Region& region,
                         const PatchSettings& settings) {
  if (structure.count() == 0)
    return NotAssessable{"the structure is not in this bone: no voxel has its label"};
  Patch patch;
  structure.for_each([&](const Ijk& v) {
    const int faces = free_faces(structure, v);
    if (faces == 0 || at_border(grid, v)) return;
    const Vec3 place = grid.world_from_grid(v.cast<double>());
    if (!contains(region, place)) return;
    const Vec3 n = outward(grid, structure, v), normal = grid.frame.q * n;
    if (!faces_any(normal, settings.towards)) return;
    const double spread = math::sum_of_three(std::abs(n.x()), std::abs(n.y()), std::abs(n.z()));
    const double area = faces * grid.voxel * grid.voxel / (spread > 0 ? spread : 1.5);
    patch.samples.push_back({v, place, normal, faces, area});
  });
  const std::size_t found = patch.samples.size();
  if (found < kFewestSamples)
    return NotAssessable{"only " + std::to_string(found) +
                         " samples of the structure's surface lie in the region and face the "
                         "surgeon; at least " +
                         std::to_string(kFewestSamples) + " are needed"};
  if (settings.most_samples > 0 && found > settings.most_samples) {
    patch.thinned = (found + settings.most_samples - 1) / settings.most_samples;
    std::size_t kept = 0;
    for (std::size_t n = 0; n < found; n += patch.thinned) patch.samples[kept++] = patch.samples[n];
    patch.samples.resize(kept);
    for (SurfaceSample& one : patch.samples) one.area *= static_cast<double>(patch.thinned);
  }
  return patch;
}

}  // namespace burr::metrics
