// apps/burr/window/parts/icons.h - the icons of the buttons. They are drawn, so that no font with icons is needed.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <imgui/imgui.h>

#include "window/parts/action.h"

namespace burr::app {

// c: its middle, r: half its size [pixel]. Nothing for an action without an icon.
void icon(ImDrawList& draw, Action action, ImVec2 c, float r, ImU32 shade);

}  // namespace burr::app
