#include "burr/io/write/write_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "burr/io/write/deflate.h"

namespace burr::io {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kIso;
using volume::TissueId;
using volume::TissueKind;

// Removes -0, and rounding errors around zero.
double tidy(double value) { return std::abs(value) < 1e-12 ? 0.0 : value; }

std::string triple(const math::Vec3& v) {
  return fmt::format("({},{},{})", tidy(v.x()), tidy(v.y()), tidy(v.z()));
}

std::string nrrd_header(const volume::Grid& grid, const char* type, bool two_bytes,
                        const std::string& keys) {
  const math::Mat3 step_mm = grid.frame.q.toRotationMatrix() * (1e3 * grid.voxel);
  std::string header = "NRRD0004\n";
  header += fmt::format("type: {}\ndimension: 3\nspace: left-posterior-superior\n", type);
  header += fmt::format("sizes: {} {} {}\n", grid.size.x(), grid.size.y(), grid.size.z());
  header += fmt::format("space directions: {} {} {}\n", triple(step_mm.col(0)),
                        triple(step_mm.col(1)), triple(step_mm.col(2)));
  header += "kinds: domain domain domain\n";
  if (two_bytes) header += "endian: little\n";
  header += "encoding: gzip\n";
  header += fmt::format("space origin: {}\n", triple(1e3 * grid.frame.p));
  return header + keys + "\n";
}

// Header and voxels, x fastest. voxel(brick, v): value of the v-th voxel of a brick.
template <class Value, class Voxel>
Status write_nrrd(const Bone& bone, const std::string& path, const std::string& header,
                  Progress& progress, const Voxel& voxel) {
  auto file = base::NewFile::create(path, base::kForAll);
  if (!file) return file.error();
  file->write(header);
  Deflate deflate(*file, Deflate::Kind::gzip, 3);
  const math::Ijk size = bone.grid().size;
  const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y());
  std::vector<Value> slab(nx * ny * kBrickEdge);  // one layer of bricks
  for (int bk = 0; bk < bone.bricks().z(); ++bk) {
    progress.report(static_cast<double>(bk) / bone.bricks().z(), "writing the volume");
    if (progress.cancelled())
      return error(Trouble::interrupted, path + ": stopped, nothing was written");
    const int layers = std::min(kBrickEdge, size.z() - bk * kBrickEdge);
    for (int bj = 0; bj < bone.bricks().y(); ++bj)
      for (int bi = 0; bi < bone.bricks().x(); ++bi) {
        const BrickIndex brick = bone.brick_at(bi, bj, bk);
        const math::Ijk first(bi * kBrickEdge, bj * kBrickEdge, 0);
        const math::Ijk room = (size - first).cwiseMin(kBrickEdge);
        for (int k = 0; k < layers; ++k)
          for (int j = 0; j < room.y(); ++j) {
            Value* to = &slab[static_cast<std::size_t>(first.x()) +
                              nx * (static_cast<std::size_t>(first.y() + j) +
                                    ny * static_cast<std::size_t>(k))];
            for (int i = 0; i < room.x(); ++i) to[i] = voxel(brick, i + 8 * (j + 8 * k));
          }
      }
    deflate.write(slab.data(), nx * ny * static_cast<std::size_t>(layers) * sizeof(Value));
    if (!file->ok()) break;  // put_in_place() gives the reason
  }
  deflate.finish();
  Status in_place = file->put_in_place();
  if (in_place.ok()) progress.report(1, "writing the volume");
  return in_place;
}

// The value of an NRRD key: one line.
std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return line;
}

}  // namespace

std::vector<int> label_values(const volume::TissueTable& tissues) {
  std::vector<int> values = {0};
  std::set<int> seen;
  bool own = true;
  for (std::size_t id = 1; id < tissues.tissues.size(); ++id) {
    const int label = tissues.tissues[id].label;
    own = own && label >= 1 && label <= 255 && seen.insert(label).second;
    values.push_back(label);
  }
  if (!own)
    for (std::size_t id = 1; id < values.size(); ++id) values[id] = static_cast<int>(id);
  return values;
}

Status write_field(const Bone& bone, const std::string& path, Progress& progress) {
  const std::string keys =
      "# how far into the bone: 0 air .. 32768 surface .. 65535 solid, a ramp of +-2 voxels\n"
      "burr_quantity:=field\nburr_surface:=32768\n";
  return write_nrrd<std::uint16_t>(bone, path,
                                   nrrd_header(bone.grid(), "unsigned short", true, keys), progress,
                                   [&](BrickIndex brick, int v) {
                                     const Field* field = bone.brick_field(brick);
                                     return field == nullptr ? Field{0} : field[v];
                                   });
}

Status write_scan(const Bone& before, const Bone& now, const std::string& path,
                  Progress& progress) {
  if (!before.has_intensity())
    return error(
        path +
        ": this bone was not made from a scan, so it has no grey values; write the field instead");
  if (before.grid().size != now.grid().size)
    return error(path + ": the two bones are not on the same grid");
  constexpr double kAir = -1000;  // [HU]
  const std::string keys = "burr_quantity:=scan\n";
  return write_nrrd<std::int16_t>(
      before, path, nrrd_header(before.grid(), "short", true, keys), progress,
      [&](BrickIndex brick, int v) {
        const std::int16_t* values = before.brick_intensity(brick);
        if (values == nullptr) return static_cast<std::int16_t>(kAir);
        const Field* old_field = before.brick_field(brick);
        const Field* new_field = now.brick_field(brick);
        const Field b = old_field[v], n = new_field == nullptr ? Field{0} : new_field[v];
        if (n >= b) return values[v];
        const double left = static_cast<double>(n) / b;
        return static_cast<std::int16_t>(std::lround(kAir + (values[v] - kAir) * left));
      });
}

Status write_labels(const Bone& bone, const std::string& path, Progress& progress) {
  const auto& tissues = bone.tissues().tissues;
  const std::vector<int> values = label_values(bone.tissues());
  const math::Ijk last = bone.grid().size - math::Ijk::Ones();
  std::string keys =
      "Segmentation_MasterRepresentation:=Binary labelmap\n"
      "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"
      "Segmentation_ConversionParameters:=\n"
      "Segmentation_ReferenceImageExtentOffset:=0 0 0\n";
  for (std::size_t id = 1; id < tissues.size(); ++id) {
    const auto n = id - 1;
    const auto& c = tissues[id].colour;
    keys += fmt::format("Segment{}_ID:=Segment_{}\n", n, id);
    keys += fmt::format("Segment{}_Name:={}\n", n, one_line(tissues[id].name));
    keys += fmt::format("Segment{}_NameAutoGenerated:=0\n", n);
    keys += fmt::format("Segment{}_Color:={} {} {}\n", n, c[0], c[1], c[2]);
    keys += fmt::format("Segment{}_ColorAutoGenerated:=0\n", n);
    keys += fmt::format("Segment{}_Extent:=0 {} 0 {} 0 {}\n", n, last.x(), last.y(), last.z());
    keys += fmt::format("Segment{}_LabelValue:={}\n", n, values[id]);
    keys += fmt::format("Segment{}_Layer:=0\n", n);
    keys += fmt::format("Segment{}_Tags:=\n", n);
  }
  return write_nrrd<std::uint8_t>(
      bone, path, nrrd_header(bone.grid(), "unsigned char", false, keys), progress,
      [&](BrickIndex brick, int v) {
        const TissueId* tissue = bone.brick_tissue(brick);
        if (tissue == nullptr || tissue[v] >= tissues.size()) return std::uint8_t{0};
        const TissueKind kind = tissues[tissue[v]].kind;
        const bool there = kind == TissueKind::soft ||
                           (kind == TissueKind::solid && bone.brick_field(brick)[v] >= kIso);
        return there ? static_cast<std::uint8_t>(values[tissue[v]]) : std::uint8_t{0};
      });
}

}  // namespace burr::io
