// apps/burr/window/mill/mill_keys.h - the keys of the page for milling, as its help page shows them.
//
// The table is in mill_keys.cpp; the keyboard obeys the same one.
#pragma once

#include <vector>

#include "window/shell/help.h"

namespace burr::app {

// left_handed: the mouse's buttons are the other way round.
[[nodiscard]] std::vector<HelpRow> mill_help_rows(bool left_handed);

}  // namespace burr::app
