// io/read/read_mesh.h - a mesh of triangles from a file: STL, OBJ or PLY.
//
// It is read behind the fence of scans (io/sandbox/fence.h), in a process of its own with limits on
// memory and time, so that a damaged or hostile file is a sentence. Units: those of the file, which
// it does not say; millimetres are usual. Equal places are one point, a face of more corners becomes
// triangles. Thread: any but the tick.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "burr/io/read/triangle_mesh.h"

namespace burr::io {

// Error: one sentence with the file's name.
[[nodiscard]] Result<TriangleMesh> read_mesh(const std::string& path);

}  // namespace burr::io
