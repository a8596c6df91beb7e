// tests/support/wall_clock.h - the time of day as a test wants it, and who asks for it.
//
//     const test::WallClock wall;       // from here on
//     wall.set_back(3600);              // somebody corrects the clock by an hour
//     EXPECT_EQ(wall.asked(), 0);       // nobody cares
//
// Stands in for clock_gettime, gettimeofday and time in the whole process while one lives; the
// monotonic clocks stay as they are. Not under sanitizers, which have stand-ins of their own.
#pragma once

namespace burr::test {

class WallClock {
 public:
  WallClock();
  ~WallClock();
  WallClock(const WallClock&) = delete;
  WallClock& operator=(const WallClock&) = delete;
  // Any thread. Negative: forward.  [s]
  static void set_back(double seconds);
  // How often anybody asked for the time of day since the WallClock began.
  [[nodiscard]] static long asked();
  // false under sanitizers
  [[nodiscard]] static bool watching();
};

}  // namespace burr::test
