// `burr pieces`: the pieces into which the bone of a recording came apart, where they were moved, how
// they fit there, and how far they are from the plan of the case.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "burr/record/player.h"
#include "burr/report/piece_words.h"
#include "burr/sim/move_pieces.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/volume/pieces.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

struct Options {
  std::string source;
  scenario::BoneRecipe volume;
  double at_s = -1;  // below 0: the end
  bool json = false;
};

Status run(const Options& options) {
  auto player = record::Player::open(options.source);
  if (!player) return player.error();
  auto bone = workshop::bone_of(**player, options.volume, progress());
  if (!bone) return bone.error();
  std::optional<scenario::CaseLesson> lesson;
  if ((*player)->info().work_case) {
    const auto work = record::case_of(*(*player)->info().work_case);
    if (!work) return work.error();
    auto placed = workshop::placed_lesson(*work);
    if (!placed) return placed.error();
    lesson = std::move(*placed);
  }
  const std::unique_ptr<volume::Bone> now = volume::copy_of(**bone);
  const auto moved =
      report::moved_pieces_of(**player, *now, lesson ? &*lesson : nullptr, options.at_s);
  if (!moved) return moved.error();
  print_notices((*player)->notices());
  const volume::PieceFinder finder(std::as_const(*now));
  const std::size_t free = moved->store.list(*now).size();
  std::size_t splinters = 0;
  for (std::size_t n = 1; n < finder.pieces().size(); ++n)
    if (edit::is_dust(*now, finder, n)) ++splinters;
  if (options.json) {
    nlohmann::ordered_json out;
    out["free"] = free;
    out["splinters"] = splinters;
    out["moved"] = nlohmann::ordered_json::parse(report::pieces_json(moved->pieces));
    fmt::print("{}\n", json_line(out));
    return fine();
  }
  fmt::print("{} free, {} of them moved; {} splinters\n",
             free == 1 ? "1 piece" : fmt::format("{} pieces", free),
             std::count_if(moved->pieces.begin(), moved->pieces.end(),
                           [](const report::MovedPiece& piece) { return !piece.out; }),
             splinters);
  for (const std::string& line : report::pieces_text(moved->pieces)) fmt::print("{}\n", line);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "pieces", "say where the pieces of a recorded session's bone were moved, and how they fit");
  auto options = std::make_shared<Options>();
  command->add_option("recording", options->source, "a recording (.mcap)")->required();
  command->add_option("--at", options->at_s, "moment of the recording [s]; default: its end")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--volume", options->volume.source,
                      "the volume it was made from (default: burr searches for it)");
  add_volume_options(*command, options->volume);
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{61, add};

}  // namespace
}  // namespace burr::app
