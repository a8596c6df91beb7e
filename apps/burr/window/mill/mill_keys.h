// apps/burr/window/mill/mill_keys.h - the keys of the page for milling, for its help page.
//
// The table is in mill_keys.cpp; the keyboard uses the same table.
#pragma once

#include <vector>

#include "window/shell/help.h"

namespace burr::app {

// left_handed: the mouse buttons are exchanged.
[[nodiscard]] std::vector<HelpRow> mill_help_rows(bool left_handed);

}  // namespace burr::app
