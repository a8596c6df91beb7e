// tick/held_piece.h - a piece of bone that was lifted out of the bone: the body that a hand holds in
// place of its tool.
//
//     restore.h:  lift(body)  ...  drop()
//     each hand:  grips(hand) and the hand is new to it: grab(hand)    then it is a method of touch
//     at the end of touch: rest()
//
// One hand holds it at a time: the one that gripped first. The other one's tool meets it, as two tools meet
// (haptics/six/two_tools.h). While nobody holds it, a tool in the second hand pushes it: it is loose(), which
// means that it moves by contact only, against a drag, as in soft tissue; it has no weight and does not go on by
// itself.
//
// The piece touches the bone that is left as any tool does (haptics/six/tool_touch.h). A hand that grabs
// holds it rigidly from then on, wherever on the piece it is: the piece is wanted as far from where it was
// grabbed as the hand has moved, and turned about its own centre as the hand has turned. So nothing is
// pressed in the tick in which it is grabbed. Force and torque are those at the piece's centre, and act on
// the hand as if it held it there. A hand that does not tell how it is turned does not turn it.
//
// While no hand holds it and no tool pushes it the piece stays where it is, or goes on to where shift() wants
// it, as far as the bone lets it; no force comes of that.
//
// Touch::proxy is the place of the hand's tool, carried along rigidly by the piece. Thread: servo. Frame:
// world. Units: SI. Memory: taken at construction.
#pragma once

#include <array>

#include "burr/device/hand_state.h"
#include "burr/edit/moved_bricks.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/haptics/six/two_tools.h"
#include "burr/haptics/touch_method.h"
#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/tick/rows.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

class HeldPiece final : public haptics::TouchMethod {
 public:
  static constexpr int kNobody = -1, kFirst = 0, kSecond = 1;  // whose hand
  // Force of the drag on a loose piece, over its speed, and the lever of the same for its turns.
  static constexpr double kDrag = 2;           // [N s/m]
  static constexpr double kLooseLever = 5e-3;  // [m]

  // turns: the first hand tells how it is turned. lever: L = sqrt(k_r / k_t) of a hand that feels no
  // torque  [m]
  HeldPiece(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
            double lever, bool turns, double rate_hz);

  // Before the session: the second hand. As above.
  void join(bool turns) { hands_[kSecond].turns = turns; }

  // Its surface is out of the bone from now on; it lies where it lay.
  void lift(const edit::PieceBody& body) BURR_RT;
  // It is bone again, or will be.
  void drop() BURR_RT { now_ = {}; }
  [[nodiscard]] bool lifted() const BURR_RT { return now_.lifted; }
  // Whose hand holds it.
  [[nodiscard]] int holder() const BURR_RT { return now_.holder; }
  // world_from_tool of the body (edit/piece_body.h): the piece's centre, and its turn from where it came
  // free.
  [[nodiscard]] const math::Pose& pose() const BURR_RT { return touch_.pose(); }
  [[nodiscard]] PieceRow row() const BURR_RT;

  // The hand holds it: by the button that drives a tool, or the pedal, once that was up after the piece
  // was lifted and after the hand was lost, and while the other hand does not hold it. usable: the reading of
  // this tick. Each tick the first hand first.
  [[nodiscard]] bool grips(int which, const device::HandState& hand, bool usable) BURR_RT;
  // That hand is new to it.
  void grab(const math::Pose& hand) BURR_RT;
  // Both hands let go, until their buttons were up.
  void let_go() BURR_RT { now_.let_go = true; }
  // Another place for it, as the body's pose; a hand that holds it lets go, or its force would leap with the place.
  void shift(const math::Pose& goal) BURR_RT;
  // After touch: a tick in which no hand holds it. hand: where the first hand is.
  void rest(const math::Vec3& hand) BURR_RT;

  // Lifted, and nobody holds it: as the other of two tools, of which the drag of one tick is the spring.
  [[nodiscard]] bool loose() const BURR_RT { return now_.lifted && now_.holder == kNobody; }
  [[nodiscard]] haptics::HeldTool as_loose() BURR_RT;
  // Instead of rest(): what was found for it together with the tool that pushes it.
  void pushed(const haptics::SixTouch& six) BURR_RT;

  // A hand that feels the torque: L of its springs  [m]
  void couple(int which, double lever) BURR_RT;
  void set_max_moves(int moves) BURR_RT { touch_.set_max_moves(moves); }

  // ---- as a method of touch
  void place(const math::Vec3&) BURR_RT override {}  // the piece stays where it is
  [[nodiscard]] haptics::Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] haptics::Touch step_pose(const math::Pose& hand) BURR_RT override;
  [[nodiscard]] haptics::SixProxy* six() BURR_RT override { return touch_.six(); }
  [[nodiscard]] math::Pose goal(const math::Pose& hand) const BURR_RT override;
  [[nodiscard]] haptics::Touch felt(const haptics::SixTouch& six,
                                    const math::Pose& hand) BURR_RT override;
  [[nodiscard]] const haptics::ToolContact* parts() const BURR_RT override { return &contact_; }
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return tip_; }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override {
    touch_.set_friction(mu_static, mu_kinetic);
  }
  [[nodiscard]] bool set_radius(double) BURR_RT override { return false; }

 private:
  struct Coupling {  // of a hand
    bool turns = false, feels = false;
    double lever = 0;  // where it feels the torque
  };
  struct State {
    bool lifted = false;
    int holder = kNobody;                           // in this tick
    std::array<bool, 2> may_grab = {false, false};  // the button was up
    bool let_go = false;                            // before this tick
    bool goes = false;                              // to `goal`, with no hand
    bool pushed = false;                            // in this tick
    math::Pose goal;     // where it is wanted, or was when the hand grabbed it
    math::Pose grabbed;  // the hand, then
  };
  void couple_to(int which) BURR_RT;
  [[nodiscard]] haptics::Touch as_tool(const haptics::Touch& touch, const math::Vec3& hand,
                                       const math::Vec3& wanted) BURR_RT;

  haptics::ToolTouch touch_;
  haptics::ToolContact contact_;
  double lever_, drag_;  // [m], [N/m] in a tick
  std::array<Coupling, 2> hands_;
  int coupled_ = kFirst;  // whose springs turn it
  State now_;
  math::Vec3 tip_ = math::Vec3::Zero();
};

}  // namespace burr::tick
