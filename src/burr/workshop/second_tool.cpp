#include "burr/workshop/second_tool.h"

#include <algorithm>
#include <cmath>

#include "burr/device/hand.h"
#include "burr/workshop/work_view.h"

namespace burr::workshop {
namespace {

using math::Vec3;
using tool::ShapeKind;

// Its rods are known by their colour.
constexpr render::Colour kTube = {0.72F, 0.76F, 0.8F}, kCuts = {0.62F, 0.66F, 0.71F};
constexpr double kLong = 60e-3;  // length of the part of the tube that is drawn  [m]
constexpr int kMostRods = 24;    // of a flat part

void add(render::Scene& scene, const Vec3& a, const Vec3& b, double radius,
         const render::Colour& colour) {
  scene.rods.push_back({a, b, radius, colour, false, false});
}

// A flat part is a row of rods as thick as it is.
void add_box(render::Scene& scene, const math::Pose& world_from_part, const math::Aabb& box,
             const render::Colour& colour) {
  const Vec3 half = 0.5 * (box.hi - box.lo), middle = 0.5 * (box.hi + box.lo);
  int along = 0, thin = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (half[axis] > half[along]) along = axis;
    if (half[axis] < half[thin]) thin = axis;
  }
  if (along == thin) thin = (along + 1) % 3;
  const int wide = 3 - along - thin;
  const int rods = std::clamp(static_cast<int>(std::ceil(half[wide] / half[thin])), 1, kMostRods);
  for (int n = 0; n < rods; ++n) {
    Vec3 a = middle, b = middle;
    a[along] -= half[along];
    b[along] += half[along];
    a[wide] = b[wide] = middle[wide] + half[wide] * ((2.0 * n + 1) / rods - 1);
    add(scene, world_from_part * a, world_from_part * b, std::max(half[thin], half[wide] / rods),
        colour);
  }
}

void add_part(render::Scene& scene, const math::Pose& world_from_tool, const tool::Part& part) {
  const math::Pose at = {world_from_tool * part.tool_from_part.p,
                         world_from_tool.q * part.tool_from_part.q};
  const render::Colour& colour = part.role == tool::Role::cuts ? kCuts : kTube;
  const math::Aabb box = tool::bounds(part.shape);
  if (part.shape.kind == ShapeKind::box || part.shape.kind == ShapeKind::wedge) {
    add_box(scene, at, box, colour);
    return;
  }
  const double radius = 0.5 * (box.hi.x() - box.lo.x());
  Vec3 from(0, 0, box.lo.z()), to(0, 0, box.hi.z());
  add(scene, at * from, at * to, radius, colour);
}

}  // namespace

void put_second_tool(render::Scene& scene, const tick::TickRow* row, const tool::Tool* tool) {
  std::erase_if(scene.rods,
                [](const render::Rod& rod) { return rod.colour == kTube || rod.colour == kCuts; });
  if (row == nullptr || !row->hand.valid) return;
  const math::Pose at = pose_of_tool(*row);
  if (tool == nullptr) {
    add(scene, at.p, at * Vec3(0, 0, kLong), row->tool.radius, kTube);
    return;
  }
  for (int p = 0; p < tool->count; ++p)
    add_part(scene, at, tool->parts[static_cast<std::size_t>(p)]);
}

bool sucks(const tick::TickRow& row) {
  return row.tool.number < 0 && row.hand.valid && (row.hand.buttons & device::kLifted) == 0 &&
         row.hand.pedal <= 0;
}

}  // namespace burr::workshop
