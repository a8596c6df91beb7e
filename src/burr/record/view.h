// record/view.h - what the surgeon saw at a moment: a message of the channel /view.
//
// Written when it changed, at most ten times a second of the session (record/diary.h). Frame: world
// (LPS). Units: m, rad. Thread: any.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"
#include "burr/math/vec3.h"

namespace burr::record {

struct View {
  std::uint64_t tick = 0;  // of the session; the view holds until the next one

  math::Vec3 eye = math::Vec3::Zero();     // of two eyes the middle [m]
  math::Vec3 right = math::Vec3::UnitX();  // unit: to the right, up in the picture, and from the
  math::Vec3 up = math::Vec3::UnitY();     // picture towards the eye
  math::Vec3 back = math::Vec3::UnitZ();
  double field_of_view = 0.5;  // vertical angle of the picture [rad]
  double magnification = 1;    // magnification_of()

  double see_through = 0;  // 0: the bone hides what lies behind it; 1: it is not seen at all
  bool colours = true;     // tissues have their own colours; false: all look like bone
  bool slices = true;      // slices through the tip are shown
  bool panels = true;      // panels and figures are shown
  bool two_eyes = false;   // stereo, on a screen or in a headset

  bool operator==(const View& other) const;
};

// How much larger than life a picture is on a screen of 0.3 m height. view_height: of the picture,
// at the depth of what the camera looks at [m].
[[nodiscard]] double magnification_of(double view_height);
[[nodiscard]] double view_height_of(double magnification);  // the other way [m]

// Equal but for the tick.
[[nodiscard]] bool same_sight(const View& a, const View& b);

// Refuses numbers that are not finite and axes that are no unit vectors.
[[nodiscard]] Status check(const View& view);

// One JSON object; every number is read back to the bit.
[[nodiscard]] std::string to_json(const View& view);
// False: not a view.
[[nodiscard]] bool view_from_json(std::string_view text, View& view);
[[nodiscard]] std::string view_schema();

}  // namespace burr::record
