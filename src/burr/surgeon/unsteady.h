// surgeon/unsteady.h - what a hand does besides what it intends: tremor, drift, an uneven force.
//
//     tremor   white noise through two poles at 9.5 Hz, quality 4: a band of 8 to 11 Hz
//     drift    Ornstein-Uhlenbeck process with a corner at 0.5 Hz
//     force    five such processes an octave apart, of equal power: about 1/f from 0.1 to 3 Hz
//
// All have the given rms from the first step on, and keep it for every step width. Sources of band
// and size: docs/understand/surgeon.md. Units: SI. Thread: one. Memory: none.
#pragma once

#include <array>
#include <cstdint>

#include "burr/math/vec3.h"
#include "burr/people/random_stream.h"
#include "burr/rt/rt.h"

namespace burr::surgeon {

inline constexpr double kTremorHz = 9.5, kTremorQuality = 4, kDriftHz = 0.5;

class Tremor {
 public:
  // rms per axis [m]; dt: between two steps [s]
  Tremor(double rms, double dt, std::uint64_t seed);
  [[nodiscard]] math::Vec3 next() BURR_RT;

 private:
  double one_, two_, noise_;  // y = one y' + two y'' + noise
  math::Vec3 last_, before_;
  people::RandomStream random_;
};

class Drift {
 public:
  Drift(double rms, double dt, std::uint64_t seed);
  [[nodiscard]] math::Vec3 next() BURR_RT;

 private:
  double keep_, noise_;
  math::Vec3 at_;
  people::RandomStream random_;
};

class UnevenForce {
 public:
  // rms of the factor about 1
  UnevenForce(double rms, double dt, std::uint64_t seed);
  [[nodiscard]] double next() BURR_RT;  // a factor, at least 0.1

 private:
  static constexpr int kOctaves = 5;
  std::array<double, kOctaves> keep_ = {}, noise_ = {}, at_ = {};
  people::RandomStream random_;
};

}  // namespace burr::surgeon
