// workshop/device_book.h - the user's preferences for each haptic device, in one TOML file; a
// device is known by its serial number.
//
//     ["Touch T-0001"]
//     scale = 0.5
//     max_force_n = 2
//
// A value out of range is left at its default, with one sentence that names file, device and field.
// A file with such a value is kept as devices.toml.old when the book is written again.
// Units: as in the file. Thread: any.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/device/mapping.h"

namespace burr::workshop {

struct DevicePreferences {
  device::MappingSettings mapping;
  double max_force_n = 0;      // the user's own limit; 0: the limit of the device  [N]
  double vibration = 0;        // gain of the spindle's vibration
  double torque = 1;           // gain of the spindle's torque, for devices that can turn the hand
  double takes_torque_nm = 0;  // for arms that cannot say themselves whether they take any  [N m]
};

class DeviceBook {
 public:
  // A file that does not exist gives an empty book and no error.
  [[nodiscard]] static DeviceBook read(const std::filesystem::path& path);
  [[nodiscard]] static DeviceBook parse(std::string_view text, std::string_view file);
  [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }

  [[nodiscard]] DevicePreferences of(const std::string& id) const;
  // assignment: "scale=0.5". Error: an unknown field, or a value out of range.
  [[nodiscard]] Status set(const std::string& id, std::string_view assignment);

  // Replaces all fields of one device. Each value must be within its range.
  void put(const std::string& id, const DevicePreferences& preferences) {
    preferences_[id] = preferences;
  }

  [[nodiscard]] std::string text() const;
  // Creates the folder if it is missing.
  [[nodiscard]] Status write(const std::filesystem::path& path) const;

 private:
  std::map<std::string, DevicePreferences> preferences_;
  std::vector<std::string> troubles_;
};

// The range of a numeric field.
struct PreferenceRange {
  double least, most;
};
[[nodiscard]] PreferenceRange range_of_preference(std::string_view key);

// The key of a device in the book: its name and its serial number.
[[nodiscard]] std::string id_of(const device::DeviceSpec& spec);

// devices.toml in the user's folder.
[[nodiscard]] std::filesystem::path users_book();

}  // namespace burr::workshop
