// Forces of any size, also infinite and NaN, over a real wire.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "burr/device/wire.h"

namespace burr::test {

class WildForces {
 public:
  explicit WildForces(unsigned seed) : random_(seed) {}
  math::Vec3 next() {
    math::Vec3 force =
        std::pow(10, 4 * any_(random_)) * math::Vec3(any_(random_), any_(random_), any_(random_));
    const int turn = n_++ % 50;
    if (turn == 7) force.x() = std::numeric_limits<double>::quiet_NaN();
    if (turn == 8) force.y() = -std::numeric_limits<double>::infinity();
    return force;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> any_{-1, 1};
  int n_ = 0;
};

// Writes `count` of them, each after a reading. A machine that stands still for longer than a
// device may be silent loses the device; then it is opened again, a few times.
inline void push_wildly(device::Wire& wire, int count, WildForces& forces) {
  int lost = 0;
  for (int n = 0; n < count;) {
    device::HandState hand;
    const device::Wire::Read read = wire.read(hand);
    if (read == device::Wire::Read::lost || !wire.write(forces.next())) {
      ASSERT_LT(++lost, 20) << wire.why();
      ASSERT_TRUE(wire.connect().ok()) << wire.why();
    } else if (read == device::Wire::Read::hand) {
      ++n;
    }
  }
}

}  // namespace burr::test
