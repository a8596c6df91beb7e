// metrics/smoothness.h - how smooth a move is, by the two measures that do not depend on its size
// (Balasubramanian, Melendez-Calderon, Roby-Brami & Burdet 2015).
//
//     SPARC = - integral from 0 to wc of sqrt((1/wc)^2 + (dV/dw)^2) dw
//             V: amplitude spectrum of the speed over its value at 0, zero-padded 16 times;
//             wc: the last w below 2 pi 20 Hz with V >= 0.05
//     LDLJ  = - ln( T^3 / v_peak^2 * integral of (d2v/dt2)^2 dt )
//
// Nearer to zero is smoother. Known: a move of minimum jerk has SPARC -1.40 and LDLJ
// -ln(720 / 1.875^2) = -5.32. Only free moves count: without contact, longer than 10 mm, 0.2 to 3 s,
// from standstill to standstill (speed below 5 % of the peak).
// Units: SI. Thread: any.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "burr/metrics/measured.h"
#include "burr/metrics/track.h"

namespace burr::metrics {

// speed: at equal steps. None: fewer than 4 values, one that is not finite, no motion at all; for
// LDLJ also no change of speed, which no hand can do.
[[nodiscard]] std::optional<double> sparc(std::span<const double> speed, double rate);
[[nodiscard]] std::optional<double> ldlj(std::span<const double> speed, double rate);

struct Move {
  double begin = 0, end = 0;  // [s]
  double chord = 0;           // [m]
  double sparc = 0, ldlj = 0;
};
// Those for which both measures exist.
[[nodiscard]] std::vector<Move> moves_of(const Track& track);

struct Smoothness {
  std::size_t moves = 0;
  double sparc = 0, ldlj = 0;  // medians
};
// Not assessable: fewer than 5 moves.
[[nodiscard]] Assessed<Smoothness> smoothness_of(std::span<const Move> moves);

}  // namespace burr::metrics
