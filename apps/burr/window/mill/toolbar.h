// apps/burr/window/mill/toolbar.h - what one may do, as buttons at the left edge, and as keys.
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

// The button pressed now, if one is.
[[nodiscard]] std::optional<Action> draw_toolbar(Ui& ui, tick::ToolMode mode, bool measures,
                                                 bool mirrors);

}  // namespace burr::app
