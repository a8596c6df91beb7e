#include "burr/edit/tool_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/rt/simd.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::kBrickEdge;

static_assert(kMostKernelParts == tool::Tool::kMostParts);

// Where a turning part is as fast as the tool's fastest place: its largest radius.  [voxel]
double widest(const tool::Shape& shape) BURR_RT {
  const double along_x = tool::support(shape, Vec3::UnitX());
  if (shape.kind != tool::ShapeKind::grid) return along_x;
  return std::max(along_x, tool::support(shape, Vec3::UnitY()));
}

// From the middle of a brick to its farthest voxel.  [voxel]
const double kHalfBrick = std::sqrt(3.0) * 0.5 * (kBrickEdge - 1);

}  // namespace

ShapeKernel shape_kernel() noexcept {
  if constexpr (rt::kWideKernels) {
    if (rt::simd() == rt::Simd::avx512) return {avx512::find_under_parts};
    if (rt::simd() == rt::Simd::avx2) return {avx2::find_under_parts};
  }
  return {scalar::find_under_parts};
}

ToolBody cutting_body(const tool::Tool& tool, double voxel_m) BURR_RT {
  ToolBody body;
  for (int n = 0; n < tool.count; ++n) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role != tool::Role::cuts) continue;
    body.parts[static_cast<std::size_t>(body.count++)] = {
        tool::scaled(part.shape, 1 / voxel_m),
        {part.tool_from_part.p / voxel_m, part.tool_from_part.q}};
  }
  return body;
}

ToolBody advanced(const ToolBody& body, double by) BURR_RT {
  ToolBody moved = body;
  moved.grid_from_tool.p += by * body.ahead;
  const Vec3 turn = by * body.turn;
  if (math::norm(turn) > 0)
    moved.grid_from_tool.q =
        math::normalized(math::product(math::rotation_of(turn), body.grid_from_tool.q));
  return moved;
}

PlacedBody::PlacedBody(const ShapeKernel& kernel, const ToolBody& body, const Half& half,
                       double margin) BURR_RT : kernel_(kernel),
                                                count_(body.count),
                                                flipped_(half.is_image ? half.mirror.axis : -1),
                                                margin_(margin) {
  const double most = std::numeric_limits<double>::max();
  low_ = Vec3::Constant(most);
  high_ = Vec3::Constant(-most);
  double widest_part = 0;
  for (int n = 0; n < count_; ++n)
    widest_part = std::max(widest_part, widest(body.parts[static_cast<std::size_t>(n)].shape));
  for (int n = 0; n < count_; ++n) {
    const auto at = static_cast<std::size_t>(n);
    const ToolBody::Part& part = body.parts[at];
    const math::Pose pose = body.grid_from_tool * part.tool_from_part;
    // in a mirror: on the lattice whose differences to voxels are exact in floats (mirror.h)
    Vec3 origin = half.mirror.on() ? rounded(pose.p) : pose.p;
    if (half.is_image) origin = half.mirror.image_of(origin);
    Eigen::Matrix3d from_grid = pose.q.conjugate().toRotationMatrix();
    if (flipped_ >= 0) from_grid.col(flipped_) *= -1;
    parts_[at] = {part.shape, {origin, pose.q}};
    origin_[at] = origin;
    KernelPart& to = kernel_parts_[at];
    to.shape = part.shape;
    for (int row = 0; row < 3; ++row)
      for (int axis = 0; axis < 3; ++axis)
        to.from_grid[row][axis] = static_cast<float>(from_grid(row, axis));
    to.full = body.sweep == Sweep::turning ? static_cast<float>(widest_part) : 0;
    to.least_weight = static_cast<float>(body.least_weight);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 way = from_grid.col(axis);
      const double reach = volume::kRamp + margin_;
      high_[axis] = std::max(high_[axis], origin[axis] + tool::support(part.shape, way) + reach);
      low_[axis] = std::min(low_[axis], origin[axis] - tool::support(part.shape, -way) - reach);
    }
  }
}

double PlacedBody::nearest(const Vec3& first) const BURR_RT {
  const Vec3 middle = first + Vec3::Constant(0.5 * (kBrickEdge - 1));
  double least = std::numeric_limits<double>::max();
  for (int n = 0; n < count_; ++n) {
    const auto at = static_cast<std::size_t>(n);
    Vec3 from = middle - origin_[at];
    if (flipped_ >= 0) from[flipped_] *= -1;
    least = std::min(
        least,
        tool::distance(parts_[at].shape, parts_[at].tool_from_part.q.conjugate() * from).phi);
  }
  return least - kHalfBrick - margin_;
}

Excess PlacedBody::find(const volume::Field* field, const Vec3& first,
                        std::uint16_t* out) const BURR_RT {
  std::array<KernelPart, tool::Tool::kMostParts> parts = kernel_parts_;
  for (int n = 0; n < count_; ++n)
    for (int axis = 0; axis < 3; ++axis)
      parts[static_cast<std::size_t>(n)].offset[axis] =
          static_cast<float>(first[axis] - origin_[static_cast<std::size_t>(n)][axis]);
  return kernel_.find(field, parts.data(), count_, static_cast<float>(margin_), out);
}

}  // namespace burr::edit
