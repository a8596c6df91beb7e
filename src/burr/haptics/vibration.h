// haptics/vibration.h - the vibration of the spindle in the hand, as far as a 1 kHz loop can
// reproduce it.
//
//     white noise --[ resonator at f_v, Q ]-- e, variance 1 --[ clamp 3 ]-- A e t_hat
//
// A burr at 80 000 rpm has a run-out frequency of 1333 Hz and a tooth frequency of 10 kHz: above
// the 500 Hz that a 1 kHz loop can carry. A band of noise replaces them (docs/understand/touch.md,
// "Vibration"):
//
//     f_v = f_r / m, limited to 60..250 Hz, where skin is most sensitive; m is the smallest whole
//           number that brings f_r = speed / 2 pi down to 250 Hz
//     A   = min(0.15 N, a0 + a1 |F_c|) while cutting, 0.01 N while idling, both with 50 ms ramps
//
// A is the root mean square; |F_v| <= 3 A always (0.45 N; 0.03 N while idling). e is clamped there,
// which removes 0.5 % of its variance. The resonator is the band-pass (1 - z^-2) / (...) of
// Bristow-Johnson's cookbook: it has a zero at 0 Hz, so the mean is zero; its peak is exactly at
// f_v; its variance for white noise is a / (1 + a), a = sin(2 pi f_v T) / (2 Q). Where the run-out
// frequency is below 60 Hz, A decreases with it: a burr that stands still does not vibrate.
//
// The force lies in the tangent plane, perpendicular to the shaft, so that it does not press into
// the bone. After a corner it turns to the new direction within 50 ms, without a step. lines()
// returns the true frequencies for the sound, which can carry them.
//
// Thread: servo. Frame: world. Units: SI. Memory: none. Random numbers are counted from the seed,
// so that a recording replays to the bit. Cost: under 1 us a tick.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct VibrationSettings {
  double base = 0.02;       // a0: while cutting without force                                [N]
  double per_force = 0.08;  // a1: increase per newton                                       [-]
  double most = 0.15;       // upper limit, root mean square                                  [N]
  double idle = 0.01;       // the same with the spindle on and no contact; at most 0.01      [N]
  double quality = 5;       // Q of the band, 3..8                                            [-]
  double ramp = 50e-3;      // time from zero to `most`                                       [s]
  double device_gain = 1;   // inverse of the device's gain in 60..250 Hz; before `most` [-]
  std::uint64_t seed = 1;
};

// State of the drill in this tick.
struct Milling {
  double spindle_rad_s = 0;
  math::Vec3 axis = math::Vec3::UnitZ();   // of the shaft, unit
  math::Vec3 normal = math::Vec3::Zero();  // out of the bone, unit; zero: nothing is touched
  double cutting_force = 0;                // |F_c|                                        [N]
};

// The true frequencies, for sound: a hand at 1 kHz cannot be given them.
struct SpindleLines {
  double run_out_hz = 0, tooth_hz = 0;  // f_r and z f_r
  double run_out = 0, tooth = 0;        // amplitudes [N]
};

class Vibration {
 public:
  static constexpr double kLargest = 3;  // in units of A: where e is clamped

  explicit Vibration(const VibrationSettings& settings = {});

  // Returns the force to add to touch's force, before the limits. dt: this tick [s].
  [[nodiscard]] math::Vec3 step(const Milling& now, double dt) BURR_RT;

  [[nodiscard]] SpindleLines lines(const Milling& now, int teeth) const BURR_RT;

  [[nodiscard]] double frequency() const BURR_RT { return frequency_; }  // f_v [Hz]
  [[nodiscard]] double amplitude() const BURR_RT { return amplitude_; }  // A   [N]
  [[nodiscard]] double noise() const BURR_RT { return noise_; }          // e, clamped

 private:
  [[nodiscard]] double white() BURR_RT;
  void tune(double frequency, double dt) BURR_RT;
  void ring() BURR_RT;
  void turn(const Milling& now, double dt) BURR_RT;

  VibrationSettings settings_;
  std::uint64_t count_ = 0;             // random numbers used so far
  double tuned_to_ = 0, tuned_dt_ = 0;  // the resonator's coefficients are for these
  double gain_ = 0, back_1_ = 0, back_2_ = 0;
  double in_1_ = 0, in_2_ = 0, out_1_ = 0, out_2_ = 0;
  double frequency_ = 0, amplitude_ = 0, noise_ = 0;
  math::Vec3 direction_ = math::Vec3::UnitX();
};

// f_v for a run-out frequency f_r [Hz].
[[nodiscard]] double felt_frequency(double run_out_hz) BURR_RT;

}  // namespace burr::haptics
