#include "burr/workshop/piece_plan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "burr/math/turn.h"

namespace burr::workshop {

using math::Ijk;
using math::Quat;
using math::Vec3;

const scenario::PlannedPiece* plan_of(const scenario::CaseLesson& lesson,
                                      const volume::Bone& piece) {
  constexpr double kNear = 3e-3;  // [m]
  const double voxel = piece.grid().voxel;
  double least = kNear;
  const scenario::PlannedPiece* best = nullptr;
  for (const scenario::PlannedPiece& plan : lesson.pieces) {
    const Vec3 at = piece.grid().grid_from_world(plan.near.at);
    double nearest = std::numeric_limits<double>::infinity();
    for (volume::BrickIndex brick = 0; brick < piece.brick_count(); ++brick) {
      const volume::Field* const field = piece.brick_field(brick);
      if (field == nullptr) continue;
      const Ijk first = piece.brick_ijk(brick);
      for (int v = 0; v < volume::kBrickVoxels; ++v) {
        if (field[v] < volume::kIso) continue;
        const Vec3 p = (first + Ijk(v & 7, v >> 3 & 7, v >> 6)).cast<double>();
        nearest = std::min(nearest, (p - at).norm() * voxel);
      }
    }
    if (nearest > least || (best != nullptr && nearest == least)) continue;
    least = nearest;
    best = &plan;
  }
  return best;
}

OffPlan off_plan(const scenario::PlannedPiece& plan, const Vec3& by, const Quat& turn) {
  OffPlan off;
  off.wanted_way = plan.by.norm();
  off.way = off.wanted_way > 0 ? by.dot(plan.by) / off.wanted_way : by.norm();
  off.off = (by - plan.by).norm();
  const Quat wanted = math::rotation_of(plan.turn);
  off.turned_off = math::rotation_vector(math::product(turn, wanted.conjugate())).norm();
  return off;
}

}  // namespace burr::workshop
