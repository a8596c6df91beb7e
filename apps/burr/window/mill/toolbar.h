// apps/burr/window/mill/toolbar.h - the buttons at the left edge, and the keys for the same
// actions.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>

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
};

// Returns the button that was pressed, if any.
[[nodiscard]] std::optional<Action> draw_toolbar(Ui& ui, tick::ToolMode mode, bool measures,
                                                 bool mirrors);

}  // namespace burr::app
