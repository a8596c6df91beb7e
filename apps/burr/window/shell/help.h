// apps/burr/window/shell/help.h - keys and mouse on one page.
#pragma once

#include "window/shell/ui.h"

namespace burr::app {

// false: the user has read enough. left_handed: the mouse's buttons are the other way round. pads:
// the leaf about gamepad, pedal and SpaceMouse is shown; a button turns over.
[[nodiscard]] bool draw_help(Ui& ui, bool left_handed, bool& pads);
// The same for the page that shows a recording.
[[nodiscard]] bool draw_replay_help(Ui& ui);

}  // namespace burr::app
