#include "burr/thermal/matter.h"

#include <algorithm>
#include <cmath>

#include "burr/base/check.h"
#include "burr/volume/volume_of.h"

namespace burr::thermal {
namespace {

using math::Ijk;
using math::Vec3;
using volume::kBrickEdge;
using volume::TissueId;
using volume::TissueKind;

constexpr double kLeastShare = 1e-3;  // less is noise of the ramp, and would get hot at once

std::size_t inside_brick(int i, int j, int k) {
  return static_cast<std::size_t>(i + kBrickEdge * (j + kBrickEdge * k));
}

// The tissues of one cell and the amount of each.
struct Tally {
  std::array<TissueId, volume::kBrickVoxels> tissue;
  std::array<std::int64_t, volume::kBrickVoxels> units;  // of volume_of.h
  int count = 0;

  void add(TissueId which, std::int64_t more) {
    int n = 0;
    while (n < count && tissue[static_cast<std::size_t>(n)] != which) ++n;
    const auto at = static_cast<std::size_t>(n);
    if (n == count) {
      tissue[at] = which;
      units[at] = 0;
      ++count;
    }
    units[at] += more;
  }
};

}  // namespace

CellBox cells_around(const volume::Grid& grid, const math::Aabb& work, double requested_edge) {
  BURR_CHECK(!work.empty() && requested_edge > 0);
  CellBox box;
  while (box.voxels < kBrickEdge && 2 * box.voxels * grid.voxel <= requested_edge * (1 + 1e-9))
    box.voxels *= 2;
  box.edge = box.voxels * grid.voxel;

  math::Aabb around;
  for (int which = 0; which < 8; ++which) around.extend(grid.grid_from_world(work.corner(which)));
  for (int axis = 0; axis < 3; ++axis) {
    // a box meant to end between two cells must not get one more through a rounding error
    constexpr double kHair = 1e-6;
    const int all = (grid.size[axis] + box.voxels - 1) / box.voxels;
    const double lo = (around.lo[axis] + 0.5) / box.voxels + kHair;
    const double hi = (around.hi[axis] + 0.5) / box.voxels - kHair;
    const int first = static_cast<int>(std::clamp(std::floor(lo), 0.0, all - 1.0));
    const int last = static_cast<int>(std::clamp(std::ceil(hi), first + 1.0, double(all)));
    box.first[axis] = first * box.voxels;
    box.count[axis] = last - first;
  }
  box.row = static_cast<std::size_t>(box.count.x() + 2);
  box.slice = box.row * static_cast<std::size_t>(box.count.y() + 2);
  return box;
}

MatterReader::MatterReader(const volume::Bone& bone, const CellBox& box,
                           const HeatSettings& settings)
    : bone_(bone), box_(box) {
  for (std::size_t id = 0; id < kind_.size(); ++id) {
    kind_[id] = bone.tissues()[static_cast<TissueId>(id)].kind;
    material_[id] = kind_[id] == TissueKind::soft ? settings.soft : settings.bone;
  }
  for (const TissueMaterial& special : settings.special)
    material_[special.tissue] = special.material;
}

bool MatterReader::read(volume::BrickIndex brick, std::vector<Found>& found) {
  found.clear();
  const Ijk corner = bone_.brick_ijk(brick);
  const Ijk lowest = (corner - box_.first) / box_.voxels;  // both are whole cells
  const Ijk lo = lowest.cwiseMax(-Ijk::Ones());
  const Ijk end = (lowest.array() + kBrickEdge / box_.voxels).min(box_.count.array() + 1);
  if ((lo.array() >= end.array()).any()) return true;

  if (!bone_.copy_brick(brick, field_)) return false;
  for (int k = 0; k < kBrickEdge; ++k)
    for (int j = 0; j < kBrickEdge; ++j)
      for (int i = 0; i < kBrickEdge; ++i)
        tissue_[inside_brick(i, j, k)] =
            bone_.shared_tissue(corner.x() + i, corner.y() + j, corner.z() + k);

  for (int k = lo.z(); k < end.z(); ++k)
    for (int j = lo.y(); j < end.y(); ++j)
      for (int i = lo.x(); i < end.x(); ++i)
        found.push_back({{i, j, k}, matter_of((Ijk(i, j, k) - lowest) * box_.voxels)});
  return true;
}

// corner: the cell's first voxel inside the brick
Matter MatterReader::matter_of(const Ijk& corner) const {
  const auto each_voxel = [&](const auto& look) {
    for (int k = 0; k < box_.voxels; ++k)
      for (int j = 0; j < box_.voxels; ++j)
        for (int i = 0; i < box_.voxels; ++i)
          look(inside_brick(corner.x() + i, corner.y() + j, corner.z() + k));
  };
  bool any_soft = false;
  each_voxel([&](std::size_t v) { any_soft |= kind_[tissue_[v]] == TissueKind::soft; });

  Tally tally;
  each_voxel([&](std::size_t v) {
    const TissueId id = tissue_[v];
    // Beside soft tissue the bone ends between voxels: counted with its ramp, it would leave a gap
    // along the border, open to the coolant.
    if (kind_[id] == TissueKind::soft)
      tally.add(id, volume::kVoxelUnits);
    else if (any_soft)
      tally.add(id, field_.voxel[v] >= volume::kIso ? volume::kVoxelUnits : 0);
    else
      tally.add(id, volume::volume_units(std::int32_t{field_.voxel[v]}));
  });

  // near the surface the volume of a voxel may be slightly negative or above one voxel
  std::int64_t units = 0;
  for (int n = 0; n < tally.count; ++n)
    units += std::max(std::int64_t{0}, tally.units[static_cast<std::size_t>(n)]);
  const double full =
      static_cast<double>(volume::kVoxelUnits) * box_.voxels * box_.voxels * box_.voxels;
  Matter matter;
  matter.share = std::min(1.0, static_cast<double>(units) / full);
  if (matter.share < kLeastShare) return {};

  const double cell_m3 = box_.edge * box_.edge * box_.edge;
  for (int n = 0; n < tally.count; ++n) {
    const auto at = static_cast<std::size_t>(n);
    if (tally.units[at] <= 0) continue;
    const double part =
        matter.share * static_cast<double>(tally.units[at]) / static_cast<double>(units);
    const TissueId id = tally.tissue[at];
    matter.conductivity += part * material_[id].conductivity;
    matter.capacity += part * material_[id].capacity() * cell_m3;
    if (kind_[id] == TissueKind::air) continue;  // the bone's ramp outside its own label
    auto fresh = static_cast<float>(part);
    TissueId whose = id;
    for (std::size_t p = 0; p < kMostParts; ++p)
      if (matter.part[p] < fresh) {
        std::swap(matter.part[p], fresh);
        std::swap(matter.tissue[p], whose);
      }
  }
  return matter;
}

}  // namespace burr::thermal
