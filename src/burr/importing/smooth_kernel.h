// importing/smooth_kernel.h - smooths eight grey values of a row along the surface that they lie
// near. Compiled once per instruction set, chosen at run time. Plain pointers only. Internal to
// importing.
//
// Units: grey values as stored, lengths in finest spacings. Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>

namespace burr::importing {

// A neighbour of a voxel.
struct SmoothNeighbour {
  std::ptrdiff_t move;  // from the voxel to it, in the array
  float weight, x, y, z;
};

// All neighbours, and what is computed from them once.
struct SmoothRule {
  const SmoothNeighbour* neighbours = nullptr;
  int count = 0;
  float moment_x = 0, moment_y = 0, moment_z = 0;  // sums of weight x x^2, and so on
  float range = 0;  // how fast the weight falls with the square of a difference in grey
};

// Writes the first `lanes` of the eight smoothed values at `at` to `out`. For each lane, all
// neighbours of `at` must be readable. The lanes never mix, so the bits are the same on every
// instruction set.
using SmoothEight = void (*)(const std::int16_t* at, const SmoothRule& rule, int lanes,
                             std::int16_t* out) noexcept;

namespace scalar {
void smooth_eight(const std::int16_t*, const SmoothRule&, int, std::int16_t*) noexcept;
}
namespace avx2 {
void smooth_eight(const std::int16_t*, const SmoothRule&, int, std::int16_t*) noexcept;
}

}  // namespace burr::importing
