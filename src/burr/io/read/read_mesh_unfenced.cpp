// Chooses the reader of a mesh by the name's ending, as its three formats do not all begin alike.
#include <fmt/core.h>

#include <string>
#include <vector>

#include "burr/io/read/bytes.h"
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/text.h"

namespace burr::io {

Result<TriangleMesh> read_mesh_unfenced(const std::filesystem::path& path) {
  const std::string name = short_name(path), kind = lower(path.extension().string());
  const auto read = kind == ".stl"   ? read_stl
                    : kind == ".obj" ? read_obj
                    : kind == ".ply" ? read_ply
                                     : nullptr;
  if (read == nullptr)
    return error(fmt::format("{}: burr reads meshes as STL, OBJ or PLY; convert it", name));
  auto file = open_file(path);
  if (!file) return file.error();
  if (file->size > kLargestMesh)
    return error(fmt::format(
        "{}: the mesh has {} MB, burr reads up to {} MB; simplify it with another program", name,
        file->size >> 20, kLargestMesh >> 20));
  std::string bytes(static_cast<std::size_t>(file->size), '\0');
  if (Status status = read_exactly(*file->source, bytes.data(), bytes.size()); !status)
    return error(Trouble::io, fmt::format("{}: {}", name, status.error().text));
  const auto mesh = read(bytes);
  if (!mesh) return error(mesh.error().trouble, fmt::format("{}: {}", name, mesh.error().text));
  if (mesh->faces.empty()) return error(fmt::format("{}: the mesh has no triangles", name));
  return mesh;
}

}  // namespace burr::io
