// apps/burr/window/ui/help.h - the page that shows keys and mouse.
#pragma once

#include <string>
#include <vector>

#include "shared/word_names.h"
#include "window/ui/ui.h"

namespace burr::app {

enum class HelpBlock { hand, view, tools, program };

struct HelpRow {
  HelpBlock block;
  std::string keys;  // "U  Y"
  Word does;
};

// Draws the page; false: the user closed it. rows: keys and mouse, in the order they are shown.
// pads: true: the second page, about gamepad, pedal and SpaceMouse, is shown; a button switches it.
[[nodiscard]] bool draw_help(Ui& ui, const std::vector<HelpRow>& rows, bool& pads);
// The same for the page that plays a recording.
[[nodiscard]] bool draw_replay_help(Ui& ui);

}  // namespace burr::app
