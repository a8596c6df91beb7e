// edit/shape_kernel.h - what the cutting parts of a tool remove from one brick; compiled once per
// instruction set. The share of it is applied by carve_kernel.h.
#pragma once

#include <cstdint>

#include "burr/edit/carve_kernel.h"
#include "burr/tool/shape_kind.h"

namespace burr::edit {

inline constexpr int kMostKernelParts = 6;  // tool::Tool::kMostParts

struct KernelPart {
  tool::Shape shape;      // [voxel]
  float from_grid[3][3];  // rows: the part's x, y, z along the grid's axes; image: reflected
  float offset[3];  // the brick's first voxel minus the part's origin, along the grid  [voxel]
  float full = 0;   // distance to the part's z axis at which the weight is 1; 0: always 1
  float least_weight = 1;  // [-]
};

// margin: by how much the parts are larger [voxel]. out: (8 x 8 x 8) excess; only the pairs of rows
// in Excess::pairs are written.
using FindUnderParts = Excess (*)(const std::uint16_t* field, const KernelPart* parts, int count,
                                  float margin, std::uint16_t* out) noexcept;
struct ShapeKernel {
  FindUnderParts find;
};

#define BURR_SHAPE_KERNEL(which)                                               \
  namespace which {                                                            \
  Excess find_under_parts(const std::uint16_t*, const KernelPart*, int, float, \
                          std::uint16_t*) noexcept;                            \
  }
BURR_SHAPE_KERNEL(scalar)
BURR_SHAPE_KERNEL(avx2)
BURR_SHAPE_KERNEL(avx512)
#undef BURR_SHAPE_KERNEL

[[nodiscard]] ShapeKernel shape_kernel() noexcept;

}  // namespace burr::edit
