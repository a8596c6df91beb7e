// apps/burr/window/mill/toolbar.h - the buttons at the left edge, and the keys for the same
// actions.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <vector>

#include "burr/tick/servo.h"
#include "window/shell/ui.h"

namespace burr::app {

enum class Action {
  cut,
  add,
  touch,
  back,
  smooth,
  undo,
  redo,
  reset,
  measure,
  mirror,
  export_,
  smaller,
  larger,
  slower,
  faster,
  settings,
  help,
  leave,
  kind,     // cutting burr, diamond burr
  coolant,  // on, off
  slices,
  see_through,
  keep,
  suction,     // on, off
  views,       // the menu of views, open or not
  structures,  // the list of structures
  task,        // the text of the case, its steps
  picture,
  sound,  // on, off
  rack,   // the tools, open or not
  menu,   // everything that has no button of its own
};

// What is on: its button has a frame.
struct ToolbarState {
  tick::ToolMode mode = tick::ToolMode::cut;
  bool measures = false, mirrors = false, diamond = false, coolant = false, slices = false,
       see_through = false, suction = false, views = false, structures = false, task = false,
       sound = false, menu = false, rack = false;
};

// All actions that have a button.
[[nodiscard]] std::vector<Action> toolbar_actions();

// What an operation needs stands above what changes bone in other ways. Returns the button that was
// pressed, if any.
[[nodiscard]] std::optional<Action> draw_toolbar(Ui& ui, const ToolbarState& state);

}  // namespace burr::app
