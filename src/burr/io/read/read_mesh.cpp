#include "burr/io/read/read_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/core.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>
#include <tuple>

#include "burr/base/printable.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;
using math::Vec3;

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.empty() ? text : text.substr(1);
}

Result<std::string> bytes_of(const fs::path& path, const std::string& name) {
  std::error_code wrong;
  const std::uintmax_t size = fs::file_size(path, wrong);
  if (wrong)
    return error(Trouble::io,
                 fmt::format("{}: the file cannot be read ({})", name, wrong.message()));
  if (size > kLargestMesh)
    return error(fmt::format(
        "{}: the mesh has {} MB, burr reads up to {} MB; simplify it with another program", name,
        size >> 20, kLargestMesh >> 20));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    return error(Trouble::io, fmt::format("{}: the file cannot be read", name));
  return bytes;
}

// Nothing: a place that is not a number.
std::optional<TriangleMesh> joined(const aiScene& scene) {
  TriangleMesh out;
  std::map<std::tuple<float, float, float>, std::uint32_t> known;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines hold no volume
      std::array<std::uint32_t, 3> corners;
      for (unsigned n = 0; n < 3; ++n) {
        const aiVector3D& p = mesh.mVertices[face.mIndices[n]];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return std::nullopt;
        const auto next = static_cast<std::uint32_t>(out.points.size());
        const auto [at, is_new] = known.try_emplace({p.x, p.y, p.z}, next);
        if (is_new) out.points.emplace_back(p.x, p.y, p.z);
        corners[n] = at->second;
      }
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        out.faces.push_back(corners);
    }
  }
  return out;
}

}  // namespace

Result<TriangleMesh> read_mesh(const std::string& path) {
  const std::string name = base::printable(fs::path(path).filename().string());
  const std::string kind = ending(path);
  if (kind != "stl" && kind != "obj" && kind != "ply")
    return error(fmt::format("{}: burr reads meshes as STL, OBJ or PLY; convert it", name));
  const auto bytes = bytes_of(path, name);
  if (!bytes) return bytes.error();
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_COLORS | aiComponent_TEXCOORDS |
                                  aiComponent_MATERIALS | aiComponent_TEXTURES);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes->data(), bytes->size(),
      aiProcess_Triangulate | aiProcess_RemoveComponent | aiProcess_PreTransformVertices,
      kind.c_str());
  if (scene == nullptr)
    return error(fmt::format("{}: this is no {} mesh ({})", name, kind,
                             base::printable(importer.GetErrorString())));
  std::optional<TriangleMesh> mesh = joined(*scene);
  if (!mesh) return error(fmt::format("{}: the mesh has a point that is not a number", name));
  if (mesh->faces.empty()) return error(fmt::format("{}: the mesh has no triangles", name));
  return *std::move(mesh);
}

}  // namespace burr::io
