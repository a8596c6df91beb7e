#include "burr/workshop/seen.h"

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

}  // namespace burr::workshop
