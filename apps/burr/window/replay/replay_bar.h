// apps/burr/window/replay/replay_bar.h - the buttons at the left edge of the page that plays a
// recording: all that its keys do and that neither the strip below nor the mouse on the picture does.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <vector>

#include "window/parts/toolbar.h"
#include "window/ui/ui.h"

namespace burr::app {

// What is on: its button has a frame.
struct ReplayBarState {
  bool beside = false, compares = false, slices = false, see_through = false, labels = false;
};

// All actions that have a button in this bar.
[[nodiscard]] std::vector<Action> replay_bar_actions();

// free: height of the picture above the strip [pixel]. As draw_bar() of toolbar.h.
[[nodiscard]] std::optional<Action> draw_replay_bar(Ui& ui, const ReplayBarState& state, float free,
                                                    std::vector<BarPlace>& places);

}  // namespace burr::app
