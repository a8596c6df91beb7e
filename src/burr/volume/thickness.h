// volume/thickness.h - the thickness of the bone along a straight line, while its writer cuts it.
//
// Frame: world, LPS. Units: m. Thread: any (reads by copy_brick(); the writer does not wait).
// Memory: a few bricks, on the caller's stack. Cost: a sample every quarter of a voxel, some 0.1 ms
// for 30 mm at 0.2 mm.
#pragma once

#include <optional>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::volume {

struct Span {
  math::Vec3 in = math::Vec3::Zero(), out = math::Vec3::Zero();  // where the line enters and leaves
  [[nodiscard]] double length() const { return math::norm(out - in); }
};

// The first bone along the line from `from` in `direction` (unit) that begins within `reach`, up to
// the air behind it. Outside the grid is air. Nothing: no bone within reach, or an argument is not
// a number.
[[nodiscard]] std::optional<Span> thickness(const Bone& bone, const math::Vec3& from,
                                            const math::Vec3& direction, double reach);

}  // namespace burr::volume
