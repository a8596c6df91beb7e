// haptics/six/six_friction.h - how friction holds a tool of several parts, along the bone and about
// any axis: a cone for each place that presses, all of them at once.
//
// The tool would rest at z* without friction; it was at z* + t a tick ago. Friction holds it at
// z* + f with the f nearest to t that the places in contact can give:
//
//     f = P sum_j T_j^T e_j,   |e_j| <= mu p_j    T_j z: motion along the bone at the place j
//                                                 P: the rows on which it rests take the rest
//
// p_j: how hard that place presses. A rigid face rests on three to six points at its rim, whose
// loads would hold a spun disc like a ring (mu N R); so the load is spread over all places within a
// thin layer, in such a way that force and torque of the sum stay: then it is mu N 2 R / 3.
//
// The set of all f is convex, with the support function h(d) = sum mu p_j |T_j d|. It is replaced by
// the ellipsoid that contains it and touches it in the direction of the slide (the weights
// p_j / |T_j d| make the gradients equal), and the direction is found again, a few times.
//
// Frame: p_grid. Units: voxel; turns times L (move_rows.h). Thread: servo. Memory: none but its own.
// Formulas: docs/understand/touch_tools.md, "Friction of a tool". Source: Goyal, Ruina &
// Papadopoulos 1991 for limit surfaces, from memory.
#pragma once

#include <array>
#include <span>

#include "burr/haptics/six/least_twist.h"
#include "burr/haptics/six/move_rows.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

// What presses, and how it is shared among places.
struct Pressed {
  static constexpr int kMost = 96;
  std::array<Six, kMost> a;          // (n, w x n / L)
  std::array<double, kMost> arm[3];  // w / L
  std::array<double, kMost> share;   // of the layer, then p_j
  int count = 0;
  // The rows on which the tool rests, square to each other and of length one: they take whatever of
  // the friction would tilt it or lift it off.
  std::array<Six, 6> row;
  int rows = 0;
};

void rest_on(std::span<const Six> rows, Pressed& pressed) BURR_RT;

struct Friction {
  double sticks = 0;  // mu while it sticks  [-]
  double slides = 0;  // while it slides
};

// The places of `points` (RowKernel::press within `layer`) and how the load `pushed` = sum of
// push_j a_j is shared among them; load: sum of the pushes.
void share_load(const Rows& points, double layer, const Six& pushed, double load,
                Pressed& pressed) BURR_RT;

struct Grip {
  Six f = {};          // what friction holds, seen from z*
  Six way = {};        // of the slide, in which the ellipsoid touches the set; of any length
  bool whole = true;   // f is all of t that lies along the bone
  bool stuck = false;  // and sticks: it will slide only beyond the cone of sticking
};

// towards: t. before: of the last tick; {} where the tool touched nothing then.
[[nodiscard]] Grip hold(const Pressed& pressed, const Friction& friction, const Six& towards,
                        const Grip& before) BURR_RT;

}  // namespace burr::haptics
