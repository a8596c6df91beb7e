#include "burr/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burr::render {

using math::Vec3;

namespace {
constexpr double kPole = 89.0 * std::numbers::pi / 180;  // largest elevation
constexpr double kNearest = 2e-3, kFarthest = 5;         // distance to the target [m]
}  // namespace

bool same(const PlacedEye& a, const PlacedEye& b) {
  return (a.world_from_eye.p.array() == b.world_from_eye.p.array()).all() &&
         (a.world_from_eye.q.coeffs().array() == b.world_from_eye.q.coeffs().array()).all() &&
         a.left == b.left && a.right == b.right && a.bottom == b.bottom && a.top == b.top;
}

Vec3 Camera::backward() const {
  if (placed) return placed->world_from_eye.q * Vec3::UnitZ();
  return {std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}
Vec3 Camera::right() const {
  if (placed) return placed->world_from_eye.q * Vec3::UnitX();
  return {std::cos(azimuth), std::sin(azimuth), 0};
}
Vec3 Camera::above() const { return backward().cross(right()); }
Vec3 Camera::eye() const {
  if (placed) return placed->world_from_eye.p;
  return target + distance * backward() + aside * right();
}
double Camera::view_height() const { return 2 * distance * std::tan(field_of_view / 2); }

bool same(const Camera& a, const Camera& b) {
  return (a.target.array() == b.target.array()).all() && a.distance == b.distance &&
         a.azimuth == b.azimuth && a.elevation == b.elevation &&
         a.field_of_view == b.field_of_view && a.aside == b.aside &&
         a.placed.has_value() == b.placed.has_value() && (!a.placed || same(*a.placed, *b.placed));
}

void orbit(Camera& camera, double azimuth_by, double elevation_by) {
  camera.azimuth = std::remainder(camera.azimuth + azimuth_by, 2 * std::numbers::pi);
  camera.elevation = std::clamp(camera.elevation + elevation_by, -kPole, kPole);
}

void zoom(Camera& camera, double factor) {
  camera.distance = std::clamp(camera.distance / factor, kNearest, kFarthest);
}

void pan(Camera& camera, double right_by, double up_by) {
  camera.target += camera.view_height() * (right_by * camera.right() + up_by * camera.above());
}

Camera fit(std::span<const math::Aabb> boxes, double azimuth, double elevation, double aspect,
           Camera camera) {
  math::Aabb all;
  for (const math::Aabb& box : boxes) {
    all.extend(box.lo);
    all.extend(box.hi);
  }
  if (all.empty()) return camera;
  camera.azimuth = azimuth;
  camera.elevation = std::clamp(elevation, -kPole, kPole);
  camera.target = all.centre();

  // each corner must lie inside the field of view; the largest distance counts
  const double tan_y = std::tan(camera.field_of_view / 2), tan_x = tan_y * aspect;
  const Vec3 right = camera.right(), above = camera.above(), backward = camera.backward();
  double distance = kNearest;
  for (const math::Aabb& box : boxes) {
    if (box.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 d = box.corner(corner) - camera.target;
      distance = std::max(distance, d.dot(backward) + std::abs(d.dot(above)) / tan_y);
      distance = std::max(distance, d.dot(backward) + std::abs(d.dot(right)) / tan_x);
    }
  }
  camera.distance = std::min(1.04 * distance, kFarthest);  // with a small margin
  return camera;
}

Camera view_of_work(const Vec3& point, const Vec3& normal, double view_height) {
  // the shaft goes along the normal: look from 32 degrees beside it, and rather from above
  constexpr double kTilt = 32.0 * std::numbers::pi / 180;
  const Vec3 n = normal.squaredNorm() > 0 ? normal.normalized().eval() : Vec3(0, -1, 0);
  Vec3 aside = Vec3::UnitZ() - n.z() * n;
  if (aside.norm() < 0.5) aside = -Vec3::UnitY() + n.y() * n;
  const Vec3 d = std::cos(kTilt) * n + std::sin(kTilt) * aside.normalized();

  Camera camera;
  camera.target = point;
  camera.azimuth = std::atan2(d.x(), -d.y());
  camera.elevation = std::clamp(std::asin(std::clamp(d.z(), -1.0, 1.0)), -kPole, kPole);
  camera.distance = view_height / (2 * std::tan(camera.field_of_view / 2));
  return camera;
}

Camera endoscope_view(const Vec3& tip, const Vec3& ahead) {
  constexpr double kWide = 95.0 * std::numbers::pi / 180, kDeep = 10e-3;
  const Vec3 back = ahead.squaredNorm() > 0 ? Vec3(-ahead.normalized()) : Vec3(0, -1, 0);
  Camera camera;
  camera.field_of_view = kWide;
  camera.distance = kDeep;
  camera.azimuth = std::atan2(back.x(), -back.y());
  camera.elevation = std::clamp(std::asin(std::clamp(back.z(), -1.0, 1.0)), -kPole, kPole);
  camera.target = tip - kDeep * camera.backward();
  return camera;
}

Ray ray_through(const Camera& camera, double x, double y, int width, int height) {
  if (camera.placed) {
    const PlacedEye& eye = *camera.placed;
    const double right = eye.left + (eye.right - eye.left) * x / width;
    const double up = eye.top + (eye.bottom - eye.top) * y / height;
    return {camera.eye(), (eye.world_from_eye.q * Vec3(right, up, -1)).normalized()};
  }
  const double t = std::tan(camera.field_of_view / 2);
  const double up = (1 - 2 * y / height) * t;
  const double right = (2 * x - width) / height * t - camera.aside / camera.distance;
  return {camera.eye(),
          (right * camera.right() + up * camera.above() - camera.backward()).normalized()};
}

Eigen::Matrix4d view_from_world(const Camera& camera) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = camera.right().transpose();
  m.block<1, 3>(1, 0) = camera.above().transpose();
  m.block<1, 3>(2, 0) = camera.backward().transpose();
  m.block<3, 1>(0, 3) = -(m.block<3, 3>(0, 0) * camera.eye());
  return m;
}

Eigen::Matrix4d clip_from_view(const Camera& camera, double aspect, double near, double far,
                               const Window& part) {
  const double t = near * std::tan(camera.field_of_view / 2);
  const double shift = camera.aside * near / camera.distance;
  double left = part.left * t * aspect - shift, right = part.right * t * aspect - shift;
  double bottom = part.bottom * t, top = part.top * t;
  if (camera.placed) {
    const PlacedEye& eye = *camera.placed;
    const auto at = [near](double from, double to, double where) {
      return near * (from + (to - from) * 0.5 * (where + 1));
    };
    left = at(eye.left, eye.right, part.left);
    right = at(eye.left, eye.right, part.right);
    bottom = at(eye.bottom, eye.top, part.bottom);
    top = at(eye.bottom, eye.top, part.top);
  }
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2 * near / (right - left);
  m(0, 2) = (right + left) / (right - left);
  m(1, 1) = 2 * near / (top - bottom);
  m(1, 2) = (top + bottom) / (top - bottom);
  m(2, 2) = -(far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m(3, 2) = -1;
  return m;
}

}  // namespace burr::render
