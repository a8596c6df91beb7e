#include "burr/dataset/eye.h"

#include <cmath>

#include "burr/workshop/seen.h"
#include "burr/workshop/work_view.h"

namespace burr::dataset {

Result<Eyes> Eyes::of(record::Player& player, const volume::Bone& before) {
  Eyes eyes;
  eyes.views_ = player.views();
  if (!eyes.views_.empty()) return eyes;
  eyes.recorded_ = false;
  const auto last = player.tick_at(player.seconds());
  if (!last) return last.error();
  const math::Vec3 shaft = last->hand.world_from_tool.q * math::Vec3::UnitZ();
  const render::Scene scene =
      workshop::scene_of_work(before, last->tool.radius, last->contact.proxy, shaft);
  eyes.views_.push_back(workshop::view_of(scene.camera, 0));
  return eyes;
}

const record::View& Eyes::at(std::uint64_t tick) {
  while (now_ + 1 < views_.size() && views_[now_ + 1].tick <= tick) ++now_;
  return views_[now_];
}

math::Pose ambf_camera(const record::View& view) {
  math::Mat3 axes;
  axes << view.back, view.right, view.up;
  return {view.eye, math::Quat(axes).normalized()};
}

render::Camera camera_of(const record::View& view, double field_of_view, double aspect,
                         double right) {
  math::Mat3 axes;
  axes << view.right, view.up, view.back;
  render::PlacedEye eye;
  eye.world_from_eye = {view.eye + right * view.right, math::Quat(axes).normalized()};
  eye.top = std::tan(field_of_view / 2);
  eye.bottom = -eye.top;
  eye.right = aspect * eye.top;
  eye.left = -eye.right;
  render::Camera camera = workshop::camera_of(view);
  camera.field_of_view = field_of_view;
  camera.placed = eye;
  return camera;
}

std::array<double, 9> intrinsic(double field_of_view, int width, int height) {
  const double focal = height / (2 * std::tan(field_of_view / 2));
  return {focal, 0, width / 2.0, 0, focal, height / 2.0, 0, 0, 1};
}

}  // namespace burr::dataset
