// GLB (glTF 2.0): a header, one chunk of JSON, one chunk of numbers. Metres, +Y up.
//
// Written here, because assimp takes 1.4 GB for what is written in one pass here (3 million
// triangles).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "burr/io/write/mesh_formats.h"
#include "burr/math/aabb.h"

namespace burr::io {
namespace {

using Json = nlohmann::ordered_json;

// glTF's vertex colours are linear (glTF 2.0, 3.7.2.1)
std::uint8_t linear(float srgb) {
  srgb = std::min(std::max(srgb, 0.0F), 1.0F);
  const float light = srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
  return static_cast<std::uint8_t>(std::lround(255 * light));
}

// From LPS to left, superior, anterior: a rotation, so that the head is upright and faces the
// viewer.
math::Vec3f upright(const math::Vec3f& lps) { return {lps.x(), lps.z(), -lps.y()}; }

struct Layout {
  std::size_t vertices = 0, indices = 0;
  [[nodiscard]] std::size_t normals_at() const { return 12 * vertices; }
  [[nodiscard]] std::size_t colours_at() const { return 24 * vertices; }
  [[nodiscard]] std::size_t indices_at() const { return 28 * vertices; }
  [[nodiscard]] std::size_t size() const { return indices_at() + 4 * indices; }
};

std::string describe(const MeshOut& out, const Layout& layout) {
  math::Aabb box;
  for (const surface::Vertex& v : out.mesh.vertices) box.extend(upright(v.p).cast<double>());
  constexpr int kFloat = 5126, kByte = 5121, kUnsigned = 5125;  // glTF 2.0, 3.6.2.2
  constexpr int kVertices = 34962, kElements = 34963;
  const auto triple = [](const math::Vec3& v) {
    return Json::array(
        {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  };
  const auto view = [](std::size_t at, std::size_t size, int target) {
    return Json{{"buffer", 0}, {"byteOffset", at}, {"byteLength", size}, {"target", target}};
  };
  Json gltf;
  gltf["asset"] = {{"version", "2.0"}, {"generator", "burr"}};
  gltf["scene"] = 0;
  gltf["scenes"] = Json::array({{{"nodes", {0}}}});
  gltf["nodes"] = Json::array({{{"name", "bone"}, {"mesh", 0}}});
  gltf["materials"] = Json::array(
      {{{"name", "bone"},
        {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}}});
  gltf["meshes"] =
      Json::array({{{"name", "bone"},
                    {"primitives",
                     Json::array({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}}},
                                   {"indices", 3},
                                   {"material", 0}}})}}});
  gltf["buffers"] = Json::array({{{"byteLength", layout.size()}}});
  gltf["bufferViews"] = Json::array({view(0, 12 * layout.vertices, kVertices),
                                     view(layout.normals_at(), 12 * layout.vertices, kVertices),
                                     view(layout.colours_at(), 4 * layout.vertices, kVertices),
                                     view(layout.indices_at(), 4 * layout.indices, kElements)});
  const auto accessor = [](int number, int type, std::size_t count, const char* shape) {
    return Json{{"bufferView", number}, {"componentType", type}, {"count", count}, {"type", shape}};
  };
  Json positions = accessor(0, kFloat, layout.vertices, "VEC3");
  positions["min"] = triple(box.lo);
  positions["max"] = triple(box.hi);
  Json colours = accessor(2, kByte, layout.vertices, "VEC4");
  colours["normalized"] = true;
  gltf["accessors"] = Json::array({positions, accessor(1, kFloat, layout.vertices, "VEC3"), colours,
                                   accessor(3, kUnsigned, layout.indices, "SCALAR")});
  std::string text = gltf.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

}  // namespace

Status write_glb(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  const auto& mesh = out.mesh;
  const Layout layout{mesh.vertices.size(), mesh.triangles.size()};
  const std::string json = describe(out, layout);
  const std::size_t total = 12 + 8 + json.size() + 8 + layout.size();
  if (total > 0xFFFFFFFFULL)
    return error(
        path + ": the mesh is too large for GLB (4 GB at most); use .ply, or a larger `voxel_mm`");
  const auto word = [&](std::size_t value) {
    const auto little = static_cast<std::uint32_t>(value);
    file.write(&little, sizeof little);
  };
  file.write("glTF");
  word(2);
  word(total);
  word(json.size());
  file.write("JSON");
  file.write(json);
  word(layout.size());
  file.write(std::string_view("BIN\0", 4));

  std::size_t done = 0;
  const std::size_t all = 3 * layout.vertices + layout.indices;
  for (const surface::Vertex& v : mesh.vertices) {
    if (!go_on(progress, done++, all)) return stopped_writing(path);
    file.write(upright(v.p).data(), 12);
  }
  for (const surface::Vertex& v : mesh.vertices) {
    if (!go_on(progress, done++, all)) return stopped_writing(path);
    file.write(upright(v.n).data(), 12);
  }
  for (const surface::Vertex& v : mesh.vertices) {
    if (!go_on(progress, done++, all)) return stopped_writing(path);
    const auto& colour = out.tissues[v.tissue].colour;
    const std::uint8_t rgba[4] = {linear(colour[0]), linear(colour[1]), linear(colour[2]), 255};
    file.write(rgba, sizeof rgba);
  }
  file.write(mesh.triangles.data(), 4 * layout.indices);
  return fine();
}

}  // namespace burr::io
