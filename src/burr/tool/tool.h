// tool/tool.h - a tool as a list of parts: those that cut, those that only rub, those that are only
// seen.
//
// Plain structs of fixed size, which the tick may copy. Frame: of the tool: the place where it works
// (a burr: the centre of the head) is the origin, the handle lies along +z. Units: m.
#pragma once

#include <array>

#include "burr/math/pose.h"
#include "burr/rt/rt.h"
#include "burr/tool/burr_tool.h"
#include "burr/tool/shape.h"

namespace burr::tool {

enum class Role {
  cuts,  // touches the bone, and may remove it
  rubs,  // touches the bone, and never removes it: shaft, body of a blade
  seen,  // does not touch
};

struct Part {
  Shape shape;  // [m]
  math::Pose tool_from_part;
  Role role = Role::cuts;
};

struct Tool {
  static constexpr int kMostParts = 6;
  std::array<Part, kMostParts> parts;
  int count = 0;
};

// Adds a part. False: there is no room, or the sizes describe no body.
[[nodiscard]] bool add_part(Tool& tool, const Part& part) BURR_RT;

// The farthest that a touching part reaches from the origin [m].
[[nodiscard]] double reach_of(const Tool& tool) BURR_RT;

// A round burr as it is drawn (docs/understand/touch_tools.md, "Six unknowns"): the head cuts; a
// neck thinner than the head, a cone and the shaft up to the handpiece rub.
inline constexpr double kShaftEnd = 26e-3;  // from the centre of the head to the handpiece [m]
[[nodiscard]] Tool burr_with_shaft(const Burr& burr) BURR_RT;

}  // namespace burr::tool
