// apps/burr/window/mill/mill_keys.h - the keys of the page for milling: one table for the keyboard, the
// menus and the help page.
//
// The table is in mill_keys.cpp. Thread: main; draw_key_menu() between Ui::begin() and Ui::draw().
#pragma once

#include <SDL2/SDL.h>

#include <optional>
#include <string>
#include <vector>

#include "window/parts/toolbar.h"
#include "window/ui/help.h"
#include "window/ui/ui.h"

namespace burr::app {

class MillActions;

// Does what this key does; false: nothing. left_handed: the mouse buttons are exchanged.
bool press_key(MillActions& actions, const SDL_Keysym& pressed, bool left_handed);
// What has a key but no button, as a list; views: how to look, otherwise everything else. Does what is
// clicked. True: it was closed.
[[nodiscard]] bool draw_key_menu(Ui& ui, MillActions& actions, bool views, bool left_handed);

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
