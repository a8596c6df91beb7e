// device/hand_path.h - a way for a scripted hand to go: poses over time, straight in between.
//
// Frame: world (LPS). Units: SI.
#pragma once

#include <vector>

#include "burr/math/pose.h"

namespace burr::device {

struct PathPoint {
  double t = 0;  // since the start, never falling          [s]
  math::Pose world_from_tool;
  double pedal = 1;  // 0..1
};

struct HandPath {
  std::vector<PathPoint> points;  // at least one

  [[nodiscard]] double duration() const { return points.empty() ? 0 : points.back().t; }
};

// Where the path is at time t; `hint` remembers the segment so that going forward is cheap.
// Allocation-free.
[[nodiscard]] PathPoint at(const HandPath& path, double t, std::size_t& hint) noexcept;

}  // namespace burr::device
