// volume/greys.h - the grey values of a scan, kept to be shown beside the bone that was made from
// it: in the scan's own grid and values, unchanged by any cut.
//
// Frame: world (LPS). Units: m; values in HU or the file's own unit. Thread: read by any.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::volume {

struct Greys {
  math::Ijk size = {0, 0, 0};
  math::Vec3 spacing = {1e-3, 1e-3, 1e-3};   // along i, j, k  [m]
  math::Mat3 axes = math::Mat3::Identity();  // columns: directions of i, j, k, unit
  math::Vec3 origin = math::Vec3::Zero();    // centre of voxel (0,0,0)
  double least = 0, step = 1;                // value = least + step * stored
  double top = 0;                            // largest value
  std::vector<std::uint16_t> stored;         // (size), x fastest
  double iso = 0;                            // value of the bone's surface
  bool hounsfield = false;

  // Interpolates linearly between voxels. False: outside the scan; `value` is unchanged.
  [[nodiscard]] bool at(const math::Vec3& world, double& value) const;
};

}  // namespace burr::volume
