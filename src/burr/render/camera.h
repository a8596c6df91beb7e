// render/camera.h - the viewpoint: a camera on a sphere around its target, with the patient's head
// up.
//
// Units: m, rad. Frame: world (LPS), so in a picture from the front the patient's left is at the
// right.
// Thread: any.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "burr/math/aabb.h"
#include "burr/math/pose.h"

namespace burr::render {

// An eye at any place, with any tilt, and with the field of view that a headset gives it.
struct PlacedEye {
  math::Pose world_from_eye;                          // looks along -z, +y is up in the picture
  double left = -1, right = 1, bottom = -1, top = 1;  // tangents of the angles from the axis to
                                                      // each edge of the picture
};
[[nodiscard]] bool same(const PlacedEye& a, const PlacedEye& b);

struct Camera {
  math::Vec3 target = math::Vec3::Zero();  // point in the middle of the picture [m]
  double distance = 0.3;                   // from the target [m]
  double azimuth = 0;                      // 0 from the front (-y), increasing towards +x [rad]
  double elevation = 0;                    // above the horizon, never quite 90 degrees [rad]
  double field_of_view = 0.5;              // vertical angle of the picture [rad]
  double aside = 0;  // offset of this eye to the right. What lies as deep as the target keeps its
                     // place in the picture, so that two eyes make a stereo picture [m]
  // replaces the sphere: target and distance stay as they are; field_of_view is that of `placed`
  std::optional<PlacedEye> placed = {};

  // Unit vectors: from the target to the eye; to the right; up in the picture. World +z (superior)
  // always points up in the picture.
  [[nodiscard]] math::Vec3 backward() const;
  [[nodiscard]] math::Vec3 right() const;
  [[nodiscard]] math::Vec3 above() const;
  [[nodiscard]] math::Vec3 eye() const;
  // height of the picture at the target [m]
  [[nodiscard]] double view_height() const;
};

[[nodiscard]] bool same(const Camera& a, const Camera& b);

// Turns around the target; elevation stops short of the poles, so that up stays up.
void orbit(Camera& camera, double azimuth_by, double elevation_by);
// factor > 1 goes nearer; distance stays between 2 mm and 5 m.
void zoom(Camera& camera, double factor);
// Moves target and eye in the plane of the picture; unit: heights of the picture.
void pan(Camera& camera, double right_by, double up_by);

// A camera at azimuth and elevation with all the boxes in its picture. aspect: width / height. Many
// small boxes fit a round shape more closely than one large box. No box: the camera is returned
// unchanged.
[[nodiscard]] Camera fit(std::span<const math::Aabb> boxes, double azimuth, double elevation,
                         double aspect, Camera camera = {});

// A camera that looks at the work from outside: along the surface's normal, but tilted, so that the
// shaft does not hide the burr's head. view_height: height of the picture at the work [m].
[[nodiscard]] Camera view_of_work(const math::Vec3& point, const math::Vec3& normal,
                                  double view_height);

// A camera at the tip of a tool that looks ahead, with a wide angle. tip: world; ahead: any length.
// A direction straight up or down is changed by one degree, because "head up" has no meaning there.
[[nodiscard]] Camera endoscope_view(const math::Vec3& tip, const math::Vec3& ahead);

struct Ray {
  math::Vec3 origin = math::Vec3::Zero();
  math::Vec3 direction = math::Vec3::UnitX();  // unit
};

// The ray through the pixel position (x, y) of a picture of width x height; (0, 0) is its top left
// corner, pixel centres lie at halves.
[[nodiscard]] Ray ray_through(const Camera& camera, double x, double y, int width, int height);

// A part of the picture, as fractions from -1 (left, bottom) to 1 (right, top).
struct Window {
  double left = -1, right = 1, bottom = -1, top = 1;
};

// OpenGL conventions: clip space -1..1, the eye looks along -z. near, far: along the view axis [m]
[[nodiscard]] Eigen::Matrix4d view_from_world(const Camera& camera);
[[nodiscard]] Eigen::Matrix4d clip_from_view(const Camera& camera, double aspect, double near,
                                             double far, const Window& part = {});

}  // namespace burr::render
