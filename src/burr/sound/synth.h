// sound/synth.h - synthesizes the sound of the drill: turns a SoundState into samples.
//
//     spindle   lines at f_r = |w| / 2 pi and its multiples, and at z f_r, the teeth
//     cutting   white noise --[ band at f_c, Q ]-- times sqrt(q / (q + q_half))
//     stroke    of a saw: the noise swells and dies twice a stroke, as the teeth do, by
//               sqrt(2) |sin 2 pi f_r t|; its power stays
//     knock     a line at f_c / 3 when the burr comes onto the bone, and at a blow: exp(-t/d) - exp(-t/a)
//     coolant   white noise --[ band at 6 kHz ]
//     warning   beeps that come faster the nearer a structure to spare is; a steady tone at the end,
//               an octave lower while the burr cuts into it
//
// The lines of the spindle are those of a rotor: once a turn from run-out, its multiples from a
// shape that is not round, once a tooth (Altintas 2012, ch. 3). A line fades where it would come
// near half the sample rate, so that none is heard as an alias. The loudness of each part, f_c = 2
// kHz (e / 1 J/mm^3)^(1/3) for a bone of specific cutting energy e, and q_half are choices that let
// the user tell tissues and rates apart; they have not been compared with a recording of a real
// drill.
//
// Nothing clicks: oscillators keep their phase; filters are of Zavalishin's kind, whose state stays
// valid while they are tuned ("The Art of VA Filter Design", 2018, ch. 4); and every number follows
// its request through two first-order lags, so that not even its slope steps.
//
// The sum is unchanged up to 0.7 of full scale and compressed above, so that it never exceeds full
// scale. When there is nothing to hear, the samples become exact zeros.
//
// A pure function of its input, in order: the same input gives the same samples.
// Thread: one. Memory: none. Cost: docs/use/sound.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "burr/rt/rt.h"
#include "burr/sound/sound_state.h"

namespace burr::sound {

struct SynthSettings {
  double rate_hz = 48e3;  // samples a second, 8e3 to 192e3

  // loudness of each part alone, relative to full scale 1; amplitude of lines, root mean square of
  // noise
  double spindle = 0.12;
  double tooth = 0.03;    // idle; up to three times that under load
  double cutting = 0.14;  // at most
  double knock = 0.2;
  double coolant = 0.015;
  double warning = 0.15;

  double half_speed_hz = 150;  // turns a second at which the spindle reaches half its loudness
  double half_removal = 5e-9;  // q_half [m^3/s]
  double half_torque = 1e-3;   // torque at which the teeth are twice as loud as idle [N m]

  // the warning
  double warn_from = 5e-3;                   // distance at which beeps begin [m]
  double warn_always = 0.5e-3;               // distance at which they become one tone [m]
  double beep_slow = 0.8, beep_fast = 0.12;  // time from one beep to the next, at these two
                                             // distances [s]
  double beep = 60e-3;                       // length of a beep; at most half of the time [s]
  double warn_hz = 1250;

  std::uint64_t seed = 1;  // seed of the noise
};

class Synth {
 public:
  explicit Synth(const SynthSettings& settings = {});

  // Takes effect from the next sample on.
  void update(const SoundState& now) BURR_RT;
  // Loudness of everything, 0..1; follows within 30 ms.
  void loudness(double wanted) BURR_RT;
  // Fills `samples`, one channel, each within -1..1.
  void make(std::span<float> samples) BURR_RT;
  // Adds the sound to what is in `samples`; the sum stays within -1..1.
  void mix(std::span<float> samples) BURR_RT;

  [[nodiscard]] const SynthSettings& settings() const BURR_RT { return settings_; }

 private:
  // Two first-order lags in a row; ends exactly at its request.
  struct Smooth {
    double request = 0, between = 0, now = 0;
    double step(double share) BURR_RT;
  };
  // The band output of Zavalishin's state variable filter: gain 1 at its middle.
  struct Band {
    double state_1 = 0, state_2 = 0;
    double step(double in, double tuned, double damping) BURR_RT;
  };

  void request(const SoundState& now) BURR_RT;
  [[nodiscard]] double spindle() BURR_RT;
  [[nodiscard]] double cutting() BURR_RT;
  [[nodiscard]] double knock() BURR_RT;
  [[nodiscard]] double coolant() BURR_RT;
  [[nodiscard]] double warning() BURR_RT;
  [[nodiscard]] double white() BURR_RT;
  [[nodiscard]] double below_half_rate(double hz) const BURR_RT;
  [[nodiscard]] double sample() BURR_RT;

  static constexpr int kLines = 4;  // of the spindle: f_r and its multiples

  SynthSettings settings_;
  double dt_;
  double quick_, usual_, slow_;  // shares of the lags
  std::uint64_t count_ = 0;      // random numbers used so far

  // requested values, smoothed
  Smooth turns_hz_, loaded_, removal_, tissue_hz_, coolant_, loudness_, tooth_, warn_pitch_,
      strokes_;
  int teeth_ = 0, teeth_requested_ = 8;
  bool touching_ = false, struck_ = false;
  double untouched_;  // since the last contact [s]

  // phases of the oscillators, in turns 0..1
  double turn_ = 0, tooth_turn_ = 0, knock_turn_ = 0, warn_turn_ = 0;
  Band bone_band_, coolant_band_;
  double coolant_tuned_, coolant_gain_;

  double ring_ = 0, rise_ = 0;  // of the knock: exp(-t/d) and exp(-t/a)
  double ring_share_, rise_share_;

  double beep_every_ = 1;  // [s]; 0: always
  bool warned_ = false;
  double beep_at_ = 0;     // phase in beeps, 0..1
  double beep_swell_ = 0;  // 0 silent, 1 full
};

// f_c of a bone with that specific cutting energy [J/m^3].
[[nodiscard]] double cutting_hz(double hardness_j_m3) BURR_RT;

// Time from one warning to the next [s]; 0: a steady tone; infinity: none.
[[nodiscard]] double beep_every(const SynthSettings& settings, double to_spare) BURR_RT;

}  // namespace burr::sound
