// importing/surface_field.h - from "which voxels are inside" to the bone's field: a ramp of the distance
// to a surface that runs between the voxels. Private to io.
//
// Where an edge of the grid goes from inside to outside there is a point of the surface with a
// normal. The distance of a voxel is the mean of its distances to the tangent planes there,
// weighted by nearness (implicit moving least squares: Kolluri 2005, Shen et al. 2004). So the
// surface goes through the points of a grey scan, and evens the staircase of a label map. Cost:
// bricks near a surface only, two workers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// One of the two: grey numbers with an iso-level, or labels with which of them are solid.
struct InsideGrid {
  math::Ijk size = {0, 0, 0};
  const std::int16_t* grey = nullptr;  // (x fastest); inside: >= iso
  float iso = 0;
  const std::uint8_t* labels = nullptr;  // (x fastest)
  const std::uint8_t* share = nullptr;  // how much of the voxel is solid, 0..255, or null: 0 or all
  std::array<bool, 256> solid{};        // by label
  std::array<volume::TissueId, 256> tissue{};  // by label; 0 is air
  // how many points of the surface make one distance, see surface_field.cpp; labels 8, noisy grey
  // 4, clean grey 1
  float soft = 8;
  [[nodiscard]] bool inside(std::size_t v) const {
    if (grey != nullptr) return static_cast<float>(grey[v]) >= iso;
    return share != nullptr ? share[v] >= 128 : solid[labels[v]];
  }
};

// What a grey voxel is made of and what number is kept of it.
struct GreyTissue {
  double step = 1, zero = 0;  // HU = stored * step + zero
  bool by_hu = false;         // else everything is tissue 1
};

// Null: cancelled. Bricks that hold neither field nor tissue take no room.
[[nodiscard]] std::unique_ptr<volume::Bone> bone_from_inside(
    const volume::Grid& grid, volume::TissueTable tissues, const InsideGrid& inside,
    const GreyTissue& grey_tissue, std::size_t reserve_bricks, Progress& progress);

// Shifts the field of each tissue, by a fraction of a voxel, until its volume_of is the wanted one
// [voxel]; wanted < 0: leave it. Tells the shifts [voxel].
std::vector<double> keep_volumes(volume::Bone& bone, const std::vector<double>& wanted_voxels);

}  // namespace burr::importing
