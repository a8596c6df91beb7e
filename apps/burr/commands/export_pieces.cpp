#include "commands/export_pieces.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "burr/report/piece_words.h"
#include "burr/volume/pieces.h"
#include "burr/volume/volume_of.h"
#include "shared/json_line.h"
#include "shared/outputs.h"

namespace burr::app {
namespace {

// One to be written: a piece of the bone, or one that was moved.
struct Body {
  double size = 0;  // whole voxels [m^3]
  std::size_t piece = 0;
  std::shared_ptr<const volume::Bone> moved;  // nullptr: a piece of the bone
  std::size_t row = 0;                        // of the moved pieces' JSON
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

}  // namespace

std::string numbered(const std::string& path, std::size_t number) {
  const std::size_t name = path.find_last_of('/') + 1;  // npos + 1 is 0
  std::size_t end = path.rfind(".seg.nrrd");
  if (end == std::string::npos || end < name) end = path.rfind('.');
  if (end == std::string::npos || end < name) end = path.size();
  return path.substr(0, end) + "_" + std::to_string(number) + path.substr(end);
}

Status export_pieces(const volume::Bone& bone, const std::string& out,
                     const io::ExportOptions& options, bool force, bool json, Progress& progress,
                     const edit::PieceStore& store) {
  const std::vector<edit::PieceStore::Moved> moved = store.moved(bone);
  const std::unique_ptr<volume::Bone> without = moved.empty() ? nullptr : store.without_moved(bone);
  const volume::Bone& rest = without ? *without : bone;
  const volume::PieceFinder finder(rest);
  const double voxel = bone.grid().voxel, voxel_m3 = voxel * voxel * voxel;
  std::vector<Body> bodies;
  std::size_t splinters = 0;
  double splinters_m3 = 0;
  for (std::size_t n = 0; n < finder.pieces().size(); ++n) {
    const double size = static_cast<double>(finder.pieces()[n].voxels) * voxel_m3;
    if (size >= kSplinter) {
      bodies.push_back({size, n, nullptr, 0});
    } else {
      ++splinters;
      splinters_m3 += size;
    }
  }
  for (std::size_t n = 0; n < moved.size(); ++n)
    bodies.push_back({inside_of(*moved[n].piece), 0, moved[n].piece, n});
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const Body& a, const Body& b) { return a.size > b.size; });
  if (bodies.empty())
    return error(fmt::format("no piece of the bone is larger than {:g} mm^3; nothing was written",
                             1e9 * kSplinter));
  for (std::size_t n = 0; n < bodies.size(); ++n) {  // all of them before the first is written
    const std::string path = numbered(out, n + 1);
    const Status allowed = check_outputs(
        {}, {{"--out", path, {".stl", ".ply", ".obj", ".3mf", ".glb", ".seg.nrrd", ".nrrd"}}},
        force);
    if (!allowed) return allowed;
  }
  const nlohmann::ordered_json moves =
      nlohmann::ordered_json::parse(report::pieces_json(report::moved_pieces(store, bone)));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const std::string path = numbered(out, n + 1);
    const Body& body = bodies[n];
    std::shared_ptr<const volume::Bone> alone = body.moved;
    if (!alone) {
      auto piece = volume::piece_as_bone(rest, finder, body.piece);
      if (!piece) return piece.error();
      alone = std::move(*piece);
    }
    const auto written = io::export_part(*alone, *alone, path, options, progress);
    if (!written) return written.error();
    const double volume_mm3 = 1e9 * volume::volume_of(*alone);
    if (json) {
      nlohmann::ordered_json row = {
          {"file", path}, {"volume_mm3", volume_mm3}, {"triangles", written->triangles}};
      if (body.moved) row["moved"] = moves[body.row];
      rows.push_back(std::move(row));
    } else {
      fmt::print("{}: {:.1f} mm^3 in {} triangles{}\n", path, volume_mm3, written->triangles,
                 body.moved ? fmt::format("; moved {:.2f} mm, turned {:.2f} degrees",
                                          moves[body.row]["distance_mm"].get<double>(),
                                          moves[body.row]["turned_deg"].get<double>())
                            : "");
    }
  }
  if (json) {
    nlohmann::ordered_json row;
    row["part"] = "pieces";
    row["pieces"] = std::move(rows);
    row["splinters"] = splinters;
    row["splinters_mm3"] = 1e9 * splinters_m3;
    fmt::print("{}\n", json_line(row));
  } else if (splinters > 0) {
    fmt::print("not written: {} smaller than {:g} mm^3, {:.1f} mm^3 in all\n",
               splinters == 1 ? "1 piece" : fmt::format("{} pieces", splinters), 1e9 * kSplinter,
               1e9 * splinters_m3);
  }
  return fine();
}

}  // namespace burr::app
