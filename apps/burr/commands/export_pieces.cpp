#include "commands/export_pieces.h"

#include <fmt/core.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/volume/pieces.h"
#include "burr/volume/volume_of.h"
#include "commands/json_line.h"
#include "commands/outputs.h"

namespace burr::app {

std::string numbered(const std::string& path, std::size_t number) {
  const std::size_t name = path.find_last_of('/') + 1;  // npos + 1 is 0
  std::size_t end = path.rfind(".seg.nrrd");
  if (end == std::string::npos || end < name) end = path.rfind('.');
  if (end == std::string::npos || end < name) end = path.size();
  return path.substr(0, end) + "_" + std::to_string(number) + path.substr(end);
}

Status export_pieces(const volume::Bone& bone, const std::string& out,
                     const io::ExportOptions& options, bool force, bool json, Progress& progress) {
  const volume::PieceFinder finder(bone);
  const double voxel = bone.grid().voxel, voxel_m3 = voxel * voxel * voxel;
  std::size_t large = 0, splinters = 0;
  double splinters_m3 = 0;
  for (const volume::Piece& piece : finder.pieces()) {
    const double size = static_cast<double>(piece.voxels) * voxel_m3;
    if (size >= kSplinter) {
      ++large;
    } else {
      ++splinters;
      splinters_m3 += size;
    }
  }
  if (large == 0)
    return error(fmt::format("no piece of the bone is larger than {:g} mm^3; nothing was written",
                             1e9 * kSplinter));
  for (std::size_t n = 0; n < large; ++n) {  // all of them before the first is written
    const std::string path = numbered(out, n + 1);
    const Status allowed = check_outputs(
        {}, {{"--out", path, {".stl", ".ply", ".obj", ".3mf", ".glb", ".seg.nrrd", ".nrrd"}}},
        force);
    if (!allowed) return allowed;
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t n = 0; n < large; ++n) {
    const std::string path = numbered(out, n + 1);
    const auto piece = volume::piece_as_bone(bone, finder, n);
    if (!piece) return piece.error();
    const auto written = io::export_part(**piece, **piece, path, options, progress);
    if (!written) return written.error();
    const double volume_mm3 = 1e9 * volume::volume_of(**piece);
    if (json)
      rows.push_back(
          {{"file", path}, {"volume_mm3", volume_mm3}, {"triangles", written->triangles}});
    else
      fmt::print("{}: {:.1f} mm^3 in {} triangles\n", path, volume_mm3, written->triangles);
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
