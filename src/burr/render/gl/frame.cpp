#include "burr/render/gl/frame.h"

#include <algorithm>

namespace burr::render::gl {

using math::Aabb;
using math::Vec3;

void set_depths(Frame& frame, const Camera& camera, const Aabb& bone) {
  constexpr double kRoom = 0.1;  // space for the tool in the hand [m]
  frame.near = std::max(0.02 * camera.distance, 0.5e-3);
  double far = camera.distance;
  for (int corner = 0; corner < 8 && !bone.empty(); ++corner) {
    const Vec3 p = bone.corner(corner);
    far = std::max(far, (camera.eye() - p).dot(camera.backward()));
  }
  frame.far = far + kRoom;
}

Rect rect_of(std::span<const Vec3> points, const Frame& frame) {
  Eigen::Vector2d lo(1e30, 1e30), hi(-1e30, -1e30);
  for (const Vec3& point : points) {
    const Eigen::Vector4d c = frame.clip * (frame.view * point.homogeneous());
    if (c.w() < frame.near) return frame.all();
    lo = lo.cwiseMin(c.head<2>() / c.w());
    hi = hi.cwiseMax(c.head<2>() / c.w());
  }
  const auto pixel = [](double clip, int size) {
    return static_cast<int>(std::clamp((clip * 0.5 + 0.5) * size, -1e6, 1e6));
  };
  const Rect r = {pixel(lo.x(), frame.width) - 2, pixel(lo.y(), frame.height) - 2,
                  pixel(hi.x(), frame.width) + 3, pixel(hi.y(), frame.height) + 3};
  return r.in(frame.all());
}
Rect rect_of(const Aabb& box, const Frame& frame) {
  if (box.empty()) return {};
  std::array<Vec3, 8> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners[static_cast<std::size_t>(corner)] = box.corner(corner);
  return rect_of(corners, frame);
}

Eigen::Vector4f ray_of(const Frame& frame) {
  const Eigen::Matrix4d& m = frame.clip;
  return {static_cast<float>(2 / m(0, 0)), static_cast<float>(2 / m(1, 1)),
          static_cast<float>((m(0, 2) - 1) / m(0, 0)), static_cast<float>((m(1, 2) - 1) / m(1, 1))};
}

std::array<Eigen::Vector4d, 6> planes_of(const Rect& r, const Frame& frame) {
  const Eigen::Matrix4d m = frame.clip * frame.view;
  const auto clip = [](int pixel, int size) { return 2.0 * pixel / size - 1; };
  const Eigen::Vector4d x = m.row(0).transpose(), y = m.row(1).transpose(),
                        z = m.row(2).transpose(), w = m.row(3).transpose();
  return {x - clip(r.x0, frame.width) * w,
          clip(r.x1, frame.width) * w - x,
          y - clip(r.y0, frame.height) * w,
          clip(r.y1, frame.height) * w - y,
          z + w,
          w - z};
}

}  // namespace burr::render::gl
