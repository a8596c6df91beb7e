// apps/burr/window/mill/piece_carrier.h - free pieces of bone in the hands of the user: by which hand,
// key or mouse a piece is carried, what the tools do meanwhile, and the panel with the list.
//
// What a piece does is in piece_mode.h. Thread: main; draw_panel() between Ui::begin() and
// Ui::draw(). Frame: world. Units: SI; pixels of the mouse.
#pragma once

#include <SDL2/SDL.h>

#include <optional>

#include "window/mill/mill_site.h"
#include "window/mill/mill_tools.h"
#include "window/mill/piece_mode.h"
#include "window/mill/pointer.h"

namespace burr::app {

class PieceCarrier {
 public:
  PieceCarrier(const MillSite& site, const Pointer& pointer, MillTools& tools);

  void begin();  // before the session starts
  void end();    // before it stops

  void look();  // in each picture
  [[nodiscard]] bool has_piece() const { return pieces_ && pieces_->taken(); }
  // As PieceMode::moved().
  [[nodiscard]] std::optional<edit::PieceStore> moved() const {
    return pieces_ ? pieces_->moved() : edit::PieceStore();
  }
  // The axes of the hand stay as they are meanwhile: a turned view must not turn the piece.
  [[nodiscard]] bool carries() const { return pieces_ && pieces_->carried(); }

  // A key that moves the piece in the hand; false: it is none of them.
  bool key(const SDL_Keysym& pressed);
  // With the button that mills, in the plane of the picture.
  void drag(const SDL_MouseMotionEvent& motion);
  // True: a piece was taken, so the hand must be lifted.
  [[nodiscard]] bool draw_panel(Ui& ui);

 private:
  void carry();
  [[nodiscard]] bool other_hand_carries() const;

  Desk& desk_;
  sim::Session& session_;
  render::Scene& scene_;
  const mouse::Hands& hands_;
  const WindowOptions& options_;
  const tick::TickRow& row_;
  MillNotes& notes_;
  MillOver& over_;
  const Pointer& pointer_;
  MillTools& tools_;
  std::optional<PieceMode> pieces_;
  std::optional<tick::ToolMode> mode_before_;  // of the tool, while a piece is taken by a real hand
};

}  // namespace burr::app
