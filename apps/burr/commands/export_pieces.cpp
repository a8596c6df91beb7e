#include "commands/export_pieces.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "burr/report/piece_words.h"
#include "shared/json_line.h"
#include "shared/outputs.h"

namespace burr::app {

Status export_pieces(const volume::Bone& bone, const std::string& out,
                     const io::ExportOptions& options, bool force, bool json, Progress& progress,
                     const edit::PieceStore& store) {
  const auto may_write = [force](const std::string& path) {
    return check_outputs(
        {}, {{"--out", path, {".stl", ".ply", ".obj", ".3mf", ".glb", ".seg.nrrd", ".nrrd"}}},
        force);
  };
  const auto written = write_pieces(bone, out, options, may_write, progress, store);
  if (!written) return written.error();
  const nlohmann::ordered_json moves =
      nlohmann::ordered_json::parse(report::pieces_json(report::moved_pieces(store, bone)));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const PieceFiles::One& one : written->files) {
    if (json) {
      nlohmann::ordered_json row = {
          {"file", one.path}, {"volume_mm3", 1e9 * one.volume}, {"triangles", one.triangles}};
      if (one.moved) row["moved"] = moves[*one.moved];
      rows.push_back(std::move(row));
    } else {
      fmt::print("{}: {:.1f} mm^3 in {} triangles{}\n", one.path, 1e9 * one.volume, one.triangles,
                 one.moved ? fmt::format("; moved {:.2f} mm, turned {:.2f} degrees",
                                         moves[*one.moved]["distance_mm"].get<double>(),
                                         moves[*one.moved]["turned_deg"].get<double>())
                           : "");
    }
  }
  if (json) {
    nlohmann::ordered_json row;
    row["part"] = "pieces";
    row["pieces"] = std::move(rows);
    row["splinters"] = written->splinters;
    row["splinters_mm3"] = 1e9 * written->splinters_volume;
    fmt::print("{}\n", json_line(row));
  } else if (written->splinters > 0) {
    fmt::print("not written: {} smaller than {:g} mm^3, {:.1f} mm^3 in all\n",
               written->splinters == 1 ? "1 piece" : fmt::format("{} pieces", written->splinters),
               1e9 * kSplinter, 1e9 * written->splinters_volume);
  }
  return fine();
}

}  // namespace burr::app
