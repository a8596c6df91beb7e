// `burr score`: a recording against a rubric, item by item.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "batch/row_command.h"
#include "burr/base/printable.h"
#include "burr/record/player.h"
#include "burr/record/session_info.h"
#include "burr/report/piece_words.h"
#include "burr/report/score_words.h"
#include "burr/report/scored.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "score_items.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

constexpr const char* kDefaults =
    "(default): nobody has compared this threshold with people. burr gives no grade and no pass.";

struct Options {
  std::string source, rubric, explain;
  scenario::BoneRecipe volume;
  bool json = false;
};

std::string ids_of(const scoring::Rubric& rubric) {
  std::string list;
  for (const scoring::Item& one : rubric.items)
    list += (list.empty() ? "" : ", ") + base::printable(one.id);
  return list;
}

// Is the rubric another one than that of the recording? None: the recording does not say.
std::optional<bool> rubric_changed(const record::Player& player, const scoring::Rubric& rubric) {
  const auto& who = player.info().identity;
  if (!who || who->rubric_hash == 0) return std::nullopt;
  return who->rubric_hash != rubric.text_hash;
}

nlohmann::ordered_json result_of(const report::Scored& made, const std::optional<bool>& changed) {
  const scoring::Rubric& rubric = made.judged.rubric;
  nlohmann::ordered_json out =
      nlohmann::ordered_json::parse(report::score_json(rubric, made.score));
  out["rubric_hash"] = record::hex(rubric.text_hash);
  out["rubric_changed"] =
      changed ? nlohmann::ordered_json(*changed) : nlohmann::ordered_json(nullptr);
  out["pieces"] = nlohmann::ordered_json::parse(report::pieces_json(made.pieces));
  return out;
}

// given: takes the findings; nullptr: it is printed.
Status run_score(const Options& options, CommandResult* given) {
  auto judged = report::judged_by(options.source, options.rubric);
  if (!judged) return judged.error();
  const scoring::Item* wanted = judged->rubric.item(options.explain);
  if (!options.explain.empty() && wanted == nullptr)
    return error(Trouble::usage,
                 fmt::format("--explain {}: there is no such item; use one of {}",
                             base::printable(options.explain), ids_of(judged->rubric)));
  const auto made = report::scored(std::move(*judged), options.volume, progress());
  if (!made) return made.error();
  const record::Player& player = *made->judged.player;
  const scoring::Rubric& rubric = made->judged.rubric;
  const scoring::Score& score = made->score;
  const auto changed = rubric_changed(player, rubric);
  if (given != nullptr) {
    given->result = nlohmann::json::parse(json_line(result_of(*made, changed)));
    return fine();
  }
  wanted = rubric.item(options.explain);  // of the rubric as it was moved
  print_notices(player.notices());
  if (wanted != nullptr) {
    const auto at = static_cast<std::size_t>(wanted - rubric.items.data());
    fmt::print("{}\n", report::explanation(*wanted, score.outcomes[at], player.info().rate_hz));
  } else {
    fmt::print("{}, version {}\n", base::printable(rubric.name), rubric.version);
    if (const std::string safety = report::safety_line(rubric, score); !safety.empty())
      fmt::print("{}\n", safety);
    print_items(rubric, score);
    for (const std::string& line :
         {report::total_line(rubric, scoring::Part::product, score.product),
          report::total_line(rubric, scoring::Part::process, score.process)})
      if (!line.empty()) fmt::print("{}\n", line);
    if (const std::string none = report::no_mark_line(score); !none.empty())
      fmt::print("{}\n", none);
    fmt::print("{}: {}; {:.0f} % of the bone that the case says to remove is gone\n",
               score.unfinished ? "unfinished" : "finished", score.ending, 100 * score.worked);
    if (!made->pieces.empty())
      fmt::print("moved, which earns nothing; the items look at the bone as if it had not been:\n");
    for (const std::string& line : report::pieces_text(made->pieces)) fmt::print("  {}\n", line);
  }
  if (changed.value_or(false))
    fmt::print(
        "note: when this session was recorded, the rubric of its case was another one; the marks "
        "are those of the rubric as it is now\n");
  fmt::print("{}\n", kDefaults);
  if (options.json) fmt::print("{}\n", json_line(result_of(*made, changed)));
  return fine();
}

// chosen: gets the options when they were parsed.
void add_score_to(CLI::App& app,
                  const std::function<void(std::shared_ptr<const Options>)>& chosen) {
  auto* command = app.add_subcommand("score", "say what a recorded session met of a rubric");
  auto options = std::make_shared<Options>();
  command->add_option("recording", options->source, "a recording (.mcap)")->required();
  command->add_option("--rubric", options->rubric,
                      "a built-in rubric, or a .toml file (default: that of the recording's case)");
  command->add_option("--explain", options->explain, "all that is known about this item");
  command->add_option("--volume", options->volume.source,
                      "the volume it was made from (default: burr searches for it)");
  add_volume_options(*command, options->volume);
  command->add_flag("--json", options->json, "one JSON object as the last line, in SI");
  command->callback([options, chosen] { chosen(options); });
}

void add_score(CLI::App& app, Todo& todo) {
  add_score_to(app, [&todo](auto options) {
    todo.work = [options] { return run_score(*options, nullptr); };
  });
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_score_to(app, [&todo](auto options) {
    todo.work = [options](CommandResult& findings) { return run_score(*options, &findings); };
  });
}

const Command score_command{66, add_score};
const RowCommand row_command{"score", add_row};

}  // namespace
}  // namespace burr::app
