// tests/support/wall_clock.h - replaces the time of day, and counts who reads it.
//
//     const test::WallClock wall;   // from here on
//     wall.set_back(3600);          // the clock is corrected by an hour
//     EXPECT_EQ(wall.asked(), 0);   // it was not read
//
// Replaces clock_gettime, gettimeofday and time in the whole process while an object exists; the
// monotonic clocks are not changed. Not under sanitizers, which have replacements of their own.
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
  // How often the time of day was read since the WallClock was made.
  [[nodiscard]] static long asked();
  // false under sanitizers
  [[nodiscard]] static bool watching();
};

}  // namespace burr::test
