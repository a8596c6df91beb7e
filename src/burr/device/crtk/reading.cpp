#include "burr/device/crtk/reading.h"

namespace burr::device::crtk {
namespace {

constexpr double kFarthest = 5;   // no arm is longer [m]
constexpr double kFastest = 100;  // no hand is faster [m/s]

}  // namespace

bool take_place(const PoseStamped& message, HandState& hand) BURR_RT {
  const math::Pose pose = pose_of(message.pose_);
  const double size = pose.q.norm();
  if (is_zero(message.header_.stamp_) || !pose.finite() || !(size > 0.5 && size < 2) ||
      !(pose.p.norm() < kFarthest))
    return false;
  hand.world_from_tool = {pose.p, math::Quat(pose.q.coeffs() / size)};
  return true;
}

bool take_speed(const TwistStamped& message, HandState& hand) BURR_RT {
  const math::Vec3 speed = is_zero(message.header_.stamp_) ? math::Vec3(math::Vec3::Zero())
                                                           : vector_of(message.twist_.linear_);
  if (!(speed.norm() < kFastest)) return false;  // written so that a NaN is refused too
  hand.velocity = speed;
  return true;
}

}  // namespace burr::device::crtk
