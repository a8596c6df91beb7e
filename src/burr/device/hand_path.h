// device/hand_path.h - the path of a scripted hand: poses over time, interpolated linearly.
//
// Frame: world (LPS). Units: SI.
// Thread: any; one hint per user of a path.
#pragma once

#include <vector>

#include "burr/math/pose.h"

namespace burr::device {

struct PathPoint {
  double t = 0;  // since the start, never decreasing [s]
  math::Pose world_from_tool;
  double pedal = 1;  // 0..1
};

struct HandPath {
  std::vector<PathPoint> points;  // at least one

  [[nodiscard]] double duration() const { return points.empty() ? 0 : points.back().t; }
};

// The point of the path at time t [s]. `hint` remembers the segment, so that going forward in time
// is cheap. No allocation.
[[nodiscard]] PathPoint at(const HandPath& path, double t, std::size_t& hint) noexcept;

}  // namespace burr::device
