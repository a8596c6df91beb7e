// io/read/read_mesh.h - a mesh of triangles from a file: STL, OBJ or PLY, read by assimp.
//
// Only for the user's own files, since it is not read behind the fence of scans. Units: those of the
// file, which it does not say; millimetres are usual. Equal places are one point. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"

namespace burr::io {

struct TriangleMesh {
  std::vector<math::Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

inline constexpr std::uintmax_t kLargestMesh = 64U << 20;  // [byte]

// Error: one sentence with the file's name.
[[nodiscard]] Result<TriangleMesh> read_mesh(const std::string& path);

}  // namespace burr::io
