// workshop/hand_device.h - a name given by the user becomes a haptic device, ready to be opened.
//
//     --device touch               the default Touch
//     --device "touch:Left one"    by its name
//     --device force-dimension     the first
//     --device force-dimension:17  by its serial number
//     --device haply               the first arm, the first grip
//     --device haply:049D+GRIP     an arm and the grip that is held with it, each by its id
//     --device crtk                the only arm on the bus
//     --device crtk:/MTMR          by its name
//
// Thread: main.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/device/device.h"
#include "burr/device/mapping.h"
#include "burr/workshop/device_book.h"

namespace burr::workshop {

struct HandRequest {
  std::string device;  // empty: the mouse, or a simulated hand
  // if set, replaces the value in the book (device_book.h)
  std::optional<double> scale;
  bool dead_man = false;
  bool home = false;      // the arm may move by itself to find its home position
  bool is_homed = false;  // the user has homed the arm, and its library cannot report it
};

// One kind of device that burr can drive.
struct HandKind {
  const char* name;   // as the user types it
  const char* makes;  // maker and models
  const char* page;   // of docs/use/devices/
};
[[nodiscard]] const std::vector<HandKind>& hand_kinds();
// True for "touch" and "touch:Left": the part before the colon is a known kind.
[[nodiscard]] bool is_hand_kind(std::string_view device);

// The connected devices of one kind, as the user names them: "haply:049D". No device moves or
// applies a force. If none is connected, or the library cannot list them, the only name is that of
// the kind.
struct NamesThere {
  std::vector<std::string> names;
  std::string note;  // one more sentence about the names, or empty
};
[[nodiscard]] NamesThere names_there(const HandKind& kind);

// Error: an unknown kind; the sentence lists the known ones. open() then looks for the device
// itself.
[[nodiscard]] Result<std::unique_ptr<device::Device>> make_hand(const HandRequest& request);

// Also opens the device and maps it with the user's preferences: the tip starts at `start`, and the
// device's axes are those of the view.
struct OpenedHand {
  std::unique_ptr<device::MappedHand> hand;
  double max_force = 0;              // the smaller of the user's and the device's limit  [N]
  double vibration = 0, torque = 1;  // gains
  std::string id;                    // key in the book
  DevicePreferences preferences;     // from the book
  std::vector<std::string> notices;  // about the book
};
[[nodiscard]] Result<OpenedHand> open_hand(const HandRequest& request, const math::Pose& start,
                                           const math::Quat& world_from_view);

// The tick rate for a device: its own rate, or its own rate divided by a whole number so that the
// result is near 1000 Hz.  [Hz]
[[nodiscard]] double tick_rate(const device::DeviceSpec& spec);

// The names of all kinds: "touch, force-dimension, ..."
[[nodiscard]] std::string kinds_known();

}  // namespace burr::workshop
