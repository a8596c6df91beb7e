#include "burr/haptics/six/tool_touch.h"

#include <algorithm>

#include "burr/math/sums.h"

namespace burr::haptics {

using math::Pose;
using math::Vec3;

Touch touch_of(const SixTouch& six, const tool::Tool& tool, double lever,
               ToolContact& contact) BURR_RT {
  Touch touch;
  touch.proxy = six.world_from_tool.p;
  touch.active = std::min(six.active, 3);
  touch.candidates = six.candidates;
  touch.lagging = six.lagging;
  touch.overflow = six.overflow;
  const Vec3 pressed = six.stretch - six.held;
  touch.depth = math::norm(pressed);
  touch.touching = (six.active > 0 || six.meets) && touch.depth > 1e-12;
  if (touch.touching) {
    touch.normal = pressed / touch.depth;
    touch.tangential = six.held;
  }
  touch.stuck = six.stuck;
  for (int a = 0; a < six.active; ++a) {
    const SixContact& one = six.contacts[static_cast<std::size_t>(a)];
    touch.pressing += one.load;
    const tool::Role role = tool.parts[static_cast<std::size_t>(one.part)].role;
    if (role == tool::Role::cuts) contact.head += one.load * one.normal;
    if (role == tool::Role::rubs && one.load > 0) contact.rests = true;
  }
  contact.lever = lever;
  contact.torque = six.turn * (lever * lever);
  contact.turn = six.turn;
  contact.active = six.active;
  contact.contacts = six.contacts;
  contact.by_part = true;
  return touch;
}

void limit_turn(const math::Quat& hand, double slip, TurnLimit& limit,
                ToolContact& contact) BURR_RT {
  const double lever = contact.lever;
  if (lever <= 0) return;
  Vec3 turn = contact.torque / (lever * lever);
  limit.step(hand, slip / lever, turn);
  contact.torque = turn * (lever * lever);
}

ToolTouch::ToolTouch(const volume::IsoVertices& surface, const tool::Tool& tool,
                     const ProxySettings& settings, double lever, const Pose& hand)
    : six_(surface, tool,
           {.lever = lever,
            .max_moves = settings.max_moves,
            .close = settings.tool_close,
            .push_out_speed = settings.push_out_speed,
            .wedge = settings.wedge,
            .planes = settings.planes},
           hand),
      slip_(settings.slip),
      per_tick_(settings.slip),
      lever_(lever),
      rubs_(settings.parts_rub),
      pose_(hand) {
  set_friction(settings.friction_static, settings.friction_kinetic);
}

void ToolTouch::take(const tool::Tool& tool) BURR_RT {
  six_.take(tool);
  slip_.restart();
  turn_limit_.restart();
  contact_ = {};
}

void ToolTouch::place(const Pose& world_from_tool) BURR_RT {
  pose_ = world_from_tool;
  six_.place(pose_);
  slip_.restart();
  turn_limit_.restart();
  contact_ = {};
}

void ToolTouch::place(const Vec3& p) BURR_RT { place(Pose{p, pose_.q}); }

Touch ToolTouch::step(const Vec3& hand) BURR_RT { return step_pose({hand, pose_.q}); }

Touch ToolTouch::step_pose(const Pose& hand) BURR_RT { return felt(six_.step(hand), hand); }

Touch ToolTouch::felt(const SixTouch& six, const Pose& hand) BURR_RT {
  contact_ = {};
  pose_ = six.world_from_tool;
  Touch touch = touch_of(six, six_.tool(), lever_, contact_);
  const bool rests = six.active > 0 || six.meets;
  const bool limited = slip_.step(hand.p, follows_ || rests, touch);
  follows_ = rests || limited;
  if (turns_) limit_turn(hand.q, per_tick_, turn_limit_, contact_);
  return touch;
}

}  // namespace burr::haptics
