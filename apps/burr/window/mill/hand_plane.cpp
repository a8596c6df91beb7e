#include "window/mill/hand_plane.h"

#include <utility>
#include <vector>

namespace burr::app {

using math::Vec3;

Vec3 HandPlane::meet(const render::Ray& ray, const render::Camera& camera) {
  constexpr double kFlat = 1e-3;  // below this the ray is nearly parallel to the plane
  const Vec3 n = -camera.backward();
  const double along = ray.direction.dot(n), far = (at_ - ray.origin).dot(n);
  if (along > kFlat && far > 0) at_ = ray.origin + far / along * ray.direction;
  return at_;
}

void HandPlane::show(render::Scene& scene) {
  constexpr render::Colour kColour = {0.25F, 0.65F, 1.0F};  // as the dot that marks the hand
  constexpr int kLines = 2;                                 // on each side of the middle line
  std::erase_if(scene.rods,
                [this](const render::Rod& rod) { return shown_ > 0 && rod.radius == shown_; });
  shown_ = 0;
  if (!on_) return;
  const double view = scene.camera.view_height(), apart = view / 20;
  shown_ = 0.0006 * view;
  for (const auto& [along, across] : {std::pair{scene.camera.right(), scene.camera.above()},
                                      {scene.camera.above(), scene.camera.right()}})
    for (int n = -kLines; n <= kLines; ++n) {
      const Vec3 middle = at_ + n * apart * across, half = kLines * apart * along;
      scene.rods.push_back({middle - half, middle + half, shown_, kColour, false, false});
    }
}

}  // namespace burr::app
