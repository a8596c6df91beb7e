#include "burr/render/headset.h"

#include <algorithm>
#include <cmath>

namespace burr::render {
namespace {

constexpr double kArm = 0.5;  // distance of the work in front of the head, in the room [m]

}  // namespace

math::Pose placed(const Camera& middle, const math::Pose& in_room) {
  Eigen::Matrix3d axes;
  axes << middle.right(), middle.above(), middle.backward();
  const math::Pose world_from_head = {middle.eye(), math::Quat(axes)};
  return world_from_head * math::Pose{middle.distance / kArm * in_room.p, in_room.q};
}

Camera placed(const Camera& middle, const PlacedEye& room_from_eye) {
  Camera camera = middle;
  camera.aside = 0;
  camera.placed = room_from_eye;
  camera.placed->world_from_eye = placed(middle, room_from_eye.world_from_eye);
  camera.field_of_view = 2 * std::atan(0.5 * (room_from_eye.top - room_from_eye.bottom));
  // a person who bends over the work wants to see what is near
  camera.distance = std::clamp((middle.target - camera.eye()).norm(), 5e-3, 5.0);
  return camera;
}

}  // namespace burr::render
