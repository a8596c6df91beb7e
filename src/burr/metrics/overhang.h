// metrics/overhang.h - is the cavity open to the surgeon: the share of the new surface that lies
// under bone.
//
//     share = area of the new surface whose ray along a meets bone within 20 mm  /  all of it
//
// a: from the bone to the surgeon. Of several directions the best counts. met: share <= 5 % (not
// calibrated). The ray starts a voxel off the surface, along its normal, so that an upright wall does
// not hide itself. Frame: world. Thread: any.
#pragma once

#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct OverhangSettings {
  std::vector<math::Vec3> towards = {};  // at least one
  double most_share = 0.05;
  double reach = 20e-3;  // [m]
};

struct Overhang {
  Mark mark;                                // share
  double area = 0;                          // of the new surface [m^2]
  math::Vec3 towards = math::Vec3::Zero();  // the best direction
  std::vector<math::Vec3> under;            // the points under bone, seen from there
};

// Not assessable: fewer than kFewestPoints points of new surface in the region.
[[nodiscard]] Assessed<Overhang> overhang(const volume::Bone& before, const volume::Bone& after,
                                          const Region& region, const OverhangSettings& settings);

}  // namespace burr::metrics
