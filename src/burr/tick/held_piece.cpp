#include "burr/tick/held_piece.h"

#include <cstddef>
#include <utility>

#include "burr/math/turn.h"

namespace burr::tick {

using math::Pose;
using math::Quat;
using math::Vec3;

HeldPiece::HeldPiece(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
                     double lever, bool turns)
    : touch_(surface, {}, settings, lever, Pose{}), turns_(turns) {}

void HeldPiece::lift(const edit::PieceBody& body) BURR_RT {
  now_ = {};
  now_.lifted = true;
  now_.goal = body.at;
  touch_.take(body.tool);
  touch_.place(body.at);
  tip_ = body.at.p;
  contact_ = {};
}

PieceRow HeldPiece::row() const BURR_RT {
  PieceRow row;
  if (!now_.lifted) return row;
  row.state = now_.held ? PieceRow::kHeld : PieceRow::kLies;
  row.p = pose().p;
  const Quat& q = pose().q;
  row.turn = {q.x(), q.y(), q.z(), q.w()};
  return row;
}

bool HeldPiece::grips(const device::HandState& hand, bool usable) BURR_RT {
  const bool down = hand.pedal > 0 && (hand.buttons & device::kOwnBits) == 0;
  if (std::exchange(now_.let_go, false)) now_.may_grab = now_.goes = false;
  now_.may_grab = usable && (now_.may_grab || !down);
  const bool holds = usable && down && now_.may_grab;
  if (now_.held && !holds) now_.goal = pose();
  now_.held = holds;
  return holds;
}

void HeldPiece::grab(const Pose& hand) BURR_RT {
  now_.goes = false;
  now_.goal = pose();
  now_.grabbed = hand;
  touch_.place(now_.goal);
}

void HeldPiece::shift(const Pose& goal, const Pose& hand) BURR_RT {
  if (!now_.lifted) return;
  // A hand that holds it lets go, and has to open its grip before it can hold again: the wanted place
  // leaps, and the force on the hand must not.
  now_.held = now_.may_grab = false;
  now_.goal = goal;
  now_.grabbed = hand;
  now_.goes = true;
}

void HeldPiece::rest(const Vec3& hand) BURR_RT {
  contact_ = {};
  tip_ = hand;
  if (!now_.goes) return;
  const haptics::Touch touch = touch_.step_pose(now_.goal);
  now_.goes = touch.lagging;
  if (!now_.goes) now_.goal = pose();
}

Pose HeldPiece::wanted(const Pose& hand) const BURR_RT {
  Pose to = now_.goal;
  to.p += hand.p - now_.grabbed.p;
  if (turns_)
    to.q = math::normalized(
        math::product(math::product(hand.q, now_.grabbed.q.conjugate()), now_.goal.q));
  return to;
}

haptics::Touch HeldPiece::step(const Vec3& hand) BURR_RT {
  return step_pose({hand, now_.grabbed.q});
}

haptics::Touch HeldPiece::step_pose(const Pose& hand) BURR_RT {
  const Pose to = wanted(hand);
  haptics::Touch touch = touch_.step_pose(to);
  contact_ = *touch_.parts();
  contact_.rests = false;  // it is no shaft
  tip_ = hand.p + (touch.proxy - to.p);
  touch.proxy = tip_;
  // arms are counted from the tool
  for (int a = 0; a < contact_.active; ++a)
    contact_.contacts[static_cast<std::size_t>(a)].arm += pose().p - tip_;
  return touch;
}

}  // namespace burr::tick
