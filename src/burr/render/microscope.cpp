#include "burr/render/microscope.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "burr/render/pick.h"

namespace burr::render {

using math::Vec3;

namespace {

constexpr double kFar = 0.25;    // from the eye to what is in focus [m]
constexpr double kNarrow = 0.3;  // widest angle of a microscope's picture [rad]
constexpr double kPole = 89.0 * std::numbers::pi / 180;

}  // namespace

Camera microscope_view(const Vec3& target, const Vec3& outward, double field) {
  const Vec3 d = outward.squaredNorm() > 0 ? outward.normalized().eval() : Vec3(0, -1, 0);
  Camera camera;
  camera.target = target;
  camera.azimuth = std::atan2(d.x(), -d.y());
  camera.elevation = std::clamp(std::asin(std::clamp(d.z(), -1.0, 1.0)), -kPole, kPole);
  set_field(camera, field);
  return camera;
}

void set_field(Camera& camera, double field) {
  camera.distance = kFar;
  camera.field_of_view = 2 * std::atan(0.5 * field / kFar);
}

std::size_t field_step(const Camera& camera) {
  std::size_t nearest = 0;
  const auto off = [&](std::size_t n) {
    return std::abs(std::log(kFields[n] / std::max(camera.view_height(), 1e-6)));
  };
  for (std::size_t n = 1; n < kFields.size(); ++n)
    if (off(n) < off(nearest)) nearest = n;
  return nearest;
}

bool is_microscope(const Camera& camera) {
  return camera.field_of_view < kNarrow && camera.distance > 0.5 * kFar;
}

Focus microscope_focus(const Camera& camera, double beyond) {
  constexpr double kPupil = 5e-3, kNearest = 10e-3;
  return {std::max(camera.distance + beyond, kNearest), kPupil};
}

void light_coaxially(Look& look) {
  look.key = {{-0.20, 0.30, 1}, {1.0F, 0.98F, 0.94F}, 0.70};
  look.fill = {{0.30, -0.20, 1}, {0.92F, 0.96F, 1.0F}, 0.06};
  look.ambient = 0.09;
  look.background_top = {0.05F, 0.05F, 0.06F};
  look.background_bottom = {0.03F, 0.03F, 0.04F};
}

std::shared_ptr<const Drape> drape_over(const Scene& scene, const Opening& opening) {
  constexpr double kAbove = 0.1;
  const DrapeAxes axes = axes_of(opening);
  const auto height = [&](double right, double up) -> std::optional<double> {
    const Vec3 from = opening.centre + right * axes.right + up * axes.up + kAbove * opening.outward;
    const auto bone = pick(scene, {from, -opening.outward});
    if (!bone) return std::nullopt;
    return kAbove - bone->distance;
  };
  return std::make_shared<const Drape>(make_drape(opening, height));
}

}  // namespace burr::render
