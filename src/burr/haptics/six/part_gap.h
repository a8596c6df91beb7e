// haptics/six/part_gap.h - how far two parts of two tools are apart, and where: the nearest points of
// two convex bodies.
//
//     ball, capsule with the same      closed form
//     ball, capsule with another       the distance of a point is convex along the capsule's core: a
//                                      search over the core
//     two others                       the slimmer one is taken as the capsule around it
//
// Spoons and tubes, which are not convex, count as the capsule around them, too. Lattices have a
// distance of their own: lattice_gap.h.
//
// Thread: servo. Frame and unit: any, the same for both. Memory: none.
#pragma once

#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/shape.h"

namespace burr::haptics {

struct PartPlace {
  tool::Shape shape;
  math::Vec3 middle = math::Vec3::Zero();
  math::Quat turn = math::Quat::Identity();  // frame_from_part
};

struct PartGap {
  double gap = 0;                           // below 0: they overlap
  math::Vec3 normal = math::Vec3::UnitX();  // unit, from b to a
  math::Vec3 a = math::Vec3::Zero();        // the nearest points of the surfaces
  math::Vec3 b = math::Vec3::Zero();
};

[[nodiscard]] PartGap part_gap(const PartPlace& a, const PartPlace& b) BURR_RT;

// Two capsules side by side meet along a line, of which part_gap() gives one point: then the ends of
// each against the other, at most four, into `ends`. Returns how many.
[[nodiscard]] int gaps_at_ends(const PartPlace& a, const PartPlace& b, PartGap* ends) BURR_RT;

}  // namespace burr::haptics
