// apps/burr/window/shell/help.h - keys and mouse on one page.
#pragma once

#include <string>
#include <vector>

#include "window/shell/ui.h"
#include "window/shell/words.h"

namespace burr::app {

enum class HelpBlock { hand, view, tools, program };

struct HelpRow {
  HelpBlock block;
  std::string keys;  // "U  Y"
  Word does;
};

// false: the user closed the page. rows: keys and mouse, in the order they are shown. pads: the leaf
// about gamepad, pedal and SpaceMouse is shown; a button turns over.
[[nodiscard]] bool draw_help(Ui& ui, const std::vector<HelpRow>& rows, bool& pads);
// The same for the page that shows a recording.
[[nodiscard]] bool draw_replay_help(Ui& ui);

}  // namespace burr::app
