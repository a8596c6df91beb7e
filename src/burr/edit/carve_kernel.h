// edit/carve_kernel.h - what a ball removes from, or adds to, one brick; compiled once per
// instruction set. Plain pointers only. Integers throughout: sums are exact in any order.
#pragma once

#include <cstdint>

namespace burr::edit {

// How far each voxel of a brick is above the value that the ball leaves (carve), or below the value
// that it fills up to (deposit).
struct Excess {
  std::int64_t units = 0;   // approximate volume of all of it, volume_of.h units
  std::int32_t most = 0;    // largest of one voxel  [field units]
  std::uint32_t pairs = 0;  // bit y / 2 + 4 z: this pair of rows has some
};
// ball: the brick's first voxel minus the ball's centre [voxel], and the ball's radius [voxel].
// keep_out: a second ball in the same frame that deposit must not fill; radius < 0: none. deposit:
// 0 carve, 1 fill. out: (8 x 8 x 8) excess; only the pairs of rows in Excess::pairs are written.
using FindExcess = Excess (*)(const std::uint16_t* field, const float ball[4],
                              const float keep_out[4], int deposit, std::uint16_t* out) noexcept;

struct Applied {
  std::int64_t units = 0;     // volume removed (carve) or added (deposit)
  std::int32_t most = 0;      // largest change of one voxel
  std::uint64_t rows = 0;     // bit y + 8 z: something changed in that row
  std::uint32_t columns = 0;  // bit x
  std::int32_t highest = 0;   // largest field value left in the brick
};
// Writes field minus (deposit: plus) share/65536 of the excess to `to`. share: 0..65536. pairs: as
// found.
using ApplyExcess = Applied (*)(const std::uint16_t* field, const std::uint16_t* excess,
                                std::uint32_t pairs, std::int32_t share, int deposit,
                                std::uint16_t* to) noexcept;

struct CarveKernel {
  FindExcess find;
  ApplyExcess apply;
};

#define BURR_CARVE_KERNEL(which)                                                                \
  namespace which {                                                                             \
  Excess find_excess(const std::uint16_t*, const float*, const float*, int,                     \
                     std::uint16_t*) noexcept;                                                  \
  Applied apply_excess(const std::uint16_t*, const std::uint16_t*, std::uint32_t, std::int32_t, \
                       int, std::uint16_t*) noexcept;                                           \
  }
BURR_CARVE_KERNEL(scalar)
BURR_CARVE_KERNEL(avx2)
BURR_CARVE_KERNEL(avx512)
#undef BURR_CARVE_KERNEL

[[nodiscard]] CarveKernel carve_kernel() noexcept;

}  // namespace burr::edit
