#include "burr/tool/tool.h"

#include <algorithm>

#include "burr/math/sums.h"

namespace burr::tool {
namespace {

using math::Vec3;

constexpr double kNeck = 0.55;  // of the head's radius: the thickest neck           [-]
constexpr double kNeckBegins = 0.8, kNeckEnds = 3.8;  // of the head's radius            [-]
constexpr double kWidens = 4;  // length of the cone over its gain in radius        [-]

Part along_z(const Shape& shape, double middle) BURR_RT {
  return {shape, {Vec3(0, 0, middle), math::Quat::Identity()}, Role::rubs};
}

}  // namespace

bool add_part(Tool& tool, const Part& part) BURR_RT {
  if (tool.count >= Tool::kMostParts || !is_body(part.shape) || !part.tool_from_part.finite())
    return false;
  tool.parts[static_cast<std::size_t>(tool.count++)] = part;
  return true;
}

double reach_of(const Tool& tool) BURR_RT {
  double reach = 0;
  for (int n = 0; n < tool.count; ++n) {
    const Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role == Role::seen) continue;
    const BoundingBall ball = bounding_ball(part.shape);
    reach = std::max(reach, math::norm(part.tool_from_part * ball.centre) + ball.radius);
  }
  return reach;
}

Tool burr_with_shaft(const Burr& burr) BURR_RT {
  Tool tool;
  const double r = burr.radius, shaft = burr.shaft_radius, neck = std::min(shaft, kNeck * r);
  static_cast<void>(add_part(tool, {{ShapeKind::ball, 0, 0, 0, r}, {}, Role::cuts}));
  const double z0 = kNeckBegins * r, z1 = kNeckEnds * r, z2 = z1 + kWidens * (shaft - neck);
  const double end = std::max(kShaftEnd, z2 + r);
  static_cast<void>(
      add_part(tool, along_z({ShapeKind::capsule, 0, 0, 0.5 * (z1 - z0), neck}, 0.5 * (z0 + z1))));
  // the cone's rounding takes half of the neck, so that its rim is no sharp edge
  const double rounding = 0.5 * neck;
  if (z2 > z1)
    static_cast<void>(add_part(tool, along_z({ShapeKind::frustum, neck - rounding, shaft - rounding,
                                              0.5 * (z2 - z1), rounding},
                                             0.5 * (z1 + z2))));
  static_cast<void>(add_part(
      tool, along_z({ShapeKind::capsule, 0, 0, 0.5 * (end - z2), shaft}, 0.5 * (z2 + end))));
  return tool;
}

}  // namespace burr::tool
