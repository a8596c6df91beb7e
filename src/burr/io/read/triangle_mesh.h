// io/read/triangle_mesh.h - a mesh of triangles as a file holds it.
//
// Plain struct. Units: those of the file.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace burr::io {

struct TriangleMesh {
  std::vector<std::array<float, 3>> points;         // finite, no two equal
  std::vector<std::array<std::uint32_t, 3>> faces;  // numbers of points, no two equal in a face
};

// Larger ones are refused before they are read, or as soon as they prove to be.
inline constexpr std::uint64_t kLargestMesh = 64U << 20;        // [byte]
inline constexpr std::size_t kMostTriangles = 2000000;          // of a mesh
inline constexpr std::size_t kMostCorners = std::size_t{4096};  // of one face

}  // namespace burr::io
