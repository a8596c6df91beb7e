// tool/shape.h - one body of a tool: a core and the ball of radius `rounding` rolled over it.
//
//     phi(y) = (signed distance of y to the core) - rounding      > 0 outside, |grad phi| = 1
//
// The rounding is what keeps the normal of contact from jumping at an edge: the curvature of the
// distance outside is at most 1 / rounding. All kinds but half_shell, tube and grid are convex.
//
// Frame: of the part; every kind but box and wedge is round about z. Units: any one length, the
// same for sizes and places (m in a tool, voxel in touch). Thread: any. Memory: none.
// Formulas: docs/understand/touch_tools.md, "Shapes"; the distances themselves are in
// shape_formulas.h.
#pragma once

#include "burr/math/aabb.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/shape_kind.h"

namespace burr::tool {

// Distance to the surface, below 0 inside, and its gradient: unit, pointing away from the shape.
// On the axis or in the middle, where the gradient is not unique, one of those possible.
struct Distance {
  double phi = 0;
  math::Vec3 gradient = math::Vec3::UnitX();
};

[[nodiscard]] Distance distance(const Shape& shape, const math::Vec3& p) BURR_RT;

// max over the shape of direction . p; of a grid, over the box around its body, which may be more.
// direction need not be unit.
[[nodiscard]] double support(const Shape& shape, const math::Vec3& direction) BURR_RT;

// The smallest box with sides along the axes.
[[nodiscard]] math::Aabb bounds(const Shape& shape) BURR_RT;

// A ball that holds the shape; its centre is the middle of bounds().
struct BoundingBall {
  math::Vec3 centre = math::Vec3::Zero();
  double radius = 0;
};
[[nodiscard]] BoundingBall bounding_ball(const Shape& shape) BURR_RT;

[[nodiscard]] bool convex(ShapeKind kind) BURR_RT;

// The same shape in another unit: every length times `factor`, which is above 0.
[[nodiscard]] Shape scaled(const Shape& shape, double factor) BURR_RT;

// True if the sizes are finite and describe a body: none below 0, those that the kind needs above.
[[nodiscard]] bool is_body(const Shape& shape) BURR_RT;

}  // namespace burr::tool
