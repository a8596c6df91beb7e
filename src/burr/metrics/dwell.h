// metrics/dwell.h - did a turning burr stay in one place, where it warms the bone.
//
//     dwell   a stretch of more than 3 s of contact with the burr turning, no farther than 1 mm from where it
//             began
//
// A stay that leaves its ball ends, and the next one begins there. Who rubs to and fro over 2 mm does not
// dwell. Units: SI. Thread: one. Memory: fixed.
#pragma once

#include <cstddef>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"

namespace burr::metrics {

inline constexpr double kDwell = 3, kDwellBall = 1e-3;  // [s], radius [m]

struct Dwell {
  std::size_t count = 0;
  double seconds = 0;     // of all that count
  double longest = 0;     // stay, also one that is too short to count [s]
  double longest_at = 0;  // its beginning [s]
  math::Vec3 place = math::Vec3::Zero();
};

class DwellMaker {
 public:
  void add(const Moment& now);
  // Not assessable: a turning burr never touched bone.
  [[nodiscard]] Assessed<Dwell> finish();

 private:
  void end();
  Dwell found_;
  bool stays_ = false, touched_ = false;
  double begin_ = 0, stay_ = 0;  // [s]
  math::Vec3 place_ = math::Vec3::Zero();
};

}  // namespace burr::metrics
