#include "burr/tick/hand.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/rt/flags.h"

namespace burr::tick {

using math::Vec3;

Hand::Hand(device::Device& device, haptics::Proxy& constraint, const haptics::ForceSettings& force,
           const HandSettings& settings)
    : device_(device),
      constraint_(constraint),
      force_(force),
      method_(&constraint),
      dt_(1.0 / settings.rate_hz),
      blend_(1 - std::exp(-2 * M_PI * settings.velocity_filter_hz * dt_)),
      guarded_(settings.guarded),
      guard_({.slack = settings.guard_slack,
              .largest_force = std::min(device.spec().peak_force, settings.limit.user_force)}),
      limit_(device.spec(), settings.limit) {}

bool Hand::read(bool lost, std::uint32_t& flags) BURR_RT {
  state_ = device_.state(dt_);
  if (lost) {
    limit_.restart();
    flags |= rt::kFlagWatchdog;
    faults_.raise();
  }
  if (hovers()) limit_.forget_reading();
  const bool usable = limit_.accept_reading(state_, flags);
  if ((state_.buttons & device::kLifted) != 0) lift();
  if (!usable) faults_.raise();
  return usable;
}

bool Hand::engage() BURR_RT {
  if (engaged_) return true;
  const math::Pose& hand = state_.world_from_tool;
  touch_ = {};
  touch_.proxy = hand.p;
  parts_ = nullptr;
  if (!free_at(hand)) return false;
  begin_at(hand);
  return true;
}

void Hand::set_down() BURR_RT {
  const math::Pose& hand = state_.world_from_tool;
  if (free_at(hand)) begin_at(hand);
}

void Hand::feel() BURR_RT {
  touch_ = method_->step_pose(state_.world_from_tool);
  parts_ = method_->parts();
  if (!hovers()) return;
  touch_ = {};  // no contact, no force
  parts_ = nullptr;
  touch_.proxy = method_->position();
}

void Hand::feel_held_tool() BURR_RT {
  touch_ = {};
  parts_ = nullptr;
  touch_.proxy = method_->position();
  const Vec3 stretch = touch_.proxy - state_.world_from_tool.p;
  touch_.depth = math::norm(stretch);
  if (engaged_ && !hovers() && touch_.depth > 1e-9) {
    touch_.normal = stretch / touch_.depth;
    touch_.touching = true;
  }
}

void Hand::skip_touch() BURR_RT {
  touch_ = {};
  parts_ = nullptr;
  touch_.proxy = method_->position();
  velocity_ = Vec3::Zero();
}

Vec3 Hand::limit_energy(const Vec3& wanted, bool begins_anew, std::uint32_t& flags) BURR_RT {
  if (!guarded_) return wanted;
  if (begins_anew) guard_.restart();
  haptics::SpringState now;
  now.hand = state_.world_from_tool.p;
  if (touch_.touching) now.stretch = touch_.depth * touch_.normal + touch_.tangential;
  now.stiffness = force_.stiffness;
  now.force = wanted;
  const Vec3 force = guard_.step(now, dt_);
  if (guard_.damping() > 0) flags |= rt::kFlagGuarded;
  return force;
}

Hand::Sent Hand::send(const Vec3& force, std::uint32_t& flags) BURR_RT {
  Sent sent;
  sent.force = limit_.apply(force, dt_, flags);
  device_.write_force(sent.force);
  return sent;
}

Hand::Sent Hand::send(const Vec3& force, const Vec3& torque, std::uint32_t& flags) BURR_RT {
  Sent sent;
  sent.force = limit_.apply(force, dt_, flags);
  sent.torque = limit_.apply_torque(torque, dt_, flags);
  device_.write_torque(sent.torque);
  device_.write_force(sent.force);
  return sent;
}

Vec3 Hand::touch_part(const Vec3& sent, const Vec3& spindle) BURR_RT {
  const Vec3 touched = limit_.engaged() ? Vec3(sent - spindle) : sent;
  guard_.sent(touched);
  return touched;
}

void Hand::report(const Sent& sent, haptics::Contact& contact) const BURR_RT {
  contact.proxy = touch_.proxy;
  contact.normal = touch_.normal;
  contact.force = sent.force;
  contact.torque = sent.torque;
  contact.depth = touch_.depth;
  contact.active = touch_.active;
  contact.candidates = touch_.candidates;
  contact.touching = touch_.touching && !touch_.slipping;
  if (touch_.lagging) contact.flags |= rt::kFlagLagging;
  if (touch_.overflow) contact.flags |= rt::kFlagCandidates;
  if (parts_ == nullptr) return;
  if (parts_->rests) contact.flags |= rt::kFlagShaft;
  contact.turn = parts_->turn;
  contact.unsent_torque = force_.stiffness * parts_->torque;
}

void Hand::set_user_force(double newton) BURR_RT {
  limit_.set_user_force(newton);
  guard_.set_largest_force(std::min(device_.spec().peak_force, newton));
}

}  // namespace burr::tick
