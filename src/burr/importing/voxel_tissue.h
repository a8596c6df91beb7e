// importing/voxel_tissue.h - the tissue of each voxel of a brick, and the intensity that the bone keeps of it. Internal to
// importing.
//
// Thread: any; a Target and a Desk belong to one worker.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/importing/inside_grid.h"
#include "burr/importing/surface_points.h"
#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// The brick being made; `field` is there before the tissue.
struct Target {
  volume::Field* field = nullptr;
  volume::TissueId* tissue = nullptr;
  std::int16_t* intensity = nullptr;
};

// first, of the functions below: of the brick, counted from the first voxel of the scan. room: voxels of the brick that are
// in the bone's grid.

// Tissue of label maps: a voxel's own, or for air on the ramp that of the nearest solid voxel.
void label_tissue(const InsideGrid& grid, const math::Ijk& first, const Desk& desk,
                  const math::Ijk& room, const Target& to);

// What a stored grey value means; made once for a scan, because there are fewer values than voxels.
class GreyTable {
 public:
  GreyTable(const InsideGrid& grid, const GreyTissue& rule);
  [[nodiscard]] volume::TissueId tissue(std::int16_t grey) const { return tissue_[index(grey)]; }
  // What the bone keeps of the value. beyond: the voxel lies beyond the scan; its value is as far
  // below the level as that of the last voxel above it, so that a scan written from this bone ends
  // in the same face.
  [[nodiscard]] std::int16_t intensity(std::int16_t grey, bool beyond) const {
    return beyond ? intensity(-std::abs(level(grey))) : intensity_[index(grey)];
  }

 private:
  static std::size_t index(std::int16_t grey) { return static_cast<std::size_t>(grey + 32768); }
  // the same rounding as in the block of a brick
  [[nodiscard]] double level(std::int16_t grey) const {
    return double{static_cast<float>(grey) - grid_.iso};
  }
  [[nodiscard]] std::int16_t intensity(double level) const;

  const InsideGrid& grid_;
  const GreyTissue& rule_;
  std::vector<volume::TissueId> tissue_;
  std::vector<std::int16_t> intensity_;
};

// Near the surface a voxel is only partly bone and its HU is too low, so the densest value within
// two voxels counts there. Only where `ramps`.
void grey_tissue_of(const InsideGrid& grid, const GreyTable& table, const math::Ijk& first,
                    bool ramps, Desk& desk, const math::Ijk& room, const Target& to);

}  // namespace burr::importing
