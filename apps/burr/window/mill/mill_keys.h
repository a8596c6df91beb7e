// apps/burr/window/mill/mill_keys.h - the keys of the page for milling, for its help page.
//
// The table is in mill_keys.cpp; the keyboard uses the same table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "window/parts/toolbar.h"
#include "window/ui/help.h"

namespace burr::app {

// How the mouse does what a key does: exactly one of these, for each key.
struct KeyReach {
  std::string key;               // "Shift+F5"
  std::optional<Action> button;  // of the bar
  std::string item;              // of the menu; "": none
  std::string other;             // a gesture, or a button on another panel; "": none
};
[[nodiscard]] std::vector<KeyReach> key_reaches();

// left_handed: the mouse buttons are exchanged.
[[nodiscard]] std::vector<HelpRow> mill_help_rows(bool left_handed);

}  // namespace burr::app
