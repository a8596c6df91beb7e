#include "burr/sound/synth.h"

#include <algorithm>
#include <cmath>

#include "burr/base/hash.h"

namespace burr::sound {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFastest = 1e5;      // spindle, either direction [rad/s]
constexpr double kUsualBone = 1e9;    // cortical; until another bone is cut [J/m^3]
constexpr double kMostTeeth = 64;     // more cannot be distinguished
constexpr double kBoneQuality = 1.5;  // Q of the band of cutting noise
constexpr double kCoolantQuality = 0.7, kCoolantHz = 6e3;
constexpr double kQuick = 4e-3, kUsual = 12e-3, kSlow = 60e-3;  // time constants of each of two
                                                                // lags [s]
constexpr double kRise = 2e-3, kRing = 25e-3;                   // of a knock [s]
constexpr double kSwell = 8e-3;                                 // rise of a beep [s]
constexpr double kUntouched = 50e-3;  // time without contact until a new contact knocks, so that
                                      // bouncing does not rattle [s]
constexpr double kLoud = 0.7;         // share of full scale above which the sum is compressed [-]
constexpr double kNothing = 1e-7;     // -140 dB: a value this close to its target is set to it

double held(double value, double low, double high, double otherwise) BURR_RT {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

double share_of(double time, double dt) { return 1 - std::exp(-dt / time); }

// Gain that gives white noise of variance 1 the variance 1 again behind a band. The variance there
// is a / (1 + a), a = sin(w) / (2 Q), as for every such band (haptics/vibration.h); sin(w) = 2 g /
// (1 + g^2).
double gain_of(double tuned, double quality) BURR_RT {
  const double a = tuned / (1 + tuned * tuned) / quality;
  return std::sqrt((1 + a) / a);
}

// Unchanged up to kLoud, then compressed towards 1, without a corner.
double bounded(double x) BURR_RT {
  const double over = (std::abs(x) - kLoud) / (1 - kLoud);
  return over <= 0 ? x : std::copysign(kLoud + (1 - kLoud) * over / (1 + over), x);
}

// Advances a phase; whole turns are dropped.
void advance(double& turn, double turns) BURR_RT {
  turn += turns;
  turn -= std::floor(turn);
}

}  // namespace

double cutting_hz(double hardness_j_m3) BURR_RT {
  return 2e3 * std::cbrt(held(hardness_j_m3, 1e7, 5e10, kUsualBone) / 1e9);
}

double beep_every(const SynthSettings& settings, double to_spare) BURR_RT {
  if (std::isnan(to_spare) || to_spare >= settings.warn_from)
    return std::numeric_limits<double>::infinity();
  if (to_spare <= settings.warn_always) return 0;
  const double share =
      (to_spare - settings.warn_always) / (settings.warn_from - settings.warn_always);
  return settings.beep_fast + share * (settings.beep_slow - settings.beep_fast);
}

Synth::Synth(const SynthSettings& settings) : settings_(settings) {
  const SynthSettings usual;
  const auto hold = [](double& value, double low, double high, double otherwise) {
    value = held(value, low, high, otherwise);
  };
  hold(settings_.rate_hz, 8e3, 192e3, usual.rate_hz);
  for (double* level : {&settings_.spindle, &settings_.tooth, &settings_.cutting, &settings_.knock,
                        &settings_.coolant, &settings_.warning})
    hold(*level, 0, 1, 0);
  hold(settings_.half_speed_hz, 1, 1e4, usual.half_speed_hz);
  hold(settings_.half_removal, 1e-12, 1e-3, usual.half_removal);
  hold(settings_.half_torque, 1e-6, 10, usual.half_torque);
  hold(settings_.warn_always, 0, 1, usual.warn_always);
  hold(settings_.warn_from, settings_.warn_always + 1e-6, 2, settings_.warn_always + 1e-6);
  hold(settings_.beep_fast, 0.04, 10, usual.beep_fast);
  hold(settings_.beep_slow, settings_.beep_fast, 10, settings_.beep_fast);
  hold(settings_.beep, 0.01, 10, usual.beep);
  hold(settings_.warn_hz, 100, 0.4 * settings_.rate_hz, usual.warn_hz);

  dt_ = 1 / settings_.rate_hz;
  quick_ = share_of(kQuick, dt_);
  usual_ = share_of(kUsual, dt_);
  slow_ = share_of(kSlow, dt_);
  rise_share_ = std::exp(-dt_ / kRise);
  ring_share_ = std::exp(-dt_ / kRing);
  coolant_tuned_ = std::tan(kPi * std::min(kCoolantHz * dt_, 0.4));
  coolant_gain_ = gain_of(coolant_tuned_, kCoolantQuality);
  untouched_ = kUntouched;
  tissue_hz_.request = tissue_hz_.between = tissue_hz_.now = cutting_hz(kUsualBone);
  loudness_.request = loudness_.between = loudness_.now = 1;
  warn_pitch_.request = warn_pitch_.between = warn_pitch_.now = 1;
  request({});
}

void Synth::loudness(double wanted) BURR_RT { loudness_.request = held(wanted, 0, 1, 0); }

// ---- what is heard now, as requests

void Synth::update(const SoundState& now) BURR_RT {
  // a knock starts from the level of the previous one: no step, and never louder than one knock
  if (now.touching && untouched_ >= kUntouched) {
    rise_ += 1 - ring_;
    ring_ = 1;
  }
  if (now.struck && !struck_) {
    rise_ += 1 - ring_;
    ring_ = 1;
  }
  struck_ = now.struck;
  if (now.touching) untouched_ = 0;
  touching_ = now.touching;
  request(now);
}

void Synth::request(const SoundState& now) BURR_RT {
  turns_hz_.request = std::abs(held(now.spindle_rad_s, -kFastest, kFastest, 0)) / (2 * kPi);
  const double torque = held(std::abs(now.cutting_nm), 0, 10, 0);
  loaded_.request = torque / (torque + settings_.half_torque);
  const double rate = held(now.removal_m3_s, 0, 1, 0);
  removal_.request = std::sqrt(rate / (rate + settings_.half_removal));
  if (rate > 0) tissue_hz_.request = cutting_hz(now.hardness_j_m3);
  strokes_.request = now.strokes ? 1 : 0;
  coolant_.request = now.irrigated ? 1 : 0;
  teeth_requested_ = static_cast<int>(held(now.teeth, 0, kMostTeeth, 0));

  const double every = beep_every(settings_, now.to_spare);
  warned_ = std::isfinite(every);
  if (warned_) beep_every_ = every;
  warn_pitch_.request = now.injured ? 0.5 : 1;
}

// ---- samples

double Synth::Smooth::step(double share) BURR_RT {
  between += share * (request - between);
  now += share * (between - now);
  // without an end, the rest of a decay would be computed for ever
  if (std::abs(request - now) + std::abs(request - between) <= kNothing) now = between = request;
  return now;
}

double Synth::Band::step(double in, double tuned, double damping) BURR_RT {
  const double high =
      (in - (damping + tuned) * state_1 - state_2) / (1 + tuned * (tuned + damping));
  const double band = tuned * high + state_1;
  const double low = tuned * band + state_2;
  state_1 = tuned * high + band;
  state_2 = tuned * band + low;
  return damping * band;
}

double Synth::white() BURR_RT {
  // counted, so that only the seed and the position decide; variance 1
  const std::uint64_t bits = base::mix(settings_.seed, ++count_);
  return std::sqrt(12.0) * (static_cast<double>(bits >> 11) * 0x1p-53 - 0.5);
}

// 1 for frequencies that the samples can carry, falling to 0 at nine tenths of half the rate.
double Synth::below_half_rate(double hz) const BURR_RT {
  const double share = hz / (0.5 * settings_.rate_hz);
  return std::clamp((0.9 - share) / 0.2, 0.0, 1.0);
}

double Synth::spindle() BURR_RT {
  const double f = turns_hz_.step(usual_);
  const double loaded = loaded_.step(usual_);
  // another burr: the teeth of the old one fade out before those of the new one fade in
  tooth_.request = teeth_ == teeth_requested_ && teeth_ > 0 ? 1 : 0;
  if (tooth_.step(quick_) == 0 && teeth_ != teeth_requested_) teeth_ = teeth_requested_;
  if (f == 0) return 0;
  advance(turn_, f * dt_);
  advance(tooth_turn_, teeth_ * f * dt_);
  const double fast = f * f / (f * f + settings_.half_speed_hz * settings_.half_speed_hz);
  // sin n a = 2 cos a sin (n - 1) a - sin (n - 2) a
  const double angle = 2 * kPi * turn_;
  const double twice = 2 * std::cos(angle);
  double before = 0, line = std::sin(angle), sum = 0;
  for (int n = 1; n <= kLines; ++n) {
    sum += below_half_rate(n * f) * line / (n * n);
    const double next = twice * line - before;
    before = line;
    line = next;
  }
  const double teeth =
      settings_.tooth * (1 + 2 * loaded) * tooth_.now * below_half_rate(teeth_ * f);
  return fast * (settings_.spindle * sum + teeth * std::sin(2 * kPi * tooth_turn_));
}

double Synth::cutting() BURR_RT {
  const double hz = tissue_hz_.step(usual_);
  const double loud = removal_.step(usual_);
  if (loud == 0) return 0;
  const double tuned = std::tan(kPi * std::min(hz * dt_, 0.4));
  const double to_and_fro = strokes_.step(usual_);
  const double swell = 1 + to_and_fro * (std::sqrt(2.0) * std::abs(std::sin(2 * kPi * turn_)) - 1);
  return settings_.cutting * swell * loud * gain_of(tuned, kBoneQuality) *
         bone_band_.step(white(), tuned, 1 / kBoneQuality);
}

double Synth::coolant() BURR_RT {
  const double loud = coolant_.step(slow_);
  if (loud == 0) return 0;
  return settings_.coolant * loud * coolant_gain_ *
         coolant_band_.step(white(), coolant_tuned_, 1 / kCoolantQuality);
}

double Synth::knock() BURR_RT {
  if (!touching_) untouched_ += dt_;
  if (ring_ == 0) return 0;
  ring_ *= ring_share_;
  rise_ *= rise_share_;
  advance(knock_turn_, std::min(tissue_hz_.now / 3, 0.2 * settings_.rate_hz) * dt_);
  const double sample = settings_.knock * (ring_ - rise_) * std::sin(2 * kPi * knock_turn_);
  if (ring_ < kNothing) ring_ = rise_ = knock_turn_ = 0;
  return sample;
}

double Synth::warning() BURR_RT {
  bool on = warned_ && beep_every_ == 0;
  if (beep_every_ > 0 && (warned_ || beep_at_ > 0)) {
    on = warned_ && beep_at_ * beep_every_ < std::min(settings_.beep, 0.5 * beep_every_);
    const double before = beep_at_;
    advance(beep_at_, dt_ / beep_every_);
    // finish the last beep; otherwise a hand that trembles at the border would be warned hastily
    if (!warned_ && beep_at_ < before) beep_at_ = 0;
  }
  // a swell of half a cosine: smooth at both ends
  beep_swell_ = std::clamp(beep_swell_ + (on ? dt_ : -dt_) / kSwell, 0.0, 1.0);
  if (beep_swell_ == 0) return 0;
  advance(warn_turn_, warn_pitch_.step(quick_) * settings_.warn_hz * dt_);
  const double loud = 0.5 - 0.5 * std::cos(kPi * beep_swell_);
  return settings_.warning * loud * std::sin(2 * kPi * warn_turn_);
}

double Synth::sample() BURR_RT {
  const double sum = spindle() + cutting() + knock() + coolant() + warning();
  return bounded(loudness_.step(usual_) * sum);
}

void Synth::make(std::span<float> samples) BURR_RT {
  for (float& one : samples) one = static_cast<float>(sample());
}

void Synth::mix(std::span<float> samples) BURR_RT {
  for (float& one : samples) one = static_cast<float>(bounded(static_cast<double>(one) + sample()));
}

}  // namespace burr::sound
