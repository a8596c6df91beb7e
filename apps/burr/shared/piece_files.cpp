#include "shared/piece_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "burr/volume/pieces.h"
#include "burr/volume/volume_of.h"

namespace burr::app {
namespace {

// One to be written: a piece of the bone, or one that was moved.
struct Body {
  double size = 0;  // whole voxels [m^3]
  std::size_t piece = 0;
  std::shared_ptr<const volume::Bone> moved;  // nullptr: a piece of the bone
  std::size_t row = 0;                        // of the moved pieces
};

double inside_of(const volume::Bone& bone) {
  std::int64_t inside = 0;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::Field* const field = bone.brick_field(brick);
    if (field == nullptr) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) inside += field[v] >= volume::kIso ? 1 : 0;
  }
  const double voxel = bone.grid().voxel;
  return static_cast<double>(inside) * voxel * voxel * voxel;
}

// All that is larger than a splinter, the largest first; counts the splinters.
std::vector<Body> bodies_of(const volume::Bone& rest, const volume::PieceFinder& finder,
                            const std::vector<edit::PieceStore::Moved>& moved, PieceFiles& made) {
  const double voxel = rest.grid().voxel, voxel_m3 = voxel * voxel * voxel;
  std::vector<Body> bodies;
  for (std::size_t n = 0; n < finder.pieces().size(); ++n) {
    const double size = static_cast<double>(finder.pieces()[n].voxels) * voxel_m3;
    if (size >= kSplinter) {
      bodies.push_back({size, n, nullptr, 0});
    } else {
      ++made.splinters;
      made.splinters_volume += size;
    }
  }
  for (std::size_t n = 0; n < moved.size(); ++n)
    bodies.push_back({inside_of(*moved[n].piece), 0, moved[n].piece, n});
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const Body& a, const Body& b) { return a.size > b.size; });
  return bodies;
}

}  // namespace

std::string numbered(const std::string& path, std::size_t number) {
  const std::size_t name = path.find_last_of('/') + 1;  // npos + 1 is 0
  std::size_t end = path.rfind(".seg.nrrd");
  if (end == std::string::npos || end < name) end = path.rfind('.');
  if (end == std::string::npos || end < name) end = path.size();
  return path.substr(0, end) + "_" + std::to_string(number) + path.substr(end);
}

Result<PieceFiles> write_pieces(const volume::Bone& bone, const std::string& out,
                                const io::ExportOptions& options,
                                const std::function<Status(const std::string& path)>& may_write,
                                Progress& progress, const edit::PieceStore& store) {
  const std::vector<edit::PieceStore::Moved> moved = store.moved(bone);
  const std::unique_ptr<volume::Bone> without = moved.empty() ? nullptr : store.without_moved(bone);
  const volume::Bone& rest = without ? *without : bone;
  const volume::PieceFinder finder(rest);
  PieceFiles made;
  const std::vector<Body> bodies = bodies_of(rest, finder, moved, made);
  if (bodies.empty())
    return error(fmt::format("no piece of the bone is larger than {:g} mm^3; nothing was written",
                             1e9 * kSplinter));
  for (std::size_t n = 0; n < bodies.size(); ++n)  // all of them before the first is written
    if (const Status allowed = may_write(numbered(out, n + 1)); !allowed) return allowed.error();
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const Body& body = bodies[n];
    std::shared_ptr<const volume::Bone> alone = body.moved;
    if (!alone) {
      auto piece = volume::piece_as_bone(rest, finder, body.piece);
      if (!piece) return piece.error();
      alone = std::move(*piece);
    }
    PieceFiles::One& one = made.files.emplace_back();
    one.path = numbered(out, n + 1);
    const auto written = io::export_part(*alone, *alone, one.path, options, progress);
    if (!written) return written.error();
    one.volume = volume::volume_of(*alone);
    one.triangles = written->triangles;
    if (body.moved) one.moved = body.row;
  }
  return made;
}

}  // namespace burr::app
