// workshop/device_book.h - what a user preferences of each haptic device, kept by its serial number in
// one readable TOML file.
//
//     ["Touch T-0001"]
//     scale = 0.5
//     max_force_n = 2
//
// A value that cannot be is left at its default, with one sentence that names file, device and
// field; a file with such trouble is kept beside as devices.toml.old when it is written anew.
// Units: as in the file. Thread: any.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/device/hand.h"
#include "burr/device/mapping.h"

namespace burr::workshop {

struct DevicePreferences {
  device::MappingSettings mapping;
  double max_force_n = 0;  // the user's own, beside the device's; 0: the device's
  double vibration = 0;    // gain of the spindle's buzz
  double torque = 1;       // gain of its motor's twist, where the device can turn the hand
};

class DeviceBook {
 public:
  // No file: an empty book, and no trouble.
  [[nodiscard]] static DeviceBook read(const std::filesystem::path& path);
  [[nodiscard]] static DeviceBook parse(std::string_view text, std::string_view file);
  [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }

  [[nodiscard]] DevicePreferences of(const std::string& id) const;
  // "scale=0.5"; error: no such field, or no such value.
  [[nodiscard]] Status set(const std::string& id, std::string_view assignment);

  // All at once, as a page of settings has them; each within its range.
  void put(const std::string& id, const DevicePreferences& preferences) {
    preferences_[id] = preferences;
  }

  [[nodiscard]] std::string text() const;
  // Makes the folder.
  [[nodiscard]] Status write(const std::filesystem::path& path) const;

 private:
  std::map<std::string, DevicePreferences> preferences_;
  std::vector<std::string> troubles_;
};

// What a number of it may be.
struct PreferenceRange {
  double least, most;
};
[[nodiscard]] PreferenceRange range_of_preference(std::string_view key);

// How a device is called in the book: its name and its serial number.
[[nodiscard]] std::string id_of(const device::DeviceSpec& spec);

// devices.toml in the user's folder.
[[nodiscard]] std::filesystem::path users_book();

}  // namespace burr::workshop
