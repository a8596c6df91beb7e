#include "burr/workshop/seen.h"

#include <algorithm>
#include <cmath>

namespace burr::workshop {

record::View view_of(const render::Camera& camera, std::uint64_t tick) {
  record::View view;
  view.tick = tick;
  view.eye = camera.eye();
  view.right = camera.right();
  view.up = camera.above();
  view.back = camera.backward();
  view.field_of_view = camera.field_of_view;
  view.magnification = record::magnification_of(camera.view_height());
  return view;
}

record::View view_of(const render::Camera& left, const render::Camera& right, std::uint64_t tick) {
  record::View view = view_of(left, tick);
  view.eye = 0.5 * (left.eye() + right.eye());
  view.two_eyes = true;
  return view;
}

render::Camera camera_of(const record::View& view) {
  render::Camera camera;
  camera.field_of_view = view.field_of_view;
  const double height = record::view_height_of(view.magnification);
  camera.distance = height / (2 * std::tan(0.5 * view.field_of_view));
  camera.azimuth = std::atan2(view.back.x(), -view.back.y());
  camera.elevation = std::asin(std::clamp(view.back.z(), -1.0, 1.0));
  camera.target = view.eye - camera.distance * camera.backward();
  return camera;
}

const record::View* view_at(std::span<const record::View> views, std::uint64_t tick) {
  if (views.empty()) return nullptr;
  const auto after =
      std::upper_bound(views.begin(), views.end(), tick,
                       [](std::uint64_t at, const record::View& view) { return at < view.tick; });
  return after == views.begin() ? &views.front() : &*std::prev(after);
}

}  // namespace burr::workshop
