#include "burr/tick/held_piece.h"

#include <cstddef>
#include <utility>

#include "burr/math/turn.h"

namespace burr::tick {

using math::Pose;
using math::Quat;
using math::Vec3;

HeldPiece::HeldPiece(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
                     double lever, bool turns, double rate_hz)
    : touch_(surface, {}, settings, lever, Pose{}), lever_(lever), drag_(kDrag * rate_hz) {
  hands_[kFirst].turns = turns;
}

void HeldPiece::lift(const edit::PieceBody& body) BURR_RT {
  now_ = {};
  now_.lifted = true;
  now_.goal = body.at;
  couple_to(kFirst);
  touch_.take(body.tool);
  touch_.place(body.at);
  tip_ = body.at.p;
  contact_ = {};
}

PieceRow HeldPiece::row() const BURR_RT {
  PieceRow row;
  if (!now_.lifted) return row;
  row.state = now_.holder == kFirst    ? PieceRow::kHeld
              : now_.holder == kSecond ? PieceRow::kHeldByOther
                                       : PieceRow::kLies;
  row.p = pose().p;
  const Quat& q = pose().q;
  row.turn = {q.x(), q.y(), q.z(), q.w()};
  return row;
}

bool HeldPiece::grips(int which, const device::HandState& hand, bool usable) BURR_RT {
  const bool down = hand.pedal > 0 && (hand.buttons & device::kOwnBits) == 0;
  if (which == kFirst && std::exchange(now_.let_go, false)) {
    now_.may_grab = {false, false};
    now_.goes = false;
  }
  bool& may_grab = now_.may_grab[static_cast<std::size_t>(which)];
  may_grab = usable && (may_grab || !down);
  const bool mine = now_.holder == which;
  const bool holds = usable && down && may_grab && (mine || now_.holder == kNobody);
  if (mine && !holds) {
    now_.goal = pose();
    now_.holder = kNobody;
  }
  if (holds) now_.holder = which;
  return holds;
}

void HeldPiece::couple(int which, double lever) BURR_RT {
  Coupling& hand = hands_[static_cast<std::size_t>(which)];
  hand.lever = lever;
  hand.feels = true;
  if (coupled_ == which) touch_.couple(lever);
}

void HeldPiece::couple_to(int which) BURR_RT {
  if (coupled_ == which) return;
  coupled_ = which;
  if (which == kNobody) {
    touch_.couple(kLooseLever, false);
    touch_.set_friction(0, 0);
    return;
  }
  const Coupling& hand = hands_[static_cast<std::size_t>(which)];
  touch_.couple(hand.feels ? hand.lever : lever_, hand.feels);
}

void HeldPiece::grab(const Pose& hand) BURR_RT {
  couple_to(now_.holder);
  now_.goes = false;
  now_.goal = pose();
  now_.grabbed = hand;
  touch_.place(now_.goal);
}

void HeldPiece::shift(const Pose& goal) BURR_RT {
  if (!now_.lifted) return;
  // A hand that holds it lets go, and has to open its grip before it can hold again: the wanted place
  // leaps, and the force on the hand must not.
  now_.holder = kNobody;
  now_.may_grab = {false, false};
  now_.goal = goal;
  now_.goes = true;
}

void HeldPiece::rest(const Vec3& hand) BURR_RT {
  if (!loose()) return;
  contact_ = {};
  tip_ = hand;
  if (std::exchange(now_.pushed, false) || !now_.goes) return;
  const haptics::Touch touch = touch_.step_pose(now_.goal);
  now_.goes = touch.lagging;
  if (!now_.goes) now_.goal = pose();
}

haptics::HeldTool HeldPiece::as_loose() BURR_RT {
  couple_to(kNobody);
  return {*touch_.six(), now_.goes ? now_.goal : pose(), drag_};
}

void HeldPiece::pushed(const haptics::SixTouch& six) BURR_RT {
  const Pose wanted = now_.goes ? now_.goal : pose();
  static_cast<void>(touch_.felt(six, wanted));
  now_.pushed = true;
  now_.goes = now_.goes && six.lagging;
  if (!now_.goes) now_.goal = pose();
}

Pose HeldPiece::goal(const Pose& hand) const BURR_RT {
  Pose to = now_.goal;
  to.p += hand.p - now_.grabbed.p;
  const bool turns = now_.holder != kNobody && hands_[static_cast<std::size_t>(now_.holder)].turns;
  if (turns)
    to.q = math::normalized(
        math::product(math::product(hand.q, now_.grabbed.q.conjugate()), now_.goal.q));
  return to;
}

haptics::Touch HeldPiece::step(const Vec3& hand) BURR_RT {
  return step_pose({hand, now_.grabbed.q});
}

haptics::Touch HeldPiece::step_pose(const Pose& hand) BURR_RT {
  const Pose to = goal(hand);
  return as_tool(touch_.step_pose(to), hand.p, to.p);
}

haptics::Touch HeldPiece::felt(const haptics::SixTouch& six, const Pose& hand) BURR_RT {
  const Pose to = goal(hand);
  return as_tool(touch_.felt(six, to), hand.p, to.p);
}

haptics::Touch HeldPiece::as_tool(const haptics::Touch& touch, const Vec3& hand,
                                  const Vec3& wanted) BURR_RT {
  haptics::Touch out = touch;
  contact_ = *touch_.parts();
  contact_.rests = false;  // it is no shaft
  tip_ = hand + (touch.proxy - wanted);
  out.proxy = tip_;
  // arms are counted from the tool
  for (int a = 0; a < contact_.active; ++a)
    contact_.contacts[static_cast<std::size_t>(a)].arm += pose().p - tip_;
  return out;
}

}  // namespace burr::tick
