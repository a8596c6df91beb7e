// render/camera.h - where one looks from: a camera on a sphere around its target, head up.
//
// Units: m, rad. Frame: world (LPS), so the patient's left is at the right of a picture taken from
// the front.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "burr/math/aabb.h"
#include "burr/math/pose.h"

namespace burr::render {

// An eye that stands anywhere, tilted as it is, and sees as far to each side as a headset shows.
struct PlacedEye {
  math::Pose world_from_eye;                          // looks along -z, +y is up in the picture
  double left = -1, right = 1, bottom = -1, top = 1;  // tangents of the angles from straight ahead
};
[[nodiscard]] bool same(const PlacedEye& a, const PlacedEye& b);

struct Camera {
  math::Vec3 target = math::Vec3::Zero();  // is in the middle of the picture               [m]
  double distance = 0.3;                   // from the target                               [m]
  double azimuth = 0;                      // 0 from the front (-y), growing towards +x     [rad]
  double elevation = 0;                    // above the horizon, never quite at a pole      [rad]
  double field_of_view = 0.5;              // from bottom to top of the picture             [rad]
  double aside = 0;  // of this eye from the middle, to the right: what lies as deep as the target
                     // stays where it is, so that two eyes make a stereo picture           [m]
  // in place of the sphere: only target and distance remain what they were, and field_of_view is
  // that of `placed`
  std::optional<PlacedEye> placed = {};

  // Unit vectors: from the target to the eye; to the right; up in the picture. World +z (superior)
  // always points up in it.
  [[nodiscard]] math::Vec3 backward() const;
  [[nodiscard]] math::Vec3 right() const;
  [[nodiscard]] math::Vec3 above() const;
  [[nodiscard]] math::Vec3 eye() const;
  // what is seen at the target from bottom to top  [m]
  [[nodiscard]] double view_height() const;
};

[[nodiscard]] bool same(const Camera& a, const Camera& b);

// Turns around the target; elevation stops short of the poles, so up stays up.
void orbit(Camera& camera, double azimuth_by, double elevation_by);
// > 1 comes nearer; between 2 mm and 5 m.
void zoom(Camera& camera, double factor);
// Moves target and eye in the plane of the picture; in heights of the picture.
void pan(Camera& camera, double right_by, double up_by);

// All the boxes in the picture, seen from azimuth and elevation. aspect: width / height. Many small
// boxes fit a round thing closer than one large. No box leaves the camera where it was.
[[nodiscard]] Camera fit(std::span<const math::Aabb> boxes, double azimuth, double elevation,
                         double aspect, Camera camera = {});

// Looks at the work from outside: along the surface's normal, but tilted, so that the shaft does
// not hide what the head does. view_height: of the surroundings shown  [m].
[[nodiscard]] Camera view_of_work(const math::Vec3& point, const math::Vec3& normal,
                                  double view_height);

// From the tip of a tool ahead, with a wide angle. tip: world; ahead: any length. Straight up and
// down are a degree off, as head up has no meaning there.
[[nodiscard]] Camera endoscope_view(const math::Vec3& tip, const math::Vec3& ahead);

struct Ray {
  math::Vec3 origin = math::Vec3::Zero();
  math::Vec3 direction = math::Vec3::UnitX();  // unit
};

// Through the pixel position (x, y) of a picture of width x height; (0, 0) is its top left corner,
// pixel centres lie at halves.
[[nodiscard]] Ray ray_through(const Camera& camera, double x, double y, int width, int height);

// Part of the picture, as fractions of it from -1 (left, bottom) to 1 (right, top).
struct Window {
  double left = -1, right = 1, bottom = -1, top = 1;
};

// OpenGL conventions: clip space -1..1, eye looks along -z. near, far: along the view axis  [m]
[[nodiscard]] Eigen::Matrix4d view_from_world(const Camera& camera);
[[nodiscard]] Eigen::Matrix4d clip_from_view(const Camera& camera, double aspect, double near,
                                             double far, const Window& part = {});

}  // namespace burr::render
