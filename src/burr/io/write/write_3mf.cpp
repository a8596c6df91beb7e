// 3MF: a zip of three small XML parts (3MF Core Specification 1.3, ECMA-376 part 2 for the zip).
//
// Written here, because the 3MF exporter of Debian's assimp 5.2 prints six digits, which merges
// vertices that lie close together and tears the mesh.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstring>
#include <iterator>

#include "burr/base/markup.h"
#include "burr/io/write/deflate.h"
#include "burr/io/write/mesh_formats.h"
#include "burr/io/write/zip.h"

namespace burr::io {
namespace {

constexpr const char* kTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
constexpr const char* kRelations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";

bool write_model(const MeshOut& out, Deflate& to, Progress& progress) {
  const auto& mesh = out.mesh;
  fmt::memory_buffer text;
  const auto flush = [&](std::size_t above) {
    if (text.size() <= above) return;
    to.write(text.data(), text.size());
    text.clear();
  };
  const auto add = std::back_inserter(text);
  fmt::format_to(add,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                 "<model unit=\"millimeter\" xml:lang=\"en-US\" "
                 "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
                 "<metadata name=\"Application\">burr</metadata>\n"
                 "<metadata name=\"Description\">{}</metadata>\n"
                 "<resources>\n<basematerials id=\"1\">\n",
                 out.mark()[0] != '\0' ? out.mark() : "standing on the bed");
  for (const volume::Tissue& tissue : out.tissues.tissues) {
    const auto colour = bytes_of(tissue.colour);
    fmt::format_to(add, "<base name=\"{}\" displaycolor=\"#{:02X}{:02X}{:02X}\"/>\n",
                   base::markup_text(tissue.name), colour[0], colour[1], colour[2]);
  }
  const auto material = [&](std::uint32_t vertex) -> unsigned {
    const unsigned id = mesh.vertices[vertex].tissue;
    return id < out.tissues.tissues.size() ? id : 0;
  };
  const unsigned usual = material(mesh.triangles[0]);
  fmt::format_to(add,
                 "</basematerials>\n<object id=\"2\" type=\"model\" pid=\"1\" pindex=\"{}\">\n"
                 "<mesh>\n<vertices>\n",
                 usual);
  const std::size_t count = mesh.triangles.size() / 3;
  for (std::size_t v = 0; v < out.p_mm.size(); ++v) {
    if (!go_on(progress, v, out.p_mm.size() + count)) return false;
    const math::Vec3f& p = out.p_mm[v];
    fmt::format_to(add, FMT_COMPILE("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n"), p.x(), p.y(), p.z());
    flush(1U << 16);
  }
  fmt::format_to(add, "</vertices>\n<triangles>\n");
  for (std::size_t t = 0; t < count; ++t) {
    if (!go_on(progress, t, count)) return false;
    const std::uint32_t* v = &mesh.triangles[3 * t];
    const unsigned tissue = material(v[0]);
    fmt::format_to(add, FMT_COMPILE("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\""), v[0], v[1], v[2]);
    if (tissue != usual) fmt::format_to(add, FMT_COMPILE(" pid=\"1\" p1=\"{}\""), tissue);
    fmt::format_to(add, "/>\n");
    flush(1U << 16);
  }
  fmt::format_to(add,
                 "</triangles>\n</mesh>\n</object>\n</resources>\n"
                 "<build><item objectid=\"2\"/></build>\n</model>\n");
  flush(0);
  return true;
}

}  // namespace

Status write_3mf(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  Zip zip(file);
  const auto text = [](const char* all) {
    return [all](Deflate& to) {
      to.write(all, std::strlen(all));
      return true;
    };
  };
  const bool done =
      zip.add("[Content_Types].xml", text(kTypes)) && zip.add("_rels/.rels", text(kRelations)) &&
      zip.add("3D/3dmodel.model", [&](Deflate& to) { return write_model(out, to, progress); });
  if (!done) return stopped_writing(path);
  if (!zip.finish())
    return error(
        path + ": the mesh is too large for 3MF (4 GB at most); use .stl, or a larger `voxel_mm`");
  return fine();
}

}  // namespace burr::io
