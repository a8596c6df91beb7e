// apps/burr/window/mill/titled_panel.h - a panel beside the buttons at the left, with a title and a
// cross that closes it.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <string>

#include "window/ui/ui.h"

namespace burr::app {

// Begins the panel at the place of the side panel, so high [pixel]; end it with ImGui::End(). True:
// the cross was pressed.
[[nodiscard]] bool begin_titled(Ui& ui, const char* name, float high, const std::string& title);

}  // namespace burr::app
