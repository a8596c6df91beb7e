// render/gl/frame.h - the position of the eye, and the part of its picture that a target holds.
// Units: m; frame: world, LPS. For use of this room only.
//
// Thread: any.
#pragma once

#include <array>
#include <span>

#include "burr/render/camera.h"
#include "burr/render/gl/target_parts.h"

namespace burr::render::gl {

// The position of a target within the whole picture.
struct Frame {
  int picture_width = 0, picture_height = 0;  // whole picture, in samples
  int left = 0, bottom = 0;                   // of the target's first sample, in the picture
  int width = 0, height = 0;                  // of the target
  double near = 0, far = 1;
  Eigen::Matrix4d view, clip;  // view_from_world, clip_from_view (of this part)
  [[nodiscard]] Rect all() const { return {0, 0, width, height}; }
};

// Sets the near and far depths: near enough for the tool in front of the bone, far enough for all
// of it. They depend only on the camera and the bone's extent, so a moving tool does not change
// them.
void set_depths(Frame& frame, const Camera& camera, const math::Aabb& bone);

// The rectangle of the target in which something within the hull of these points may appear; the
// whole target if a point is beside or behind the eye.
[[nodiscard]] Rect rect_of(std::span<const math::Vec3> points, const Frame& frame);
[[nodiscard]] Rect rect_of(const math::Aabb& box, const Frame& frame);

// view xy per depth = uv * xy + zw, with uv 0..1 over the target
[[nodiscard]] Eigen::Vector4f ray_of(const Frame& frame);

// The six planes around what can be seen through `r`, in the world, pointing inwards.
[[nodiscard]] std::array<Eigen::Vector4d, 6> planes_of(const Rect& r, const Frame& frame);

}  // namespace burr::render::gl
