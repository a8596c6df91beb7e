#include "burr/mouse/grip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace burr::mouse {

using math::Vec3;

namespace {

template <typename Do>
void each_cutting(const tool::Tool& tool, const Do& act) {
  for (int n = 0; n < tool.count; ++n) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role == tool::Role::cuts) act(part);
  }
}

}  // namespace

void Grip::take(const scenario::RackTool* tool) {
  if (tool == tool_) return;
  tool_ = tool;
  roll_ = 0;
  lean_ = tool != nullptr ? tool->lean : scenario::kUsualLean;
  reach_ = 0;
  if (tool == nullptr) return;
  each_cutting(tool->tool, [this](const tool::Part& part) {
    const tool::BoundingBall ball = tool::bounding_ball(part.shape);
    reach_ = std::max(reach_, (part.tool_from_part * ball.centre).norm() + ball.radius);
  });
}

void Grip::roll(double by) { roll_ = std::remainder(roll_ + by, 2 * std::numbers::pi); }

void Grip::lean(double by) { lean_ = std::clamp(lean_ + by, 0.0, 0.5 * std::numbers::pi); }

math::Quat Grip::turn(const Vec3& out, const render::Camera& camera, bool left_handed) const {
  // the direction to the user's hand, along the surface
  const Vec3 hand = (left_handed ? -1.0 : 1.0) * camera.right() + 0.3 * camera.above();
  Vec3 side = hand - hand.dot(out) * out;
  if (side.norm() < 0.1) side = camera.above() - camera.above().dot(out) * out;
  side.normalize();
  const double c = std::cos(lean_), s = std::sin(lean_);
  math::Mat3 axes;
  axes.col(2) = c * out + s * side;
  axes.col(0) = s * out - c * side;
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return (math::Quat(axes) * math::Quat(Eigen::AngleAxisd(roll_, Vec3::UnitZ()))).normalized();
}

double Grip::reach_along(const math::Quat& world_from_tool, const Vec3& direction) const {
  if (tool_ == nullptr) return 0;
  const Vec3 way = world_from_tool.conjugate() * direction;
  double most = -std::numeric_limits<double>::infinity();
  each_cutting(tool_->tool, [&](const tool::Part& part) {
    const Vec3 in_part = part.tool_from_part.q.conjugate() * way;
    most = std::max(most, part.tool_from_part.p.dot(way) + tool::support(part.shape, in_part));
  });
  return most;
}

}  // namespace burr::mouse
