// device/axes.h - which way a device's own x, y and z point as its user sits before the screen, in
// words: "right up near" is a hand's frame, "far left up" a robot's that looks forward.
//
// Thread: any.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "burr/math/pose.h"

namespace burr::device {

// hand_from_device, the hand's frame being x right, y up, z to the user (near). nullopt: not three
// words of right, left, up, down, near, far, or no right-handed frame.
[[nodiscard]] std::optional<math::Quat> axes_from_words(std::string_view words);

// The words nearest to a turn.
[[nodiscard]] std::string words_of_axes(const math::Quat& hand_from_device);

}  // namespace burr::device
