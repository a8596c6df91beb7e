// haptics/scan_kernel.h - which little discs of bone are near the burr, once per instruction set.
// Plain pointers only.
#pragma once

#include <cstdint>

#include "burr/volume/iso_kernel.h"

namespace burr::haptics {

// What the proxy may rest on: planes n . p >= -gap for its next move p, seen from where it is now.
// [voxel]
struct Candidates {
  static constexpr int kMost = 16384;
  alignas(64) float nx[kMost + 16], ny[kMost + 16],
      nz[kMost + 16];                 // unit, from the disc to the burr's centre
  alignas(64) float gap[kMost + 16];  // distance to the disc less the radius
  int count = 0;
  bool full = false;
};

// Appends the discs of `blocks` (count vertices) with gap < within. offset: brick's first voxel
// less the burr's centre [voxel]; radius of the burr [voxel].
using ScanBlocks = void (*)(const volume::VertexBlock* blocks, int count, const float offset[3],
                            float radius, float within, Candidates& out) noexcept;

// Index of the candidate that move p violates most, or -1; `worst` is then n . p + gap there,
// negative. First one on ties.
using MostViolated = int (*)(const Candidates& all, const float p[3], float& worst) noexcept;

struct ScanKernel {
  ScanBlocks scan;
  MostViolated most_violated;
};

namespace scalar {
void scan_blocks(const volume::VertexBlock*, int, const float*, float, float, Candidates&) noexcept;
int most_violated(const Candidates&, const float*, float&) noexcept;
}  // namespace scalar
namespace avx2 {
void scan_blocks(const volume::VertexBlock*, int, const float*, float, float, Candidates&) noexcept;
int most_violated(const Candidates&, const float*, float&) noexcept;
}  // namespace avx2
namespace avx512 {
void scan_blocks(const volume::VertexBlock*, int, const float*, float, float, Candidates&) noexcept;
int most_violated(const Candidates&, const float*, float&) noexcept;
}  // namespace avx512

[[nodiscard]] ScanKernel scan_kernel() noexcept;

}  // namespace burr::haptics
