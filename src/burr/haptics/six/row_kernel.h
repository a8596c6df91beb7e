// haptics/six/row_kernel.h - finds the points of bone near a part of a tool and makes rows of them;
// compiled once per instruction set. Plain pointers only.
//
// A ball touches the small discs of volume/iso_vertices.h, as the proxy of three unknowns does:
// for it their distance has a closed form. Every other shape touches the points in their middles.
// A sharp edge would sink between the points and hop from one to the next. So a part with `planes`
// also touches the planes of the discs: with n from the point q to the part, phi their distance, rho
// the part's rounding and P = q + (phi + rho) n the nearest place of its core, the place P - rho m
// stays above the plane through q with the normal m, as far as the disc is clean (its radius) and
// faces the part. The point itself may then be up to kSlack deep.
#pragma once

#include <cstdint>

#include "burr/haptics/six/move_rows.h"
#include "burr/tool/shape_kind.h"
#include "burr/volume/iso_kernel.h"

namespace burr::haptics {

// A part at a pose of the tool. Frame: p_grid, seen from the coupling point c. [voxel]
struct PartThere {
  tool::Shape shape;             // [voxel]
  float part_from_grid[9] = {};  // rotation, by rows
  float offset[3] = {};          // place in the part = part_from_grid * w + offset
  float ball[3] = {};            // a ball's centre minus c
  bool planes = false;
};

// What a scan looks for: rows with gap < p + t |w|.
struct RowBounds {
  float p = 0;          // the move's greatest length                       [voxel]
  float t = 0;          // its greatest turn                                  [rad]
  float inverse_L = 0;  // 1 / L                                        [1 / voxel]
  float most = 0;       // at least p + t |w| of every point                  [voxel]
  // Only where the part has planes: how much farther away points are whose planes are looked at
  // [voxel], and 1 / radius of a clean disc [1 / voxel].
  float beyond = 0, inverse_disc = 0;
};

// Appends the points of a brick that are nearer than `reach` to the part. brick: its first voxel;
// centre: p_grid, what the points are stored relative to; c: the coupling point minus the centre.
// False: no room.
using TakePoints = bool (*)(const volume::VertexBlock* blocks, int count,
                            const std::int32_t brick[3], const double centre[3], const float c[3],
                            const PartThere& part, float reach, NearPoints& out) noexcept;

// Appends the rows of a part; rows.full if there is no room. c: as above.
using MakeRows = void (*)(NearPoints& near, const float c[3], const PartThere& part,
                          const RowBounds& bounds, Rows& rows) noexcept;

// Appends the places of a part that are nearer to the bone than bounds.p; m is then the place itself,
// seen from c, times bounds.inverse_L: what friction needs. Points only, no planes.
using PressPoints = MakeRows;

// Index of the row that the move z = (p, t) violates most, or -1; `worst` is its value there, below
// 0. Of equal ones the first.
using WorstRow = int (*)(const Rows& rows, const float z[6], float& worst) noexcept;

struct RowKernel {
  TakePoints take;
  MakeRows make;
  PressPoints press;
  WorstRow worst;
};

#define BURR_ROW_KERNEL(which)                                                                   \
  namespace which {                                                                              \
  bool take_points(const volume::VertexBlock*, int, const std::int32_t*, const double*,          \
                   const float*, const PartThere&, float, NearPoints&) noexcept;                 \
  void make_rows(NearPoints&, const float*, const PartThere&, const RowBounds&, Rows&) noexcept; \
  void press_points(NearPoints&, const float*, const PartThere&, const RowBounds&,               \
                    Rows&) noexcept;                                                             \
  int worst_row(const Rows&, const float*, float&) noexcept;                                     \
  }
BURR_ROW_KERNEL(scalar)
BURR_ROW_KERNEL(avx2)
BURR_ROW_KERNEL(avx512)
#undef BURR_ROW_KERNEL

[[nodiscard]] RowKernel row_kernel() noexcept;

}  // namespace burr::haptics
