// haptics/scan_kernel.h - finds the small discs of bone near the burr; compiled once per
// instruction set. Plain pointers only.
#pragma once

#include <cstdint>

#include "burr/volume/iso_kernel.h"

namespace burr::haptics {

// The planes that the proxy may rest on: n . p >= -gap for its next move p, measured from its
// present place. [voxel]
struct Candidates {
  static constexpr int kMost = 16384;
  alignas(64) float nx[kMost + 16], ny[kMost + 16],
      nz[kMost + 16];                 // unit, from the disc to the burr's centre
  alignas(64) float gap[kMost + 16];  // distance to the disc minus the radius
  int count = 0;
  bool full = false;
};

// A block of discs near the burr, and the first voxel of its brick.
struct NearBlock {
  const volume::VertexBlock* block = nullptr;
  std::int32_t x = 0, y = 0, z = 0;
  std::int32_t count = 0;  // discs in it, at most volume::kLanes
};

// Discs near the burr, copied out of their blocks, relative to the centre of the search. [voxel]
struct NearDiscs {
  static constexpr int kMost = 8192;
  alignas(64) float x[kMost + 16], y[kMost + 16], z[kMost + 16];     // centre of the disc
  alignas(64) float mx[kMost + 16], my[kMost + 16], mz[kMost + 16];  // its normal, unit
  alignas(64) float rd[kMost + 16];                                  // its radius
  int count = 0;
};

// Finds the blocks of a brick that have a disc with its centre nearer than `reach` to the burr's
// centre. count: discs of the brick. out: receives the blocks; must have room for all of them.
// Returns how many were found. brick: its first voxel. centre: p_grid.
using FindNear = int (*)(const volume::VertexBlock* blocks, int count, const std::int32_t brick[3],
                         const double centre[3], float reach, NearBlock* out) noexcept;

// Copies the discs of `count` near blocks whose centre is nearer than `reach` to `centre`. False:
// there are more than fit.
using TakeDiscs = bool (*)(const NearBlock* near, int count, const double centre[3], float reach,
                           NearDiscs& out) noexcept;

// Like ScanBlocks, for discs that were taken. offset: the burr's centre minus the centre at which
// they were taken.
using ScanDiscs = void (*)(const NearDiscs& near, const float offset[3], float radius, float within,
                           float disc, Candidates& out) noexcept;

// Appends to `out` the discs of `count` near blocks with gap < within. disc: upper bound of the
// disc radii [voxel]; radius: of the burr [voxel].
using ScanBlocks = void (*)(const NearBlock* near, int count, const double centre[3], float radius,
                            float within, float disc, Candidates& out) noexcept;

// Index of the candidate that the move p violates most, or -1. `worst` is n . p + gap there,
// negative. Of equal ones the first.
using MostViolated = int (*)(const Candidates& all, const float p[3], float& worst) noexcept;

// What a soft layer on the discs does to a burr moved by p: sums over the candidates with s_j > 0,
// s_j = layer - gap_j - n_j . p.
struct SoftSums {
  double squares = 0;    // sum s^2                                          [voxel^2]
  double total = 0;      // sum s                                            [voxel]
  double push[3] = {};   // sum s n                                          [voxel]
  double stiff[6] = {};  // sum n n^T: xx xy xz yy yz zz                     [-]
};
using SoftPush = void (*)(const Candidates& all, const float p[3], float layer,
                          SoftSums& sums) noexcept;

struct ScanKernel {
  FindNear find_near;
  ScanBlocks scan;
  TakeDiscs take;
  ScanDiscs scan_discs;
  MostViolated most_violated;
  SoftPush soft_push;
};

#define BURR_SCAN_KERNEL(which)                                                               \
  namespace which {                                                                           \
  int find_near(const volume::VertexBlock*, int, const std::int32_t*, const double*, float,   \
                NearBlock*) noexcept;                                                         \
  void scan_blocks(const NearBlock*, int, const double*, float, float, float,                 \
                   Candidates&) noexcept;                                                     \
  bool take_discs(const NearBlock*, int, const double*, float, NearDiscs&) noexcept;          \
  void scan_discs(const NearDiscs&, const float*, float, float, float, Candidates&) noexcept; \
  int most_violated(const Candidates&, const float*, float&) noexcept;                        \
  void soft_push(const Candidates&, const float*, float, SoftSums&) noexcept;                 \
  }
BURR_SCAN_KERNEL(scalar)
BURR_SCAN_KERNEL(avx2)
BURR_SCAN_KERNEL(avx512)
#undef BURR_SCAN_KERNEL

[[nodiscard]] ScanKernel scan_kernel() noexcept;

}  // namespace burr::haptics
