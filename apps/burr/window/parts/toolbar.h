// apps/burr/window/parts/toolbar.h - the buttons at the left edge, and the keys for the same
// actions; and such a bar with other buttons, for the page that plays a recording.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "burr/tick/servo.h"
#include "shared/word_names.h"
#include "window/parts/action.h"
#include "window/ui/ui.h"

namespace burr::app {
// What is on: its button has a frame.
struct ToolbarState {
  tick::ToolMode mode = tick::ToolMode::cut;
  bool measures = false, mirrors = false, diamond = false, coolant = false, slices = false,
       see_through = false, suction = false, views = false, structures = false, task = false,
       sound = false, menu = false, rack = false;
};

struct BarButton {
  Action action;
  Word name;        // a tall button: below its icon; a small one: in its tip
  const char* key;  // in the tip
};

// One line of a bar: a tall button, or two small ones; with a heading above them.
struct BarLine {
  std::optional<Word> heading;
  BarButton left;
  std::optional<BarButton> right;
  float gap = 0;  // below it [points]
};

// Where a button lies in the picture [pixel].
struct BarPlace {
  Action action;
  float x = 0, y = 0, w = 0, h = 0;
};

// Draws a bar at the left edge, `high` points high, in the middle of the `free` pixels above what lies
// at the bottom. is_on: its button has a frame. places: gets where the buttons lie; nullptr: nobody
// asks. Returns the button that was pressed, if any.
[[nodiscard]] std::optional<Action> draw_bar(Ui& ui, const std::vector<BarLine>& lines, float high,
                                             float free, const std::function<bool(Action)>& is_on,
                                             std::vector<BarPlace>* places = nullptr);

// All actions that have a button.
[[nodiscard]] std::vector<Action> toolbar_actions();

// What an operation needs stands above what changes bone in other ways. Returns the button that was
// pressed, if any.
[[nodiscard]] std::optional<Action> draw_toolbar(Ui& ui, const ToolbarState& state);

}  // namespace burr::app
