// importing/surface_field.h - computes the bone's field from "which voxels are inside": a ramp of
// the distance to a surface that runs between the voxels. Internal to importing.
//
// Where an edge of the grid goes from inside to outside, there is a surface point with a normal.
// The distance of a voxel is the mean of its distances to the tangent planes of these points,
// weighted by nearness (implicit moving least squares: Kolluri 2005, Shen et al. 2004). So the
// surface passes through the points of a grey scan, and the staircase of a label map is smoothed.
// Cost: only bricks near a surface are computed, with two workers.
// Units: voxels. Thread: any.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// Either grey values with an iso-level, or labels with a list of the solid ones.
struct InsideGrid {
  math::Ijk size = {0, 0, 0};
  const std::int16_t* grey = nullptr;  // (x fastest); inside: >= iso
  float iso = 0;
  const std::uint8_t* labels = nullptr;  // (x fastest)
  const std::uint8_t* share = nullptr;   // solid share of the voxel, 0..255; null: all or nothing
  std::array<bool, 256> solid{};         // by label
  std::array<volume::TissueId, 256> tissue{};  // by label; 0 is air
  // softness of the weights: the larger, the more surface points share in one distance, see
  // surface_field.cpp; labels 8, noisy grey 4, clean grey 1
  float soft = 8;
  // Layers of air that the bone's grid has at both ends of each axis around these voxels. There the
  // bone ends in a flat face half a voxel beyond the last voxel; without them the field breaks off.
  math::Ijk margin = {0, 0, 0};
  int law = 2;  // Recipe::bone_law
  [[nodiscard]] bool inside(std::size_t v) const {
    if (grey != nullptr) return static_cast<float>(grey[v]) >= iso;
    return share != nullptr ? share[v] >= 128 : solid[labels[v]];
  }
};

// Tissue and stored intensity of a grey voxel.
struct GreyTissue {
  double step = 1, zero = 0;  // HU = stored * step + zero
  bool by_hu = false;         // tissue by HU class; false: everything is tissue 1
};

// The ramp of a face half a voxel beyond the last voxel ends in the second layer of air.
inline constexpr int kMargin = 2;

// Sets the margin of each axis: kMargin where the surface comes so near to one of its ends that the
// ramp reaches it, otherwise 0. At both ends, so that the middle of the volume stays.
void leave_margins(InsideGrid& inside);

// grid: that of the bone, with its layers of air. nullptr: cancelled. Bricks without field and tissue take no memory.
[[nodiscard]] std::unique_ptr<volume::Bone> bone_from_inside(
    const volume::Grid& grid, volume::TissueTable tissues, const InsideGrid& inside,
    const GreyTissue& grey_tissue, std::size_t reserve_bricks, Progress& progress);

// Shifts the field of each tissue by a fraction of a voxel until its volume_of is the wanted one
// [voxel]; wanted < 0: no shift. Returns the shifts [voxel].
std::vector<double> restore_tissue_volumes(volume::Bone& bone,
                                           const std::vector<double>& wanted_voxels, int law = 2);

}  // namespace burr::importing
