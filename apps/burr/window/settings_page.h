// apps/burr/window/settings_page.h - the settings, changed while one looks.
#pragma once

#include "window/settings.h"
#include "window/ui.h"

namespace burr::app {

struct SettingsPage {
  bool changed = false;  // something; now in `settings`
  bool done = false;     // the user is
};

// file: where they are kept, told below; "" if they are not. pads: the leaf of gamepad, pedal and
// SpaceMouse is shown; a button turns over.
[[nodiscard]] SettingsPage draw_settings(Ui& ui, Settings& settings, const std::string& file,
                                         bool& pads);

}  // namespace burr::app
