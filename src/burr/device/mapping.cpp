#include "burr/device/mapping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace burr::device {

using math::Quat;
using math::Vec3;

MappedHand::MappedHand(std::unique_ptr<Device> device, const math::Pose& start,
                       const Quat& world_from_hand, const MappingSettings& settings)
    : device_(std::move(device)),
      settings_(settings),
      requested_axes_(world_from_hand),
      turn_(world_from_hand * settings.axes),
      requested_(turn_),
      at_(start.p),
      tip_(start.p),
      held_(start.q) {}

Status MappedHand::open() {
  if (open_) return fine();
  Status opened = device_->open();
  if (!opened) return opened;
  open_ = true;
  return set(settings_);
}

Status MappedHand::set(const MappingSettings& settings) {
  if (!(settings.scale >= 0.1 && settings.scale <= 10))
    return error(
        Trouble::usage,
        fmt::format("a device's scale of {} is out of range; use 0.1 to 10", settings.scale));
  settings_ = settings;
  turn_ = requested_ = requested_axes_ * settings_.axes;
  spec_ = device_->spec();
  spec_.max_stiffness /= settings_.scale;
  spec_.max_damping /= settings_.scale;
  spec_.max_turn_stiffness *= settings_.scale;
  spec_.turn_damping *= settings_.scale;
  spec_.lever *= settings_.scale;
  spec_.scale = settings_.scale;
  return fine();
}

HandState MappedHand::state(double dt) BURR_RT {
  HandState hand = device_->state(dt);
  hand.buttons &= ~kHovers;  // only a hand that burr makes itself hovers
  if (!hand.valid || !hand.world_from_tool.finite()) {
    anchored_ = false;  // the tip stays where it is, wherever the hand comes back
    hand.world_from_tool.q = held_;
    if (hand.world_from_tool.p.allFinite()) hand.world_from_tool.p = tip_;
    return hand;
  }
  const Vec3 raw = hand.world_from_tool.p;
  const auto down = [&hand](int button) {
    return button >= 0 && button < 30 && (hand.buttons >> button & 1U) != 0;
  };
  const double foot = pedal_.load(std::memory_order_relaxed);
  const bool asleep =
      settings_.dead_man && !down(settings_.mill_button) && foot <= 0 && hand.pedal <= 0;
  const bool lifted = asleep || (hand.buttons & kLifted) != 0 ||
                      lifted_.load(std::memory_order_relaxed) || down(settings_.clutch_button);
  if (turns_.take(requested_axes_)) requested_ = requested_axes_ * settings_.axes;
  const bool grips = carries_.load(std::memory_order_relaxed) && !lifted &&
                     (down(settings_.mill_button) || foot > 0 || hand.pedal > 0);
  const bool rests = !grips && forced_ == Vec3::Zero() && twisted_ == Vec3::Zero();
  const bool turns = rests && turn_.coeffs() != requested_.coeffs();
  if (lifted || !anchored_ || turns) {
    at_ = tip_;
    from_ = raw;
    anchored_ = true;
    if (rests) turn_ = requested_;
  }
  tip_ = at_ + settings_.scale * (turn_ * (raw - from_));
  held_ = turn_ * hand.world_from_tool.q;
  hand.world_from_tool = {tip_, held_};
  hand.velocity = lifted ? Vec3(Vec3::Zero()) : Vec3(settings_.scale * (turn_ * hand.velocity));
  hand.pedal = std::max(hand.pedal, foot);
  if (down(settings_.mill_button)) hand.pedal = 1;
  if (lifted) {
    hand.pedal = 0;
    hand.buttons |= kLifted;
  }
  return hand;
}

void MappedHand::write_force(const Vec3& force) BURR_RT {
  forced_ = force;
  twisted_ = torque_;
  torque_ = Vec3::Zero();
  device_->write_force(turn_.conjugate() * force);
}

}  // namespace burr::device
