#include "burr/tick/hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "burr/math/elementary.h"
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
      blend_(1 - math::exponential(-2 * std::numbers::pi * settings.velocity_filter_hz * dt_)),
      guarded_(settings.guarded),
      turned_(settings.turned && device.spec().peak_torque > 0),
      guard_({.slack = settings.guard_slack,
              .largest_force = std::min(device.spec().peak_force, settings.limit.user_force),
              .largest_torque = most_torque(settings.limit.user_force)}),
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
  now.hand_turn = state_.world_from_tool.q;
  if (parts_ != nullptr) {
    now.torque = contact_torque();
    now.turn_stiffness = force_.stiffness * (parts_->lever * parts_->lever);
  }
  const Vec3 force = guard_.step(now, dt_);
  if (guard_.damping() > 0 || guard_.fades()) flags |= rt::kFlagGuarded;
  return force;
}

Hand::Sent Hand::send(const Vec3& force, std::uint32_t& flags) BURR_RT {
  Sent sent;
  sent.force = limit_.apply(force, dt_, flags);
  device_.write_force(sent.force);
  return sent;
}

// A ball has no lever: there force and twist are limited each by itself.
Hand::Sent Hand::send(const Vec3& force, const Beside& beside, std::uint32_t& flags) BURR_RT {
  Sent sent;
  if (turned_ && parts_ != nullptr) {
    const double per_hand = 1 / device_.spec().scale;  // of work done in the world
    const Vec3 torque = per_hand * (contact_torque() + beside.moment) + beside.twist;
    const haptics::Wrench allowed =
        limit_.apply({force + beside.force, torque}, beside.twist, dt_, flags);
    sent = {allowed.force, allowed.torque};
  } else {
    sent.force = limit_.apply(force + beside.force, dt_, flags);
    sent.torque = limit_.apply_torque(beside.twist, dt_, flags);
  }
  device_.write_torque(sent.torque);
  device_.write_force(sent.force);
  return sent;
}

Vec3 Hand::touch_part(const Sent& sent, const Beside& beside) BURR_RT {
  const Vec3 touched = limit_.engaged() ? Vec3(sent.force - beside.force) : sent.force;
  Vec3 turned = sent.torque;
  const double scale = device_.spec().scale;
  if (limit_.engaged()) turned -= beside.twist + beside.moment / scale;
  guard_.sent(touched, turned_ && parts_ != nullptr ? Vec3(scale * turned) : Vec3(Vec3::Zero()));
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
  if (!turned_) contact.unsent_torque = contact_torque();
}

void Hand::set_user_force(double newton) BURR_RT {
  limit_.set_user_force(newton);
  guard_.set_largest_force(std::min(device_.spec().peak_force, newton));
  guard_.set_largest_torque(most_torque(newton));
}

// In the proportion of the force, as limit.h has it; 0: none is sent.
double Hand::most_torque(double user_force) const BURR_RT {
  const device::DeviceSpec& spec = device_.spec();
  if (!turned_ || spec.peak_force <= 0) return 0;
  return spec.scale * spec.peak_torque * std::min(1.0, user_force / spec.peak_force);
}

}  // namespace burr::tick
