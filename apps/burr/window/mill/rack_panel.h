// apps/burr/window/mill/rack_panel.h - the tools that the user may take, as pictures beside the
// buttons at the left.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "window/ui/ui.h"

namespace burr::app {

struct RackTile {
  std::string name, about;  // "Flame, 3 mm"; "turns, 80 000 rpm"
  unsigned picture = 0;     // OpenGL's name of a texture; 0: not yet drawn
  bool chosen = false;
};

// How the mouse holds the tool, for the line below the pictures.
struct RackGrip {
  int lean_deg = 0, roll_deg = 0;
};

struct RackPressed {
  std::optional<std::size_t> tile;
  int lean = 0, roll = 0;  // one step less or more
  bool close = false;
};

// grip: nothing for the round burr, and for hands that hold a tool by themselves.
[[nodiscard]] RackPressed draw_rack(Ui& ui, const std::vector<RackTile>& tiles,
                                    const std::optional<RackGrip>& grip);

}  // namespace burr::app
