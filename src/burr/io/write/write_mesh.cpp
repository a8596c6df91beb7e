#include "burr/io/write/write_mesh.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iterator>

#include "burr/io/write/mesh_formats.h"
#include "burr/math/aabb.h"

namespace burr::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary formats are written as is");

std::string ending_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

using Writer = Status (*)(const MeshOut&, base::NewFile&, const std::string&, Progress&);
Writer writer_of(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == ".stl") return write_stl;
  if (ending == ".ply") return write_ply;
  if (ending == ".obj") return write_obj;
  if (ending == ".3mf") return write_3mf;
  if (ending == ".glb") return write_glb;
  return nullptr;
}

// Appends the bytes of a value.
template <class T>
char* put(char* to, const T& value) {
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}
char* put(char* to, const math::Vec3f& v) { return put(put(put(to, v.x()), v.y()), v.z()); }

MeshOut placed(const surface::Mesh& mesh, const volume::TissueTable& tissues, Frame frame) {
  MeshOut out{mesh, tissues, {}, Eigen::Matrix3f::Identity(), frame};
  math::Vec3 shift_mm = math::Vec3::Zero();
  if (frame == Frame::ras) out.turn.diagonal() << -1, -1, 1;
  if (frame == Frame::print) {
    math::Aabb box;
    for (const surface::Vertex& v : mesh.vertices) box.extend(v.p.cast<double>());
    if (!box.empty()) shift_mm = -1e3 * math::Vec3(box.centre().x(), box.centre().y(), box.lo.z());
  }
  out.p_mm.reserve(mesh.vertices.size());
  const math::Mat3 turn = out.turn.cast<double>();
  for (const surface::Vertex& v : mesh.vertices)
    out.p_mm.emplace_back((turn * (1e3 * v.p.cast<double>()) + shift_mm).cast<float>());
  return out;
}

}  // namespace

std::array<std::uint8_t, 3> bytes_of(const std::array<float, 3>& colour) {
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t c = 0; c < 3; ++c)
    bytes[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(colour[c], 0.0F, 1.0F)));
  return bytes;
}

std::array<std::uint8_t, 3> MeshOut::colour(std::size_t vertex) const {
  return bytes_of(tissues[mesh.vertices[vertex].tissue].colour);
}

const char* MeshOut::mark() const {
  return frame == Frame::lps ? "SPACE=LPS" : frame == Frame::ras ? "SPACE=RAS" : "";
}

bool go_on(Progress& progress, std::size_t done, std::size_t of) {
  if (done % 65536 != 0) return true;
  progress.report(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(of, 1)),
                  "writing the mesh");
  return !progress.cancelled();
}

Error stopped_writing(const std::string& path) {
  return error(Trouble::interrupted, path + ": stopped, nothing was written");
}

// 80 bytes of text, which must not begin with "solid"; the count; for each triangle its normal, its
// corners and 0.
Status write_stl(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  const auto& index = out.mesh.triangles;
  const std::size_t count = index.size() / 3;
  if (count > 0xFFFFFFFFULL)
    return error(path +
                 ": STL holds at most 4 billion triangles; use .ply, or a larger `voxel_mm`");
  std::string header = fmt::format("burr UNIT=mm {}", out.mark());
  header.resize(80, ' ');
  file.write(header);
  const auto count32 = static_cast<std::uint32_t>(count);
  file.write(&count32, sizeof count32);
  for (std::size_t t = 0; t < count; ++t) {
    if (!go_on(progress, t, count)) return stopped_writing(path);
    const math::Vec3f &a = out.p_mm[index[3 * t]], &b = out.p_mm[index[3 * t + 1]],
                      &c = out.p_mm[index[3 * t + 2]];
    math::Vec3f n = (b - a).cross(c - a);
    const float length = n.norm();
    n = length > 0 ? math::Vec3f(n / length) : math::Vec3f(math::Vec3f::Zero());
    char bytes[50];
    put(put(put(put(put(bytes, n), a), b), c), std::uint16_t{0});
    file.write(bytes, sizeof bytes);
  }
  return fine();
}

Status write_ply(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  const auto& index = out.mesh.triangles;
  const std::size_t vertices = out.p_mm.size(), count = index.size() / 3;
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  if (out.mark()[0] != '\0') header += fmt::format("comment {}\n", out.mark());
  header += fmt::format(
      "comment unit: mm\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      vertices, count);
  file.write(header);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!go_on(progress, v, vertices + count)) return stopped_writing(path);
    char bytes[27];
    put(put(put(bytes, out.p_mm[v]), out.normal(v)), out.colour(v));
    file.write(bytes, sizeof bytes);
  }
  for (std::size_t t = 0; t < count; ++t) {
    if (!go_on(progress, t, count)) return stopped_writing(path);
    char bytes[13];
    put(put(put(put(bytes, std::uint8_t{3}), index[3 * t]), index[3 * t + 1]), index[3 * t + 2]);
    file.write(bytes, sizeof bytes);
  }
  return fine();
}

Status write_obj(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  const auto& index = out.mesh.triangles;
  const std::size_t vertices = out.p_mm.size(), count = index.size() / 3;
  file.write(fmt::format("# burr {}\n# unit: mm\n", out.mark()));
  fmt::memory_buffer line;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!go_on(progress, v, vertices + count)) return stopped_writing(path);
    const math::Vec3f &p = out.p_mm[v], n = out.normal(v);
    line.clear();
    // the shortest digits that are read back as the same number
    fmt::format_to(std::back_inserter(line), FMT_COMPILE("v {} {} {}\nvn {:.4f} {:.4f} {:.4f}\n"),
                   p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
    file.write(line.data(), line.size());
  }
  for (std::size_t t = 0; t < count; ++t) {
    if (!go_on(progress, t, count)) return stopped_writing(path);
    const std::uint64_t a = index[3 * t] + 1ULL, b = index[3 * t + 1] + 1ULL,
                        c = index[3 * t + 2] + 1ULL;
    line.clear();
    fmt::format_to(std::back_inserter(line), FMT_COMPILE("f {}//{} {}//{} {}//{}\n"), a, a, b, b, c,
                   c);
    file.write(line.data(), line.size());
  }
  return fine();
}

bool is_mesh_path(const std::string& path) { return writer_of(path) != nullptr; }

Status write_mesh(const surface::Mesh& mesh, const volume::TissueTable& tissues,
                  const std::string& path, Frame frame, Progress& progress) {
  const Writer writer = writer_of(path);
  if (writer == nullptr)
    return error(Trouble::usage,
                 path + ": unknown file extension; use .stl, .ply, .obj, .3mf or .glb for a mesh");
  if (mesh.triangles.empty())
    return error(path + ": not written, because there is no surface; check that some bone is left");
  auto file = base::NewFile::create(path, base::kForAll);
  if (!file) return file.error();
  const MeshOut out = placed(mesh, tissues, writer == write_glb ? Frame::lps : frame);
  Status written = writer(out, *file, path, progress);
  if (!written) return written;
  Status in_place = file->put_in_place();
  if (in_place.ok()) progress.report(1, "writing the mesh");
  return in_place;
}

}  // namespace burr::io
