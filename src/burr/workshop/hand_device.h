// workshop/hand_device.h - the haptic device a user named, ready to be opened.
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
  // where given by hand, in place of what the book says (device_book.h)
  std::optional<double> scale;
  bool dead_man = false;
  bool home = false;      // an arm may move by itself to find its home
  bool is_homed = false;  // said where the library cannot tell
};

// One kind of device burr can drive.
struct HandKind {
  const char* name;   // as the user writes it
  const char* makes;  // maker and models
  const char* page;   // of docs/devices/
};
[[nodiscard]] const std::vector<HandKind>& hand_kinds();
// "touch", "touch:Left": of a kind that burr drives.
[[nodiscard]] bool is_hand_kind(std::string_view device);

// Those of a kind that are there, as a user names them: "haply:049D". Nothing moves and nothing is
// pushed. The kind's own name where none is there, or none can be told apart.
struct NamesThere {
  std::vector<std::string> names;
  std::string note;  // what else is to be said of the names, a sentence; or empty
};
[[nodiscard]] NamesThere names_there(const HandKind& kind);

// Error: no kind of that name; says which there are. The device itself is looked for by open().
[[nodiscard]] Result<std::unique_ptr<device::Device>> make_hand(const HandRequest& request);

// The same, open and laid over a bone as its user preferences: the tip begins at `start`, the axes are
// those of the view.
struct LaidHand {
  std::unique_ptr<device::MappedHand> hand;
  double max_force = 0;              // the user's own and the device's [N]
  double vibration = 0, torque = 1;  // gains
  std::string id;                    // in the book
  DevicePreferences preferences;     // as the book has them
  std::vector<std::string> notices;  // of the book
};
[[nodiscard]] Result<LaidHand> lay_hand(const HandRequest& request, const math::Pose& start,
                                        const math::Quat& world_from_view);

// The rate of ticks that suits a device: its own, or a whole part of it near a thousand [Hz].
[[nodiscard]] double tick_rate(const device::DeviceSpec& spec);

// "touch, force-dimension, ..."
[[nodiscard]] std::string kinds_known();

}  // namespace burr::workshop
