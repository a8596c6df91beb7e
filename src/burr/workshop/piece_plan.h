// workshop/piece_plan.h - where the case wants a piece of bone, and how far it is from there.
//
// Frame: world. Units: SI. Thread: any.
#pragma once

#include "burr/math/pose.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// The planned move of this piece: that whose place lies in the piece, or nearest to it and at most
// 3 mm away. nullptr: the case plans none. piece: as it came free.
[[nodiscard]] const scenario::PlannedPiece* plan_of(const scenario::CaseLesson& lesson,
                                                    const volume::Bone& piece);

struct OffPlan {
  double way = 0, wanted_way = 0;  // of the centre, along the plan's way, and the plan's   [m]
  double off = 0;                  // of the centre, from its place in the plan          [m]
  double turned_off = 0;           // between the two orientations                      [rad]
};
// by, turn: the whole move, about the piece's centre, from where it came free.
[[nodiscard]] OffPlan off_plan(const scenario::PlannedPiece& plan, const math::Vec3& by,
                               const math::Quat& turn);

}  // namespace burr::workshop
