// metrics/noise.h - a noise dose of the drilled ear, for comparison between sessions only.
//
//     D = 100 sum C_i / T_i,   T_i = 8 h / 2^((L_i - 85 dB) / 3 dB)     recommended limit of NIOSH (1998)
//     L = 108 dBA at a diameter of 6.5 mm, 6 dB less per halved diameter
//
// C_i: time in contact with the burr turning. The levels are assumptions, not measured for this
// simulator; the dose is relative and never marked. Units: %, s. Thread: one.
#pragma once

#include <cstdint>

#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/metrics/near.h"
#include "burr/metrics/same_math.h"

namespace burr::metrics {

class NoiseMaker {
 public:
  void add(const Moment& now) {
    if (!now.touching || !now.turning) return;
    if (!now.radius_known()) {
      ++unknown_;
      return;
    }
    ++known_;
    if (now.tool.radius != radius_) {
      radius_ = now.tool.radius;
      const double halvings = logarithm(2 * radius_ / kDiameter) / kLog2;
      limit_ = 8 * 3600 / two_to((kLevel + 6 * halvings - 85) / 3);
    }
    dose_ += 100 * now.dt / limit_;
  }
  // [%]. Not assessable: no contact of a turning burr whose radius is recorded, though there were
  // others.
  [[nodiscard]] Assessed<double> dose() const {
    if (known_ == 0 && unknown_ > 0) return NotAssessable{kNoRadius};
    return dose_;
  }

 private:
  static constexpr double kLevel = 108, kDiameter = 6.5e-3, kLog2 = 0.6931471805599453;
  double radius_ = 0, limit_ = 1, dose_ = 0;
  std::uint64_t known_ = 0, unknown_ = 0;  // ticks of contact with and without a radius
};

}  // namespace burr::metrics
