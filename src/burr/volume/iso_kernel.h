// volume/iso_kernel.h - finds the iso-vertices of one brick; compiled once per instruction set.
// Plain pointers only: a type whose layout depends on the instruction set must not be passed here.
#pragma once

#include <cstdint>

namespace burr::volume {

// Sixteen vertices as a structure of arrays. Position = (value / kVertexScale - 1) voxel from the
// brick's first voxel; normal = value / 32767, pointing out of the bone; rd = value / 65535 voxel,
// the radius of the small disc that represents the surface at the vertex.
struct alignas(32) VertexBlock {
  std::uint16_t x[16], y[16], z[16];
  std::int16_t nx[16], ny[16], nz[16];
  std::uint16_t rd[16];
};
inline constexpr int kLanes = 16;
inline constexpr float kVertexScale = 7168.0F;

// A brick with its surroundings: voxels -1..9 along each axis, x fastest. Rows and columns have 16
// entries, of which 11 are used, so that an index is made by putting the coordinates' bits side by
// side.
inline constexpr int kPadRow = 16, kPadSlice = 16 * kPadRow, kPadEdge = 11,
                     kPadVoxels = kPadSlice * kPadEdge;

// padded: (11 x 16 x 16). low_border: bit 0/1/2 is set if the brick lies at the x/y/z = 0 face of
// the grid; it then owns the edges that come in from outside as well. disc: largest disc radius
// [voxel]. Returns the number of vertices found; at most `capacity` (a multiple of 16) are written.
// The last block is filled up with copies of its last vertex.
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
