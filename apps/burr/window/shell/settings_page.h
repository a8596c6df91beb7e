// apps/burr/window/shell/settings_page.h - the settings, changed while one looks.
#pragma once

#include "burr/workshop/device_book.h"
#include "window/shell/settings.h"
#include "window/shell/ui.h"

namespace burr::app {

struct SettingsPage {
  bool changed = false;  // something; now in `settings`
  bool done = false;     // the user is
};

// The haptic device that is led just now, and what its book says of it.
struct DeviceLeaf {
  const std::string& id;
  double peak;  // that it can push [N]
  bool turns;   // it has torque
  workshop::DevicePreferences& preferences;
  bool changed = false;
};

// file: where they are kept, told below; "" if they are not. pads: the leaf of gamepad, pedal and
// SpaceMouse, and of a haptic device, is shown; a button turns over.
[[nodiscard]] SettingsPage draw_settings(Ui& ui, Settings& settings, const std::string& file,
                                         bool& pads, DeviceLeaf* device = nullptr);

}  // namespace burr::app
