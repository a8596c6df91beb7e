// haptics/least_move.h - the smallest correction of a move that keeps the burr out of the bone: a
// projection in three unknowns.
//
//     p = argmin |p - wanted|^2   subject to   n_j . p >= -gap_j   for all candidates
//
// Exact dual active set: add the most violated plane, project in closed form onto the at most four
// planes of the set, keep the at most three that press, repeat (docs/understand/touch.md, "The
// proxy"; Goldfarb & Idnani 1983 in three unknowns). With gaps >= 0, p = 0 is always allowed, so it
// cannot fail. With gaps < 0 (bone that grew under the burr pushes it out) it may fail; then
// `solved` is false and p is zero.
#pragma once

#include "burr/haptics/scan_kernel.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct LeastMove {
  math::Vec3 p = math::Vec3::Zero();  // the move  [voxel]
  int active = 0;                     // planes it rests on, 0..3
  int index[3] = {-1, -1, -1};        // of these planes in the candidates
  double push[3] = {0, 0, 0};         // multiplier of each: p = wanted + sum push_i n_i  [voxel]
  bool solved = true;                 // false: no solution, p is zero
};

[[nodiscard]] LeastMove least_move(const Candidates& candidates, const math::Vec3& wanted,
                                   MostViolated most_violated) BURR_RT;

}  // namespace burr::haptics
