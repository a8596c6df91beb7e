// tests/haptics/tools.h - tools and turns that several tests of six unknowns need.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "burr/math/pose.h"
#include "burr/tool/tool.h"

namespace burr::test {

// A tool of one part, which cuts.
inline tool::Tool one_part(const tool::Shape& shape, const math::Pose& pose = {}) {
  tool::Tool tool;
  EXPECT_TRUE(tool::add_part(tool, {shape, pose, tool::Role::cuts}));
  return tool;
}

inline math::Quat turn_about(const math::Vec3& axis, double angle) {
  math::Quat q;
  q.w() = std::cos(angle / 2);
  q.vec() = std::sin(angle / 2) * axis.normalized();
  return q;
}

}  // namespace burr::test
