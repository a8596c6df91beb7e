#include "burr/haptics/vibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "burr/base/hash.h"
#include "burr/math/elementary.h"
#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr double kLowest = 60, kHighest = 250;  // [Hz]
constexpr double kFastestSpindle = 1e6;         // beyond any drill [rad/s]
constexpr double kMostIdle = 0.01;              // times kLargest: 0.03 N, the limit in free air
constexpr double kTurnTime = 50e-3;             // time constant of the direction [s]

bool fine(const Milling& now, double dt) BURR_RT {
  return std::isfinite(now.spindle_rad_s) && now.axis.allFinite() && now.normal.allFinite() &&
         std::isfinite(now.cutting_force) && std::isfinite(dt) && dt > 0;
}

double run_out(double spindle_rad_s) BURR_RT {
  return std::min(std::abs(spindle_rad_s), kFastestSpindle) / (2 * std::numbers::pi);
}

double held(double value, double low, double high, double otherwise) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

}  // namespace

double felt_frequency(double run_out_hz) BURR_RT {
  const double parts = std::max(1.0, std::ceil(run_out_hz / kHighest));
  return std::clamp(run_out_hz / parts, kLowest, kHighest);
}

Vibration::Vibration(const VibrationSettings& settings) : settings_(settings) {
  const VibrationSettings usual;
  settings_.most = held(settings.most, 0, usual.most, 0);
  settings_.idle = held(settings.idle, 0, kMostIdle, 0);
  settings_.base = held(settings.base, 0, usual.most, 0);
  settings_.per_force = held(settings.per_force, 0, 1, 0);
  settings_.quality = held(settings.quality, 3, 8, usual.quality);
  settings_.ramp = held(settings.ramp, 1e-3, 10, usual.ramp);
  settings_.device_gain = held(settings.device_gain, 0, 100, 0);
}

Vec3 Vibration::step(const Milling& now, double dt) BURR_RT {
  if (!fine(now, dt)) {  // invalid input is handled elsewhere in the tick: adds nothing
    amplitude_ = 0;
    return Vec3::Zero();
  }
  const double turns = run_out(now.spindle_rad_s);
  frequency_ = std::min(felt_frequency(turns), 0.25 / dt);
  tune(frequency_, dt);
  ring();
  turn(now, dt);

  double wanted = 0;
  if (turns > 0) {
    const bool cutting = math::squared_norm(now.normal) > 0;
    const double gain = settings_.device_gain * std::min(1.0, turns / kLowest);
    wanted =
        cutting
            ? std::min(settings_.most,
                       gain * (settings_.base + settings_.per_force * std::abs(now.cutting_force)))
            : std::min(kMostIdle, gain * settings_.idle);
  }
  const double step = settings_.most * dt / settings_.ramp;
  amplitude_ += std::clamp(wanted - amplitude_, -step, step);
  return amplitude_ * noise_ * direction_;
}

// Uniform, variance 1. The n-th number depends on the seed and n only.
double Vibration::white() BURR_RT {
  const std::uint64_t bits = base::mix(settings_.seed, count_++);
  const double unit = static_cast<double>(bits >> 11) * 0x1p-53;  // 0..1
  return (2 * unit - 1) * std::sqrt(3.0);
}

void Vibration::tune(double frequency, double dt) BURR_RT {
  if (frequency == tuned_to_ && dt == tuned_dt_) return;
  tuned_to_ = frequency;
  tuned_dt_ = dt;
  const double angle = 2 * std::numbers::pi * frequency * dt;
  const double width = math::sine(angle) / (2 * settings_.quality);
  back_1_ = 2 * math::cosine(angle) / (1 + width);
  back_2_ = (1 - width) / (1 + width);
  gain_ = std::sqrt(width / (1 + width));  // peak a / (1 + a), variance: its root
}

void Vibration::ring() BURR_RT {
  const double in = white();
  const double out = gain_ * (in - in_2_) + back_1_ * out_1_ - back_2_ * out_2_;
  in_2_ = in_1_;
  in_1_ = in;
  out_2_ = out_1_;
  out_1_ = out;
  noise_ = std::clamp(out, -kLargest, kLargest);
}

// The direction across shaft and normal, in which the teeth run. The noise has no sign, so the
// nearer of the two directions is used; it changes slowly, so that a corner causes no step.
void Vibration::turn(const Milling& now, double dt) BURR_RT {
  const bool touching = math::squared_norm(now.normal) > 0;
  const Vec3 normal = touching ? now.normal : now.axis;
  Vec3 across = touching ? Vec3(now.axis.cross(normal)) : Vec3(Vec3::Zero());
  if (math::squared_norm(across) <
      0.01 * math::squared_norm(normal))  // the pole cuts: any way will do
    across = direction_ -
             normal * (math::dot(normal, direction_) / std::max(1e-12, math::squared_norm(normal)));
  if (math::squared_norm(across) < 1e-6) across = normal.unitOrthogonal();
  across = math::normalized(across);
  if (math::dot(across, direction_) < 0) across = -across;
  direction_ += (across - direction_) * std::min(1.0, dt / kTurnTime);
  direction_ = math::normalized(direction_);
}

SpindleLines Vibration::lines(const Milling& now, int teeth) const BURR_RT {
  SpindleLines found;
  if (!fine(now, 1)) return found;
  found.run_out_hz = run_out(now.spindle_rad_s);
  found.tooth_hz = std::max(0, teeth) * found.run_out_hz;
  if (found.run_out_hz <= 0) return found;
  found.run_out = settings_.base;
  if (math::squared_norm(now.normal) > 0)
    found.tooth = std::min(settings_.most, settings_.per_force * std::abs(now.cutting_force));
  return found;
}

}  // namespace burr::haptics
