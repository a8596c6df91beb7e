// apps/burr/window/mill/piece_mode.h - free pieces of bone on the page for milling: the window
// says that one has come free, frames it, and lets it be moved as a ghost and put down.
//
// A piece that is taken is lifted out of the bone (tick/held_piece.h): the bone stops it, and a hand that
// holds it feels that. Where it cannot be lifted (too thin, no room) it is a picture only, and the bone stays
// as it was until the piece is put down. Either way one recorded undo takes the whole move back. Thread: main; the work is done beside it (sim/piece_mover.h).
// Frame: world. Units: SI.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/render/scene.h"
#include "burr/scenario/lesson.h"
#include "burr/sim/piece_mover.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/piece_plan.h"
#include "window/mill/pieces_panel.h"

namespace burr::app {

class PieceMode {
 public:
  static constexpr double kStep = 0.5e-3, kFineStep = 0.1e-3;  // of a key                [m]
  static constexpr double kTurn = 1, kFineTurn = 0.2;          // of a key           [degree]

  // Before the session starts. lesson: nullptr without a case; must outlive this. moved: in the
  // earlier parts of a session that is continued.
  PieceMode(sim::Session& session, const scenario::CaseLesson* lesson, edit::PieceStore moved = {});

  // Once a picture. What the user should read; empty: nothing new. open: the panel is shown.
  // row: the newest one.
  [[nodiscard]] std::string look(bool open, const tick::TickRow& row = {});
  // Draws the frames of the free pieces, and the ghost of the one under way. shown: the panel is open.
  void show(render::Scene& scene, bool shown);

  // Before look(): a tube that draws in splinters; none: nothing does.
  void suck(const std::optional<sim::PieceMover::Suction>& by) { mover_.suck(by); }

  // The pieces that were moved so far; none: one is out of the bone, or on its way.
  [[nodiscard]] std::optional<edit::PieceStore> moved() const {
    return mover_.busy() ? std::nullopt : std::optional(mover_.store());
  }

  [[nodiscard]] bool taken() const { return taken_.has_value(); }
  void take(std::size_t row);
  void leave();
  // Call it before the session stops. A lifted piece goes back to where it lay; where the user had already
  // asked to put it down, it is put down. Waits until that is done: mostly some hundredths of a second, at most 10 s.
  void end();
  void put_down();
  // In the picture's axes, by keys and mouse.
  void shift(const math::Vec3& by);
  void turn(const math::Vec3& axis, double degrees);
  // Once a picture: a hand of its own orientation, as it is now. While it grabs, the piece goes where the
  // hand goes, and turns about its own centre as the hand turns; a hand that lets go may move back and
  // grab again. It must have let go once after the piece was taken. turns: the device knows how the
  // hand is turned. A key, the mouse or a typed number meanwhile counts too.
  struct Carrier {
    math::Pose hand;
    bool grabs = false, turns = false;
    int which = 0;  // 0: the first hand, 1: the second
  };
  void carry(const Carrier& by);
  [[nodiscard]] bool carried() const {
    return taken_ && (taken_->grip || held_.state == tick::PieceRow::kHeld ||
                      held_.state == tick::PieceRow::kHeldByOther);
  }
  // Of the panel: typed numbers, along and about the patient's axes.
  void set(const std::array<double, 3>& mm, const std::array<double, 3>& degrees);

  [[nodiscard]] PiecesState state() const;

 private:
  struct Taken {
    edit::PieceStore::Found piece;
    std::size_t row = 0;
    math::Vec3 by = math::Vec3::Zero();        // further, from where it lies now
    math::Quat turn = math::Quat::Identity();  // further
    const scenario::PlannedPiece* plan = nullptr;
    std::shared_ptr<const render::CoarseMesh> mesh;  // where it came free
    struct Grip {                                    // when the hand grabbed
      math::Vec3 hand = math::Vec3::Zero(), by = math::Vec3::Zero();
      math::Quat held = math::Quat::Identity(), turn = math::Quat::Identity();
      int which = 0;
    };
    std::optional<Grip> grip;
    bool may_grab = false;  // no hand grabbed since it was taken
    bool asked = false;     // for another place
    bool seen_out = false;  // of the bone
    bool lifts = false;     // it is on its way out of the bone, or out
  };
  // It is out of the bone.
  [[nodiscard]] bool out() const { return held_.state != tick::PieceRow::kNone; }
  void want();
  void follow();
  [[nodiscard]] math::Pose pose_of(const Taken& taken) const;
  [[nodiscard]] std::string plan_text() const;
  void frame(render::Scene& scene, const edit::PieceStore::Found& piece, double line) const;

  sim::Session& session_;
  const scenario::CaseLesson* lesson_;
  sim::PieceMover mover_;
  std::shared_ptr<const std::vector<edit::PieceStore::Found>> list_;
  std::vector<std::array<math::Vec3, 2>> boxes_;  // of the pieces of the list, where they came free
  bool asked_ = false, putting_ = false;
  tick::PieceRow held_;  // of the newest row
  std::uint64_t listed_writes_ = 0;
  std::optional<Taken> taken_;
  double line_ = 0;  // radius of the frames' rods; 0: none drawn
  workshop::PieceLook ghost_;
};

}  // namespace burr::app
