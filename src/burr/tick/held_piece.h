// tick/held_piece.h - a piece of bone that was lifted out of the bone: the body that a hand holds in
// place of its tool.
//
//     restore.h:  lift(body)  ...  drop()
//     servo:      grips(hand) and the hand is new to it: grab(hand)    then it is a method of touch
//                 otherwise: rest()
//
// The piece touches the bone that is left as any tool does (haptics/six/tool_touch.h). A hand that grabs
// holds it rigidly from then on, wherever on the piece it is: the piece is wanted as far from where it was
// grabbed as the hand has moved, and turned about its own centre as the hand has turned. So nothing is
// pressed in the tick in which it is grabbed. Force and torque are those at the piece's centre, and act on
// the hand as if it held it there. A hand that does not tell how it is turned does not turn it.
//
// While no hand holds it the piece stays where it is, or goes on to where shift() wants it, as far as the
// bone lets it; no force comes of that.
//
// Touch::proxy is the place of the hand's tool, carried along rigidly by the piece. Thread: servo. Frame:
// world. Units: SI. Memory: taken at construction.
#pragma once

#include "burr/device/hand.h"
#include "burr/edit/piece_move.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/haptics/touch_method.h"
#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/tick/rows.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

class HeldPiece final : public haptics::TouchMethod {
 public:
  // turns: the hand tells how it is turned. lever: L = sqrt(k_r / k_t)  [m]
  HeldPiece(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
            double lever, bool turns);

  // Its surface is out of the bone from now on; it lies where it lay.
  void lift(const edit::PieceBody& body) BURR_RT;
  // It is bone again, or will be.
  void drop() BURR_RT { now_ = {}; }
  [[nodiscard]] bool lifted() const BURR_RT { return now_.lifted; }
  // world_from_tool of the body (edit/piece_body.h): the piece's centre, and its turn from where it came
  // free.
  [[nodiscard]] const math::Pose& pose() const BURR_RT { return touch_.pose(); }
  [[nodiscard]] PieceRow row() const BURR_RT;

  // The hand holds it: by the button that drives a tool, or the pedal, once that was up after the piece
  // was lifted and after the hand was lost. usable: the reading of this tick.
  [[nodiscard]] bool grips(const device::HandState& hand, bool usable) BURR_RT;
  void grab(const math::Pose& hand) BURR_RT;
  // The hand lets go, until its button was up.
  void let_go() BURR_RT { now_.let_go = true; }
  // Another place for it, as the body's pose; a hand that holds it lets go, or its force would leap with the place.
  void shift(const math::Pose& goal, const math::Pose& hand) BURR_RT;
  // A tick in which no hand holds it. hand: where the hand is.
  void rest(const math::Vec3& hand) BURR_RT;

  void couple(double lever) BURR_RT { touch_.couple(lever); }
  void set_max_moves(int moves) BURR_RT { touch_.set_max_moves(moves); }

  // ---- as a method of touch
  void place(const math::Vec3&) BURR_RT override {}  // the piece stays where it is
  [[nodiscard]] haptics::Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] haptics::Touch step_pose(const math::Pose& hand) BURR_RT override;
  [[nodiscard]] const haptics::ToolContact* parts() const BURR_RT override { return &contact_; }
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return tip_; }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override {
    touch_.set_friction(mu_static, mu_kinetic);
  }
  [[nodiscard]] bool set_radius(double) BURR_RT override { return false; }

 private:
  struct State {
    bool lifted = false;
    bool held = false;      // in this tick
    bool may_grab = false;  // the button was up
    bool let_go = false;    // before this tick
    bool goes = false;      // to `goal`, with no hand
    math::Pose goal;        // where it is wanted, or was when the hand grabbed it
    math::Pose grabbed;     // the hand, then
  };
  [[nodiscard]] math::Pose wanted(const math::Pose& hand) const BURR_RT;

  haptics::ToolTouch touch_;
  haptics::ToolContact contact_;
  bool turns_;
  State now_;
  math::Vec3 tip_ = math::Vec3::Zero();
};

}  // namespace burr::tick
