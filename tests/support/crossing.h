// tests/support/crossing.h - where the surface of a bone crosses a line.
#pragma once

#include <utility>

#include "burr/volume/sample.h"

namespace burr::test {

// The first place along d (unit), from a point p inside; -1: none within 40 mm.  [m from p]
inline double crossing(const volume::Bone& bone, const math::Vec3& p, const math::Vec3& d) {
  constexpr double kFar = 40e-3;
  const double step = bone.grid().voxel / 4;
  double before = 0, value = 0;
  for (double s = 0; s < kFar; s += step) {
    before = std::exchange(value, volume::depth_at(bone, p + s * d));
    if (s > 0 && before >= 0 && value < 0) return s - step * (value / (value - before));
  }
  return -1;
}

}  // namespace burr::test
