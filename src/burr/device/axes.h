// device/axes.h - the directions of a device's own x, y and z axes, in three words, as its user
// sees them in front of the screen. "right up near" is the hand's frame; "far left up" is the frame
// of a robot that looks forward.
//
// Thread: any.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "burr/math/pose.h"

namespace burr::device {

// Returns hand_from_device. The hand's frame is x right, y up, z towards the user (near). nullopt
// unless the text is three of the words right, left, up, down, near, far, and they make a
// right-handed frame.
[[nodiscard]] std::optional<math::Quat> axes_from_words(std::string_view words);

// The three words nearest to a rotation.
[[nodiscard]] std::string words_of_axes(const math::Quat& hand_from_device);

}  // namespace burr::device
