#include "burr/render/held_tool.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/math/rotation.h"
#include "burr/render/pick.h"

namespace burr::render {

using math::Quat;
using math::Vec3;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSettles = 0.12;  // time constant of the hand [s]
constexpr double kPatience = 0.7;  // before it leans as it did before [s]
constexpr double kReach = 40e-3;   // of the shaft that bone should not cross [m]

// How the tool lies in the picture: its angle from the line of sight, and the direction to which it
// leans, counter-clockwise from the right. In the order in which a right hand prefers them.
struct Lean {
  double from_sight, around;
};
constexpr std::array<Lean, 7> kLeans = {{{50 * kDegree, -38 * kDegree},
                                         {40 * kDegree, -38 * kDegree},
                                         {40 * kDegree, 5 * kDegree},
                                         {40 * kDegree, -75 * kDegree},
                                         {30 * kDegree, -38 * kDegree},
                                         {30 * kDegree, 20 * kDegree},
                                         {30 * kDegree, -85 * kDegree}}};

Vec3 direction_of(const Lean& lean, const Camera& camera, const Vec3& tip, bool left_handed) {
  const Vec3 way = camera.eye() - tip;
  const Vec3 sight = way.squaredNorm() > 0 ? Vec3(way.normalized()) : camera.backward();
  Vec3 right = camera.right() - camera.right().dot(sight) * sight;
  right = right.squaredNorm() > 1e-6 ? Vec3(right.normalized()) : sight.unitOrthogonal();
  const Vec3 above = sight.cross(right);
  const double side = left_handed ? -1 : 1;
  return std::cos(lean.from_sight) * sight +
         std::sin(lean.from_sight) *
             (side * std::cos(lean.around) * right + std::sin(lean.around) * above);
}

}  // namespace

// The first lean that no bone crosses. The last one stays while it is free, so that the tool does
// not waver between two; none free: the steepest, as a hand over a deep hole.
Vec3 HeldTool::wanted(const Scene& scene, const Vec3& tip, bool left_handed, double seconds) {
  const auto direction = [&](std::size_t n) {
    return direction_of(kLeans[n], scene.camera, tip, left_handed);
  };
  const auto free = [&](std::size_t n) {
    const Vec3 along = direction(n);
    const auto hit = pick(scene, {tip + scene.burr.radius * along, along});
    return !hit || hit->distance > kReach;
  };
  calm_ = lean_ != 0 && free(0) ? calm_ + seconds : 0;
  if (calm_ > kPatience) lean_ = 0;
  if (!free(lean_)) {
    std::size_t next = 0;
    while (next < kLeans.size() && !free(next)) ++next;
    lean_ = next < kLeans.size() ? next : 4;
  }
  return direction(lean_);
}

math::Pose HeldTool::at(const Scene& scene, const Vec3& tip, bool left_handed, double seconds) {
  const Vec3 to = wanted(scene, tip, left_handed, std::max(seconds, 0.0));
  if (!to.allFinite()) return {tip, q_};
  const Vec3 now = q_ * Vec3::UnitZ();
  const double angle = std::atan2(now.cross(to).norm(), now.dot(to));
  if (!held_) {
    held_ = true;
    q_ = math::shortest_rotation(Vec3::UnitZ(), to);
  } else if (angle > 1e-6) {
    const double part = 1 - std::exp(-std::max(seconds, 0.0) / kSettles);
    const double step = std::min(part * angle, kFastest * std::max(seconds, 0.0));
    Vec3 axis = now.cross(to);
    axis = axis.norm() > 1e-9 ? Vec3(axis.normalized()) : now.unitOrthogonal();
    q_ = (Quat(Eigen::AngleAxisd(step, axis)) * q_).normalized();
  }
  return {tip, q_};
}

}  // namespace burr::render
