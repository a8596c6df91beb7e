// io/read/mesh_readers.h - one reader per format of meshes; read_mesh_unfenced() chooses. They are part of
// `burr-read`, behind the fence, and not of libburr. For use of this room only.
//
// Each takes the whole file. Errors: what is wrong, without the file's name: "line 7: ...".
#pragma once

#include <filesystem>
#include <string_view>

#include "burr/base/result.h"
#include "burr/io/read/triangle_mesh.h"

namespace burr::io {

// Reads without the fence, in this process: for burr-read and for the fuzzer.
[[nodiscard]] Result<TriangleMesh> read_mesh_unfenced(const std::filesystem::path& path);

[[nodiscard]] Result<TriangleMesh> read_stl(std::string_view bytes);
[[nodiscard]] Result<TriangleMesh> read_obj(std::string_view bytes);
[[nodiscard]] Result<TriangleMesh> read_ply(std::string_view bytes);

}  // namespace burr::io
