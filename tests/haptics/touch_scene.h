// tests/haptics/touch_scene.h - a bone with its surface, ready to be touched.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/iso_vertices.h"

namespace burr::test {

struct TouchScene {
  TouchScene(const phantom::Depth& depth, double h_mm, double half_mm = 12)
      : h(h_mm * 1e-3),
        bone(phantom::bone_from_distance(phantom::box_grid(math::Vec3::Constant(-half_mm * 1e-3),
                                                           math::Vec3::Constant(half_mm * 1e-3), h),
                                         {}, depth)),
        surface(*bone, {}, 1, quiet) {}
  double h;  // [m]
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
};

}  // namespace burr::test
