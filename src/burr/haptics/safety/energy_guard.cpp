#include "burr/haptics/safety/energy_guard.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/math/turn.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr double kMostTank = 10e-3;      // upper limit of tank_full [J]
constexpr double kGrantLasts = 50e-3;    // what is not used within about this time flows back [s]
constexpr double kLargestAccount = 1e3;  // beyond it a number must be wrong       [J]

bool fine(const SpringState& now, double dt) BURR_RT {
  return now.hand.allFinite() && now.stretch.allFinite() && now.force.allFinite() &&
         std::isfinite(now.stiffness) && now.stiffness >= 0 && std::isfinite(dt) && dt > 0 &&
         now.hand_turn.coeffs().allFinite() && now.torque.allFinite() &&
         std::isfinite(now.turn_stiffness) && now.turn_stiffness >= 0;
}

double or_zero(double value) { return std::isfinite(value) ? std::max(0.0, value) : 0.0; }

}  // namespace

EnergyGuard::EnergyGuard(const EnergyGuardSettings& settings) : settings_(settings) {
  for (double* value :
       {&settings_.device_mass, &settings_.device_damping, &settings_.encoder_step,
        &settings_.count_force, &settings_.delay, &settings_.least_speed, &settings_.largest_force,
        &settings_.free_time, &settings_.tank_low, &settings_.slack, &settings_.turn_refill,
        &settings_.turn_low, &settings_.largest_torque})
    *value = or_zero(*value);
  settings_.tank_full = std::min(or_zero(settings_.tank_full), kMostTank);
  settings_.turn_full = std::min(or_zero(settings_.turn_full), kMostTank);
  turn_left_ = settings_.turn_full;
  sent_.fill({});
}

Vec3 EnergyGuard::step(const SpringState& now, double dt) BURR_RT {
  alpha_ = 0;
  share_ = 1;
  if (!fine(now, dt)) {
    restart();
    return now.force;
  }
  observe(now, dt);
  settle(dt);
  forget_when_free(now, dt);
  if (!(std::abs(energy_) < kLargestAccount && std::abs(stored_) < kLargestAccount)) {
    restart();
    return now.force;
  }

  const Vec3 force = faded(now.force);
  const double square = math::squared_norm(velocity_);
  const double owed = deficit() - settings_.slack;
  if (owed <= 0 || square < settings_.least_speed * settings_.least_speed || square == 0)
    return force;
  alpha_ = std::min(owed / (dt * square), most_damping(dt));
  return force - alpha_ * velocity_;
}

void EnergyGuard::sent(const Vec3& force, const Vec3& torque) BURR_RT {
  newest_ = (newest_ + 1) % kSent;
  sent_[newest_].force = force.allFinite() ? force : Vec3(Vec3::Zero());
  sent_[newest_].torque = torque.allFinite() ? torque : Vec3(Vec3::Zero());
}

// While the store of free turns runs low.
Vec3 EnergyGuard::faded(const Vec3& force) BURR_RT {
  if (turn_left_ >= settings_.turn_low) return force;
  share_ = turn_left_ / settings_.turn_low;
  return share_ * force;
}

// The mean force that acted since the previous tick. With a delay of q whole ticks and a rest, the
// force of one tick earlier acts first.
EnergyGuard::Push EnergyGuard::acting(double dt) const BURR_RT {
  const double ticks = std::min(settings_.delay / dt, static_cast<double>(kSent) - 1.001);
  const auto whole = static_cast<std::size_t>(ticks);
  const double rest = ticks - static_cast<double>(whole);
  const Push& late = sent_[(newest_ + kSent - whole) % kSent];
  const Push& later = sent_[(newest_ + 2 * kSent - whole - 1) % kSent];
  return {(1 - rest) * late.force + rest * later.force,
          (1 - rest) * late.torque + rest * later.torque};
}

// The energy that the spring can give back. Where the spring would give more than is ever sent, the
// force counts as the largest one.
double EnergyGuard::spring_energy(const SpringState& now) const BURR_RT {
  const double stretch = math::norm(now.stretch);
  const double most = settings_.largest_force;
  if (now.turn_stiffness > 0) {
    const double force = now.stiffness * stretch, torque = math::norm(now.torque);
    // both springs go back together, and one factor limits both
    double share = force > most ? most / force : 1;
    if (settings_.largest_torque > 0 && torque > settings_.largest_torque)
      share = std::min(share, settings_.largest_torque / torque);
    const double whole = 0.5 * (force * stretch + torque * torque / now.turn_stiffness);
    return whole * share * (2 - share);
  }
  if (now.stiffness * stretch <= most) return 0.5 * now.stiffness * stretch * stretch;
  return most * (stretch - 0.5 * most / now.stiffness);
}

void EnergyGuard::observe(const SpringState& now, double dt) BURR_RT {
  stored_ = spring_energy(now);
  if (!begun_) {
    begun_ = true;
    energy_ = stored_;
    written_off_ += stored_;
    velocity_ = Vec3::Zero();
  } else {
    const Vec3 way = now.hand - last_hand_;
    velocity_ = way / dt;
    const Push push = acting(dt);
    double work = -math::dot(push.force, way);
    if (now.turn_stiffness > 0 || last_torque_ != Vec3::Zero()) {
      const Vec3 turned =
          math::rotation_vector(math::product(now.hand_turn, last_turn_.conjugate()));
      if (settings_.largest_torque > 0)
        work -= math::dot(push.torque, turned);
      else
        lend(0.5 * (last_torque_ + now.torque), turned);
    }
    work_in_ += work;
    energy_ += work;
    // the device lost at least b |dx|^2 / T on the way; that reduces a deficit but does not fill
    // the tank
    const double own =
        std::min(settings_.device_damping * math::squared_norm(way) / dt, std::max(0.0, deficit()));
    energy_ += own;
    lost_in_device_ += own;
  }
  turn_left_ = std::min(settings_.turn_full, turn_left_ + settings_.turn_refill * dt);
  last_hand_ = now.hand;
  last_turn_ = now.hand_turn;
  last_torque_ = now.torque;
}

// A turn against a torque that the hand does not feel. It enters the account as if the hand had done
// the work, and the store pays for it.
void EnergyGuard::lend(const Vec3& torque, const Vec3& turned) BURR_RT {
  const double lent = -math::dot(torque, turned);
  energy_ += lent;
  turned_in_ += lent;
  turn_left_ = std::clamp(turn_left_ - lent, 0.0, settings_.turn_full);
}

// Surplus leaves the account for the tank. A deficit that was allowed is covered by the grant.
void EnergyGuard::settle(double dt) BURR_RT {
  if (energy_ > stored_) {
    const double lost = energy_ - stored_;
    const double back = std::min(lost, settings_.turn_full - turn_left_);
    turn_left_ += back;
    tank_ = std::min(settings_.tank_full, tank_ + (lost - back));
    energy_ = stored_;
  }
  const double paid = std::min(granted_, deficit());
  granted_ -= paid;
  energy_ += paid;
  // a deficit above tank_full is written off: it would make the hand feel heavy long afterwards
  const double forgotten = std::max(0.0, deficit() - settings_.tank_full);
  energy_ += forgotten;
  written_off_ += forgotten;
  const double back = granted_ * std::min(1.0, dt / kGrantLasts);
  granted_ -= back;
  tank_ = std::min(settings_.tank_full, tank_ + back);
}

void EnergyGuard::forget_when_free(const SpringState& now, double dt) BURR_RT {
  const bool free = stored_ <= 0 && math::squared_norm(now.force) <= 0;
  free_ = free ? free_ + dt : 0;
  if (free_ < settings_.free_time) return;
  written_off_ += deficit();
  energy_ = stored_;
}

// A sampled damper alpha on a mass m is itself unstable above m / T. Uses half of that, and less
// with delay.
double EnergyGuard::most_damping(double dt) const BURR_RT {
  const double most = 0.5 * settings_.device_mass / (dt + settings_.delay);
  const double quiet = settings_.count_force * dt;  // alpha step / T <= count_force
  return most * settings_.encoder_step > quiet ? quiet / settings_.encoder_step : most;
}

double EnergyGuard::allow(double wanted_energy) BURR_RT {
  if (!std::isfinite(wanted_energy) || wanted_energy <= 0) return 0;
  const double share = tank_ < settings_.tank_low ? tank_ / settings_.tank_low : 1.0;
  const double allowed = std::min(share * wanted_energy, tank_);
  tank_ -= allowed;
  granted_ += allowed;
  return allowed;
}

void EnergyGuard::restart() BURR_RT {
  if (begun_) written_off_ += deficit();
  begun_ = false;
  energy_ = stored_ = alpha_ = granted_ = free_ = 0;
  last_torque_ = Vec3::Zero();
  share_ = 1;
  sent_.fill({});
}

void EnergyGuard::set_largest_force(double newton) BURR_RT {
  if (std::isfinite(newton) && newton >= 0) settings_.largest_force = newton;
}

void EnergyGuard::set_largest_torque(double newton_metre) BURR_RT {
  if (std::isfinite(newton_metre) && newton_metre >= 0) settings_.largest_torque = newton_metre;
}

}  // namespace burr::haptics
