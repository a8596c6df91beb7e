#include "burr/haptics/six/shaft_touch.h"

#include <cmath>

#include "burr/haptics/six/tool_touch.h"
#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Pose;
using math::Vec3;

tool::Tool burr_of(double radius) BURR_RT {
  tool::Burr burr;
  burr.radius = radius;
  return tool::burr_with_shaft(burr);
}

// Beyond it the head is not where the proxy of three unknowns has it                  [m]
constexpr double kSamePlace = 1e-7;

}  // namespace

ShaftTouch::ShaftTouch(const volume::IsoVertices& surface, const ProxySettings& settings,
                       const Vec3& hand)
    : ball_(surface, settings, hand),
      six_(surface, burr_of(settings.radius),
           {.lever = kLever,
            .max_moves = settings.max_moves,
            .close = settings.tool_close,
            .push_out_speed = settings.push_out_speed,
            .wedge = settings.wedge,
            .planes = false},
           {hand, math::Quat::Identity()}),
      slip_(settings.slip),
      per_tick_(settings.slip),
      rubs_(settings.parts_rub) {
  set_friction(settings.friction_static, settings.friction_kinetic);
}

void ShaftTouch::place(const Vec3& p) BURR_RT {
  ball_.place(p);
  shaft_ = rests_ = false;
  slip_.restart();
  turn_limit_.restart();
}

void ShaftTouch::set_friction(double mu_static, double mu_kinetic) BURR_RT {
  ball_.set_friction(mu_static, mu_kinetic);
  if (rubs_) friction_ = {mu_static, mu_kinetic};
}

bool ShaftTouch::set_radius(double radius) BURR_RT {
  if (!ball_.set_radius(radius)) return false;
  six_.take(burr_of(radius));
  shaft_ = false;  // until the new neck is free
  return true;
}

void ShaftTouch::set_max_moves(int moves) BURR_RT {
  ball_.set_max_moves(moves);
  six_.set_max_moves(moves);
}

// Without an orientation of the hand there is no shaft.
Touch ShaftTouch::step(const Vec3& hand) BURR_RT {
  shaft_ = rests_ = false;
  return ball_.step(hand);
}

// Does any contact that carries something belong to a part that only rubs?
bool ShaftTouch::shaft_rests(const SixTouch& six) const BURR_RT {
  for (int a = 0; a < six.active; ++a) {
    const SixContact& contact = six.contacts[static_cast<std::size_t>(a)];
    const auto part = static_cast<std::size_t>(contact.part);
    if (six_.tool().parts[part].role == tool::Role::rubs && contact.load > 0) return true;
  }
  return false;
}

// The head rests as the proxy of three unknowns says, if the shaft lets it get there.
Touch ShaftTouch::as_ball(const Pose& hand) BURR_RT {
  const Touch touch = ball_.step(hand.p);
  if (!shaft_) {
    const Pose there{touch.proxy, hand.q};
    if (!six_.is_free(there)) return touch;
    six_.place(there);
    shaft_ = true;
    return touch;
  }
  const Pose goal{touch.proxy, hand.q};
  six_.set_friction({});  // it follows the head, which has felt its friction
  const SixTouch six = six_.step(goal);
  rests_ = shaft_rests(six) || six.lagging;
  // what the head's discs and the points of six unknowns differ by is rounding
  if (!rests_ && math::norm(six.stretch) < kSamePlace) six_.place(goal);
  return touch;
}

Touch ShaftTouch::as_tool(const SixTouch& six) BURR_RT {
  Touch touch = touch_of(six, six_.tool(), lever_, contact_);
  // the next tick of the head alone begins here
  ball_.place(touch.proxy);
  return touch;
}

void ShaftTouch::limit_torque(const math::Quat& hand) BURR_RT {
  if (!turns_) return;
  contact_.lever = lever_;  // also where only the head touches: what is left of the torque fades
  limit_turn(hand, per_tick_, turn_limit_, contact_);
}

Touch ShaftTouch::step_pose(const Pose& hand) BURR_RT {
  contact_ = {};
  Touch touch;
  if (!rests_) touch = as_ball(hand);
  if (rests_) {
    six_.set_friction(friction_);
    const SixTouch six = six_.step(hand);
    touch = as_tool(six);
    contact_.rests = rests_ = contact_.rests || six.lagging;
    follows_ = follows_ || rests_;
  }
  limit_torque(hand.q);
  const bool limited = slip_.step(hand.p, follows_, touch);
  follows_ = contact_.rests || limited;
  return touch;
}

Touch ShaftTouch::felt(const SixTouch& six, const Pose& hand) BURR_RT {
  contact_ = {};
  Touch touch = as_tool(six);
  contact_.rests = contact_.rests || six.lagging;
  // the next tick goes on in six unknowns, until nothing but the head touches
  rests_ = true;
  limit_torque(hand.q);
  static_cast<void>(slip_.step(hand.p, true, touch));
  follows_ = true;
  return touch;
}

}  // namespace burr::haptics
