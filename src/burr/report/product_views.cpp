#include "burr/report/product_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace burr::report {

using math::Vec3;

math::Aabb removed_box(const volume::Bone& before, const volume::Bone& after) {
  math::Aabb box;
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const volume::Field *was = before.brick_field(brick), *is = after.brick_field(brick);
    if (was == nullptr) continue;
    if (is != nullptr && std::memcmp(was, is, volume::kBrickVoxels * sizeof *was) == 0) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (was[v] < volume::kIso || (is != nullptr && is[v] >= volume::kIso)) continue;
      const math::Ijk ijk = before.brick_ijk(brick) + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      box.extend(before.grid().world_from_grid(ijk.cast<double>()));
    }
  }
  return box;
}

Vec3 towards_surgeon(const scenario::CaseLesson& lesson, const scenario::Case& work) {
  const Vec3 out = !lesson.approach.empty() ? lesson.approach.front()
                   : work.into              ? Vec3(-*work.into)
                                            : Vec3::UnitZ();
  return out.normalized();
}

render::Camera camera_from(const Vec3& towards, const Vec3& target, double height) {
  render::Camera camera;
  camera.target = target;
  camera.elevation = std::asin(std::clamp(towards.z(), -1.0, 1.0));
  camera.azimuth = std::atan2(towards.x(), -towards.y());
  render::orbit(camera, 0, 0);  // not quite at a pole
  camera.distance = 0.5 * height / std::tan(0.5 * camera.field_of_view);
  return camera;
}

std::vector<ProductView> product_views(const math::Aabb& removed, const Vec3& towards,
                                       const std::optional<Vec3>& at) {
  constexpr double kAside = 40 * std::numbers::pi / 180;
  struct Side {
    const char* name;
    double turn, lift;
  };
  static constexpr std::array<Side, 4> kSides4 = {
      {{"straight", 0, 0}, {"below", 0, -kAside}, {"left", -kAside, 0}, {"right", kAside, 0}}};
  const bool nothing = removed.empty();
  const double size = nothing ? 20e-3 : removed.extent().maxCoeff();
  const Vec3 middle = nothing ? at.value_or(Vec3::Zero()) : removed.centre();
  const double height = std::clamp(1.15 * size + 6e-3, 18e-3, 90e-3);
  std::vector<ProductView> all;
  for (const Side& side : kSides4) {
    ProductView view{side.name, height, camera_from(towards, middle, height), std::nullopt};
    render::orbit(view.camera, side.turn, side.lift);
    all.push_back(std::move(view));
  }
  if (nothing) return all;
  static constexpr std::array<std::pair<render::Plane, const char*>, 3> kPlanes = {
      {{render::Plane::axial, "axial"},
       {render::Plane::coronal, "coronal"},
       {render::Plane::sagittal, "sagittal"}}};
  for (const auto& [plane, name] : kPlanes)
    for (const int third : {1, 2}) {
      render::Slice slice;
      slice.plane = plane;
      slice.through = removed.lo + third / 3.0 * removed.extent();
      slice.height = height;
      all.push_back({fmt::format("{}-{}", name, third), height, {}, slice});
    }
  return all;
}

}  // namespace burr::report
