// importing/inside_grid.h - which voxels of a scan are inside the bone, as the surface is made of them, and how many
// layers of air the bone's grid has around them. Internal to importing.
//
// Units: voxels. Thread: any.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "burr/math/vec3.h"
#include "burr/volume/tissue.h"

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
  // surface_points.h; labels 8, noisy grey 4, clean grey 1
  float soft = 8;
  // Layers of air that the bone's grid has at both ends of each axis around these voxels. There the
  // bone ends in a flat face half a voxel beyond the last voxel; without them the field breaks off.
  math::Ijk margin = {0, 0, 0};
  int law = 2;  // BoneRecipe::bone_law
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

}  // namespace burr::importing
