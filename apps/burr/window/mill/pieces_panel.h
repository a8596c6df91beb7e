// apps/burr/window/mill/pieces_panel.h - the list of free pieces, and the numbers of the one that is
// being moved.
//
// Plain data in, what was pressed out. Thread: main, between Ui::begin() and draw().
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "window/ui/ui.h"

namespace burr::app {

struct PiecesState {
  struct Row {
    double mm3 = 0;
    double moved_mm = 0, turned_deg = 0;  // so far
  };
  bool looking = false;  // the bone is being looked through
  bool putting = false;  // the piece is on its way into the bone
  std::vector<Row> rows;
  std::optional<std::size_t> taken;             // row of the piece in the hand
  std::array<double, 3> mm = {}, degrees = {};  // further, from where it lies
  bool carries = false;                         // a hand of a device may carry it
  bool felt = false;                            // the bone stops it
  std::string plan;  // "4.8 of 5.0 mm, 0.7 degrees off"; "": the case plans nothing
};

struct PiecesPressed {
  bool close = false, put_down = false, leave = false;
  std::optional<std::size_t> take;
  bool typed = false;  // these numbers are new
  std::array<double, 3> mm = {}, degrees = {};
};

[[nodiscard]] PiecesPressed draw_pieces(Ui& ui, const PiecesState& state);

}  // namespace burr::app
