#include "burr/sim/path_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "burr/haptics/proxy.h"
#include "burr/haptics/six/shaft_touch.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/tick/second_hand.h"
#include "burr/tool/tool.h"

namespace burr::sim {
namespace {

using math::Vec3;

constexpr double kFarAway = 1;  // a hand that never comes nearer is in other units  [m]

// What a hand of the session holds.
struct Held {
  const tool::Tool* tool = nullptr;  // none: a ball
  double radius = 0;                 // of the ball [m]

  // The farthest that it can touch from the hand [m]
  [[nodiscard]] double reach() const { return tool != nullptr ? tool::reach_of(*tool) : radius; }
};

Held held(Session& session, bool second) {
  if (second) {
    const tick::SecondHandSettings& settings = session.second_hand()->settings();
    return {settings.tool ? &settings.tool->tool : nullptr, settings.radius};
  }
  const tick::ServoSettings& servo = session.settings().servo;
  return {servo.tool >= 0 ? &servo.tools[static_cast<std::size_t>(servo.tool)].tool : nullptr,
          servo.burr.radius};
}

bool is_free(const volume::IsoVertices& surface, const Held& held, const math::Pose& hand) {
  const Vec3 nowhere = surface.bone().grid().world_from_grid(Vec3::Constant(-1e4));
  haptics::ProxySettings settings;
  settings.radius = held.radius;
  if (held.tool == nullptr) return haptics::Proxy(surface, settings, nowhere).is_free(hand.p);
  return haptics::ToolTouch(surface, *held.tool, settings, haptics::ShaftTouch::kLever,
                            {nowhere, math::Quat::Identity()})
      .is_free(hand);
}

// Around the bricks that hold bone; in voxels.
struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
};
Box box_of(const volume::Bone& bone) {
  Box box;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    if (bone.brick_field(brick) == nullptr) continue;
    const Vec3 first = bone.brick_ijk(brick).cast<double>();
    // the surface lies up to a voxel before the first voxel of bone
    box.low = box.low.cwiseMin(first - Vec3::Ones());
    box.high = box.high.cwiseMax(first + Vec3::Constant(volume::kBrickEdge));
  }
  return box;
}

double beyond(const Box& box, const Vec3& p) {
  return (p - box.high).cwiseMax(box.low - p).cwiseMax(Vec3::Zero()).norm();
}

// Along the way from a to b, where it has one minimum.
double nearest_between(const Box& box, const Vec3& a, const Vec3& b) {
  constexpr int kHalvings = 50;
  double low = 0, high = 1;
  for (int n = 0; n < kHalvings; ++n) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    if (beyond(box, a + left * (b - a)) < beyond(box, a + right * (b - a)))
      high = right;
    else
      low = left;
  }
  return beyond(box, a + 0.5 * (low + high) * (b - a));
}

// No less than the hand's distance to the bone, between the points too  [m]
double nearest(const device::HandPath& path, const volume::Bone& bone) {
  const Box box = box_of(bone);
  const volume::Grid& grid = bone.grid();
  double least = std::numeric_limits<double>::infinity();
  Vec3 before = grid.grid_from_world(path.points.front().world_from_tool.p);
  for (const device::PathPoint& point : path.points) {
    const Vec3 p = grid.grid_from_world(point.world_from_tool.p);
    least = std::min(least, nearest_between(box, before, p));
    before = p;
  }
  return least * grid.voxel;
}

// For all that is known: a second hand tells what it cut, not what it felt.
bool touched(Session& session, const Held& held, bool second, double away) {
  if (second) return session.second_hand()->row().ledger.asked > 0 || away <= held.reach();
  const Outcome outcome = session.outcome();
  return outcome.mean_force > 0 || outcome.ledger.asked > 0 || outcome.ledger.removed > 0;
}

}  // namespace

std::vector<std::string> doubts_before(Session& session, const FollowedPath& followed) {
  if (followed.path.points.empty()) return {};
  const Held what = held(session, followed.second);
  const double away = nearest(followed.path, session.bone());
  if (away > std::max(kFarAway, what.reach()))
    return {
        fmt::format("{}: the hand is never nearer than {:.3g} m to the bone. Columns in "
                    "millimetres must be named x_mm,y_mm,z_mm",
                    followed.name, away)};
  if (is_free(session.surface(), what, followed.path.points.front().world_from_tool)) return {};
  return {fmt::format(
      "{}: the {} is inside the bone at the first point. Nothing is felt or cut until it has been "
      "in free air; begin the path above the bone",
      followed.name, followed.second || what.tool != nullptr ? "tool" : "burr")};
}

std::vector<std::string> doubts_after(Session& session, const FollowedPath& followed) {
  if (followed.path.points.empty()) return {};
  const Held what = held(session, followed.second);
  const double away = nearest(followed.path, session.bone());
  if (away > std::max(kFarAway, what.reach()) || touched(session, what, followed.second, away))
    return {};
  if (away > (what.tool != nullptr ? 0 : what.radius))
    return {
        fmt::format("{}: the hand is never nearer than {:.1f} mm to the bone, and nothing was "
                    "touched; compare its places with the box of the bone",
                    followed.name, 1e3 * away)};
  return {};
}

}  // namespace burr::sim
