// volume/iso_kernel.h - finding the iso-vertices of one brick, once per instruction set. Plain
// pointers only: no type whose layout depends on the instruction set may pass here.
#pragma once

#include <cstdint>

namespace burr::volume {

// Sixteen vertices, structure of arrays.  position = (value / kVertexScale - 1) voxel from the
// brick's first voxel; normal = value / 32767, out of the bone; rd = value / 65535 voxel, radius of
// the little disc the vertex stands for.
struct alignas(32) VertexBlock {
  std::uint16_t x[16], y[16], z[16];
  std::int16_t nx[16], ny[16], nz[16];
  std::uint16_t rd[16];
};
inline constexpr int kLanes = 16;
inline constexpr float kVertexScale = 7168.0F;

// A brick with its surroundings: voxels -1..9 along each axis, x fastest; rows and columns of 16,
// so that an index is its coordinates side by side (11 of each are used).
inline constexpr int kPadRow = 16, kPadSlice = 16 * kPadRow, kPadEdge = 11,
                     kPadVoxels = kPadSlice * kPadEdge;

// padded: (11 x 16 x 16). low_border: bit 0/1/2 set where the brick lies at the grid's x/y/z = 0
// face: the edges that come in from outside then belong to it too. disc: largest disc radius
// [voxel]. Returns how many vertices were found; at most capacity (a multiple of 16) are written;
// the last block is padded with copies of its last vertex.
using ExtractVertices = int (*)(const std::uint16_t* padded, unsigned low_border, float disc,
                                VertexBlock* out, int capacity) noexcept;

namespace scalar {
int extract_vertices(const std::uint16_t*, unsigned, float, VertexBlock*, int) noexcept;
}
namespace avx2 {
int extract_vertices(const std::uint16_t*, unsigned, float, VertexBlock*, int) noexcept;
}
namespace avx512 {
int extract_vertices(const std::uint16_t*, unsigned, float, VertexBlock*, int) noexcept;
}

[[nodiscard]] ExtractVertices extract_vertices_kernel() noexcept;

}  // namespace burr::volume
