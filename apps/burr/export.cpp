// `burr export`: the bone or what was removed, as a mesh or a volume other programs open.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/io/export_part.h"
#include "burr/record/player.h"
#include "command.h"

namespace burr::app {
namespace {

struct Options {
  std::string source, out;
  double at_s = -1;  // moment of a recording; below 0: its end
  std::string part = "bone", frame = "lps";
  bool scan = false;
  bool json = false;

  [[nodiscard]] io::ExportOptions what() const {
    return {part == "removed" ? io::Part::removed : io::Part::bone,
            frame == "ras"     ? io::Frame::ras
            : frame == "print" ? io::Frame::print
                               : io::Frame::lps,
            scan};
  }
};

struct Bones {
  std::unique_ptr<volume::Bone> before, now;  // now empty: the same
};

// The bone a recording began with, and as it was at the wanted moment.
Result<Bones> open_recording(const Options& options) {
  auto player = record::Player::open(options.source);
  if (!player) return player.error();
  const record::SessionInfo& info = (*player)->info();
  if (!info.embedded) return error(options.source + ": holds no bone; record with --embed");
  Bones bones;
  for (auto* bone : {&bones.before, &bones.now}) {
    auto opened = (*player)->embedded_bone(info.volume.reserve_bricks);
    if (!opened) return opened.error();
    *bone = std::move(*opened);
  }
  const double at_s = options.at_s < 0 ? (*player)->seconds() : options.at_s;
  const Status there = (*player)->bone_at(at_s, *bones.now);
  if (!there) return there.error();
  for (const std::string& notice : (*player)->notices()) fmt::print(stderr, "{}\n", notice);
  return bones;
}

Status run(const Options& options) {
  const Status possible = io::check_export(options.out, options.what());
  if (!possible) return possible;
  auto bones = open_recording(options);
  if (!bones) return bones.error();
  const volume::Bone& before = *bones->before;
  const volume::Bone& now = bones->now ? *bones->now : before;
  const auto exported = io::export_part(before, now, options.out, options.what(), progress());
  if (!exported) return exported.error();

  const double volume_mm3 = exported.value().volume * 1e9;
  if (options.json) {
    nlohmann::ordered_json row;
    row["part"] = options.part;
    row["volume_mm3"] = volume_mm3;
    row["triangles"] = exported.value().triangles;
    fmt::print("{}\n", row.dump());
  } else if (exported.value().triangles > 0) {
    fmt::print("{}: {:.1f} mm^3 in {} triangles\n", options.out, volume_mm3,
               exported.value().triangles);
  } else {
    fmt::print("{}: {:.1f} mm^3\n", options.out, volume_mm3);
  }
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("export", "write the bone, or what was removed, to a file");
  auto options = std::make_shared<Options>();
  command->add_option("source", options->source, "a recording (.mcap)")->required();
  command
      ->add_option("--out", options->out,
                   "file to write; its ending says how: .stl .ply .obj .3mf .glb .seg.nrrd .nrrd")
      ->required();
  command->add_option("--part", options->part, "bone, or removed")
      ->check(CLI::IsMember({"bone", "removed"}))
      ->capture_default_str();
  command
      ->add_option("--frame", options->frame,
                   "axes of a mesh: lps as the scan, ras, or print (z up, on the bed, centred)")
      ->check(CLI::IsMember({"lps", "ras", "print"}))
      ->capture_default_str();
  command->add_flag("--scan", options->scan,
                    "into .nrrd: the scan's grey values with the cut in them, not the field");
  command->add_option("--at", options->at_s, "moment of the recording [s]; default: its end")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{60, add};

}  // namespace
}  // namespace burr::app
