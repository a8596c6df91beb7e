// render/gl/frame.h - where the eye is and how a part of its picture lies in the target. Units: m;
// frame: world, LPS.
// A header of this room only.
#pragma once

#include <array>
#include <span>

#include "burr/render/camera.h"
#include "burr/render/gl/region.h"

namespace burr::render::gl {

// How a part of the picture lies in the target.
struct Frame {
  int picture_width = 0, picture_height = 0;  // whole picture, in samples
  int left = 0, bottom = 0;                   // of the target's first sample in it
  int width = 0, height = 0;                  // of the target
  double near = 0, far = 1;
  Eigen::Matrix4d view, clip;  // view_from_world, clip_from_view (of this part)
  [[nodiscard]] Rect all() const { return {0, 0, width, height}; }
};

// Near enough for the tool before the bone, far enough for all of it; depends on the camera and the
// bone's extent alone, so that a moving tool leaves it alone.
void set_depths(Frame& frame, const Camera& camera, const math::Aabb& bone);

// Where something within the hull of these points may appear in the target; everything if a point
// is beside or behind the eye.
[[nodiscard]] Rect rect_of(std::span<const math::Vec3> points, const Frame& frame);
[[nodiscard]] Rect rect_of(const math::Aabb& box, const Frame& frame);

// view xy per depth = uv * xy + zw, uv 0..1 over the target
[[nodiscard]] Eigen::Vector4f ray_of(const Frame& frame);

// The six planes of what can be seen through `r`, in the world, pointing inwards.
[[nodiscard]] std::array<Eigen::Vector4d, 6> planes_of(const Rect& r, const Frame& frame);

}  // namespace burr::render::gl
