// apps/burr/window/mill/cross_button.h - the cross that closes a panel.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include "window/ui/ui.h"

namespace burr::app {

// The cross, in a square of 28 points with this corner [pixel]. True: it was pressed.
[[nodiscard]] bool draw_cross(const Ui& ui, float x, float y);

}  // namespace burr::app
