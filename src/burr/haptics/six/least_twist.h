// haptics/six/least_twist.h - the smallest correction of a move and a turn that keeps a tool off the
// bone: a projection in six unknowns.
//
//     z = argmin |z - wanted|^2   subject to   a_j . z >= -gap_j      a_j = (n_j, m_j) of move_rows.h
//
// Dual active set (Goldfarb & Idnani 1983) with the identity for a Hessian: start at `wanted`; take
// the row that z violates most; go along its part that is square to the rows in hand until it holds
// or one of them would have to pull; drop that one. At most six rows are in hand, their Gram matrix
// is solved anew each time. Equal violations: the first row. With gaps >= 0, z = 0 is allowed, so it
// cannot fail; with gaps < 0 it may, then `solved` is false and z is zero.
//
// Thread: servo. Units: as move_rows.h. Memory: none.
#pragma once

#include <array>

#include "burr/haptics/six/move_rows.h"
#include "burr/haptics/six/row_kernel.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

using Six = std::array<double, 6>;  // (move, L turn)  [voxel]

struct LeastTwist {
  Six z = {};
  int active = 0;       // rows it rests on
  int index[6] = {};    // of these rows
  double push[6] = {};  // multiplier of each, > 0: z = wanted + sum push_i a_i  [voxel]
  bool solved = true;
};

[[nodiscard]] LeastTwist least_twist(const Rows& rows, const Six& wanted, WorstRow worst) BURR_RT;

[[nodiscard]] inline double dot6(const Six& a, const Six& b) BURR_RT {
  return ((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) + ((a[3] * b[3] + a[4] * b[4]) + a[5] * b[5]);
}

}  // namespace burr::haptics
