// 3MF: a zip of three small XML parts (3MF Core Specification 1.3, ECMA-376 part 2 for the zip).
//
// Written here, because the 3MF exporter of Debian's assimp 5.2 prints six digits, which merges
// vertices that lie close together and tears the mesh.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstring>
#include <iterator>
#include <vector>

#include "burr/base/markup.h"
#include "burr/io/write/deflate.h"
#include "burr/io/write/mesh_formats.h"

namespace burr::io {
namespace {

// One zip, entries one after another; without times, so that the same mesh gives the same file.
class Zip {
 public:
  explicit Zip(base::NewFile& file) : file_(file) {}

  template <class Fill>
  bool add(const std::string& name, Fill&& fill) {  // fill(Deflate&): false to stop
    Entry entry{name, file_.size(), 0, 0, 0};
    write_header(entry, 0x04034b50U);
    file_.write(name);
    const std::size_t start = file_.size();
    Deflate deflate(file_, Deflate::Kind::bare, 6);
    if (!fill(deflate)) return false;
    deflate.finish();
    entry.crc = deflate.crc32();
    entry.packed = file_.size() - start;
    entry.size = deflate.bytes_in();
    // crc and sizes stand before the data but are known only after it
    const std::uint32_t known[3] = {entry.crc, static_cast<std::uint32_t>(entry.packed),
                                    static_cast<std::uint32_t>(entry.size)};
    file_.write_at(entry.offset + 14, known, sizeof known);
    entries_.push_back(entry);
    return true;
  }

  // False: larger than a zip without the 64-bit extension can be.
  bool finish() {
    const std::size_t start = file_.size();
    bool fits = start < kLimit;
    for (const Entry& entry : entries_) {
      fits = fits && entry.size < kLimit && entry.packed < kLimit;
      write_header(entry, 0x02014b50U);
      file_.write(entry.name);
    }
    Bytes end;
    end.u32(0x06054b50U).u16(0).u16(0);
    end.u16(entries_.size()).u16(entries_.size());
    end.u32(file_.size() - start).u32(start).u16(0);
    file_.write(end.bytes.data(), end.bytes.size());
    return fits;
  }

 private:
  static constexpr std::size_t kLimit = 0xFFFFFFFFULL;
  struct Entry {
    std::string name;
    std::size_t offset = 0;
    std::uint32_t crc = 0;
    std::size_t packed = 0, size = 0;
  };
  struct Bytes {
    std::string bytes;
    Bytes& u16(std::size_t value) { return append(value, 2); }
    Bytes& u32(std::size_t value) { return append(value, 4); }
    Bytes& append(std::size_t value, int count) {
      for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFFU);
      return *this;
    }
  };

  // The local and the central header have the middle part in common.
  void write_header(const Entry& entry, std::uint32_t signature) {
    const bool central = signature == 0x02014b50U;
    constexpr std::size_t kVersion = 20, kDeflated = 8, kFirstDay = 0x21;  // 1980-01-01
    Bytes h;
    h.u32(signature);
    if (central) h.u16(kVersion);
    h.u16(kVersion).u16(0).u16(kDeflated).u16(0).u16(kFirstDay);
    h.u32(entry.crc).u32(entry.packed).u32(entry.size).u16(entry.name.size()).u16(0);
    if (central) h.u16(0).u16(0).u16(0).u32(0).u32(entry.offset);
    file_.write(h.bytes.data(), h.bytes.size());
  }

  base::NewFile& file_;
  std::vector<Entry> entries_;
};

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
        path + ": the mesh is too large for 3MF (4 GB at most); use .stl, or a larger --voxel-mm");
  return fine();
}

}  // namespace burr::io
