// apps/burr/window/ui/settings_page.h - the page on which the user changes settings; a change is
// visible at once.
#pragma once

#include "burr/workshop/device_book.h"
#include "shared/user_settings.h"
#include "window/ui/ui.h"

namespace burr::app {

struct SettingsPage {
  bool changed = false;  // a setting changed; it is already in `settings`
  bool done = false;     // the user closed the page
};

// The haptic device in use, and its preferences.
struct DeviceLeaf {
  const std::string& id;
  double peak;  // largest force that it can give [N]
  bool turns;   // it can give torque
  workshop::DevicePreferences& preferences;
  bool changed = false;
};

// file: the settings file, named at the bottom; "" if nothing is saved. pads: true: the second page
// is shown, for gamepad, pedal, SpaceMouse and haptic device; a button switches it.
[[nodiscard]] SettingsPage draw_settings(Ui& ui, Settings& settings, const std::string& file,
                                         bool& pads, DeviceLeaf* device = nullptr);

}  // namespace burr::app
