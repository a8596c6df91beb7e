// render/held_tool.h - the axis along which a tool without an orientation of its own is drawn: as a
// hand would hold it.
//
// A mouse gives a point and no direction. The tool drawn there
//
//     leans out of the line of sight to its tip, never less than kLeast where there is room
//     comes from the side of the user's hand, and prefers a lean at which bone does not cross it
//     turns about the tip smoothly, at most at kFastest, however the tip jumps
//
// It is for pictures only: the servo and the recording do not know it. Thread: one. Frame: world.
// Units: m, rad, s.
#pragma once

#include <numbers>

#include "burr/render/scene.h"

namespace burr::render {

class HeldTool {
 public:
  static constexpr double kLeast = 25 * std::numbers::pi / 180;     // from the line of sight [rad]
  static constexpr double kFastest = 120 * std::numbers::pi / 180;  // [rad/s]

  // The pose to draw, with +z along the shaft, after `seconds` since the last call (0 or more). The
  // first call is there at once. tip: centre of the burr's head. Cost: a pick along the shaft, and a
  // few more in a picture in which bone crosses it.
  [[nodiscard]] math::Pose at(const Scene& scene, const math::Vec3& tip, bool left_handed,
                              double seconds);

 private:
  [[nodiscard]] math::Vec3 wanted(const Scene& scene, const math::Vec3& tip, bool left_handed,
                                  double seconds);

  math::Quat q_ = math::Quat::Identity();
  bool held_ = false;
  std::size_t lean_ = 0;  // that was free at the last call
  double calm_ = 0;       // since when the first one would be free, too [s]
};

}  // namespace burr::render
