#include "burr/surgeon/path_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "burr/volume/sample.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr int kDirections = 200;  // points on the burr that are looked at
constexpr double kSurely = 0.9;   // of its radius: what merely touches is not inside
constexpr double kFarAway = 1;    // a hand that never comes nearer is in other units  [m]

// Even directions by the golden angle.
Vec3 direction(int n) {
  const double z = 1 - 2 * (n + 0.5) / kDirections;
  const double angle = n * std::numbers::pi * (3 - std::sqrt(5.0));
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

bool is_inside(const volume::Bone& bone, const Vec3& middle, double burr_radius) {
  if (volume::depth_at(bone, middle) > 0) return true;
  for (int n = 0; n < kDirections; ++n)
    if (volume::depth_at(bone, middle + kSurely * burr_radius * direction(n)) > 0) return true;
  return false;
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
    box.low = box.low.cwiseMin(first);
    box.high = box.high.cwiseMax(first + Vec3::Constant(volume::kBrickEdge));
  }
  return box;
}

// [m]
double nearest(const device::HandPath& path, const volume::Bone& bone) {
  const Box box = box_of(bone);
  double least = std::numeric_limits<double>::infinity();
  for (const device::PathPoint& point : path.points) {
    const Vec3 p = bone.grid().grid_from_world(point.world_from_tool.p);
    const Vec3 beyond = (p - box.high).cwiseMax(box.low - p).cwiseMax(Vec3::Zero());
    least = std::min(least, beyond.norm() * bone.grid().voxel);
  }
  return least;
}

}  // namespace

std::vector<std::string> doubts(const device::HandPath& path, const volume::Bone& bone,
                                double burr_radius, const std::string& name) {
  std::vector<std::string> out;
  if (path.points.empty()) return out;
  if (is_inside(bone, path.points.front().world_from_tool.p, burr_radius))
    out.push_back(
        fmt::format("{}: the burr is inside the bone at the first point. Nothing is felt or cut "
                    "until it has been "
                    "in free air; begin the path above the bone",
                    name));
  const double away = nearest(path, bone);
  if (away > kFarAway)
    out.push_back(
        fmt::format("{}: the hand is never nearer than {:.3g} m to the bone. Columns in "
                    "millimetres must be named x_mm,y_mm,z_mm",
                    name, away));
  else if (away > burr_radius)
    out.push_back(
        fmt::format("{}: the hand is never nearer than {:.1f} mm to the bone, so nothing "
                    "is touched; compare its places with the box of the bone",
                    name, 1e3 * away));
  return out;
}

}  // namespace burr::surgeon
