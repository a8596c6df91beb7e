#include "burr/metrics/thinned.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "burr/metrics/cover.h"
#include "burr/metrics/solidity.h"
#include "burr/metrics/structure_patch.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kStep = 0.25;  // [voxel]

math::Ijk nearest(const Vec3& p) {
  return {static_cast<int>(std::floor(p.x() + 0.5)), static_cast<int>(std::floor(p.y() + 0.5)),
          static_cast<int>(std::floor(p.z() + 0.5))};
}

// Bone along n (grid axes) from a voxel of the canal to the cavity [m].
double wall_along(const Solidity& solidity, const VoxelSet& canal, const VoxelSet* cavity,
                  const Vec3& from, const Vec3& n, double cap) {
  const double h = solidity.grid().voxel;
  double bone = 0;
  // from a voxel behind the sample: a voxel of the surface stands in its ramp
  for (double l = 0.5 * kStep - 1; l * h < cap; l += kStep) {
    const Vec3 p = from + l * n;
    const Solidity::Pair sigma = solidity.at(p);
    bone += kStep * sigma.after;
    const math::Ijk v = nearest(p);
    const bool in_cavity = (sigma.before >= 0.5 && sigma.after <= 0) ||
                           (cavity != nullptr && sigma.after <= 0 && cavity->has(v));
    if (in_cavity && !canal.has(v)) return bone * h;
  }
  return kUnseen;
}

}  // namespace

Assessed<Thin> thinned(const volume::Bone& before, const volume::Bone& after, const VoxelSet& canal,
                       const VoxelSet* cavity, const Region& region, const Worked& worked,
                       const ThinnedSettings& settings) {
  const volume::Grid& grid = before.grid();
  if (std::string reason = too_coarse_for(grid.voxel, settings.thin); !reason.empty())
    return NotAssessable{std::move(reason)};
  const auto patch = patch_of(grid, canal, region, {settings.towards, settings.most_samples});
  if (!patch) return NotAssessable{patch.reason()};
  const Solidity solidity = Solidity::of_bone(before, after);
  std::vector<Layer> layers;
  for (const SurfaceSample& one : patch->samples) {
    const Vec3 n = grid.frame.q.conjugate() * one.normal;
    layers.push_back(
        {wall_along(solidity, canal, cavity, one.voxel.cast<double>(), n, settings.cap),
         static_cast<double>(one.faces), one.place});
  }
  return thin_layer(layers, worked, settings.thin, std::max(0.05e-3, 0.2 * grid.voxel));
}

}  // namespace burr::metrics
