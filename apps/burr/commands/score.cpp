// `burr score`: a recording against a rubric, item by item.
// `burr rubric check`: reads a rubric and runs it on the untouched bone of its case.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
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
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/reference.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/other_bone.h"
#include "burr/workshop/prepare.h"
#include "shared/bone_option.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

constexpr const char* kDefaults =
    "(default): nobody has compared this threshold with people. burr gives no grade and no pass.";

struct Options {
  std::string source, rubric, explain, work_case;
  std::uint32_t bone = 0;
  scenario::BoneRecipe volume;
  bool json = false;
};

void print_items(const scoring::Rubric& rubric, const scoring::Score& score) {
  for (const scoring::Part part : {scoring::Part::product, scoring::Part::process}) {
    if (std::none_of(rubric.items.begin(), rubric.items.end(),
                     [&](const auto& item) { return item.part == part; }))
      continue;
    fmt::print("{}\n", scoring::word_of(part));
    for (const std::size_t n : scoring::in_order(rubric, score.outcomes, part))
      fmt::print("{}\n", report::item_line(rubric.items[n], score.outcomes[n]));
  }
}

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

// Work that follows the plan of the case exactly must meet the product. Items that need a recording count
// as met here, so that those which require them are looked at.
Status check_reference(const Options& options, const scoring::Rubric& rubric,
                       const scenario::Case& work, const scenario::CaseLesson& lesson,
                       const volume::Bone& before) {
  if (!lesson.reference || lesson.reference->remove.empty()) {
    fmt::print(
        "the case \"{}\" has no [reference] with regions to remove, so it was not checked that "
        "good work meets the rubric\n",
        base::printable(work.name));
    return fine();
  }
  const auto made = workshop::open_bone(workshop::recipe_of(work, options.volume), progress());
  if (!made) return made.error();
  if (const Status cut = scoring::cut_to_reference(*made->bone, before, lesson, progress()); !cut)
    return cut;
  scoring::Rubric alone = rubric;
  for (scoring::Item& item : alone.items)
    if (const scoring::Item* other = rubric.item(item.needs);
        other != nullptr && scoring::needs_recording(*other))
      item.needs.clear();
  const auto score = scoring::score(alone, lesson, before, *made->bone, nullptr, progress());
  if (!score) return score.error();
  fmt::print("on the reference result of {}\n", base::printable(work.name));
  print_items(alone, *score);
  std::string unmet;
  for (std::size_t n = 0; n < rubric.items.size(); ++n)
    if (rubric.items[n].part == scoring::Part::product &&
        score->outcomes[n].verdict == scoring::Verdict::unmet)
      unmet += (unmet.empty() ? "" : ", ") + base::printable(rubric.items[n].id);
  if (!unmet.empty())
    return error(Trouble::data,
                 fmt::format("{}: the reference result of the case does not meet {}; change these "
                             "items, or [reference] in the case",
                             rubric.file, unmet));
  fmt::print(
      "the reference result meets {} of {} items of the product; the others need a recording\n",
      score->product.met, score->product.items);
  return fine();
}

// Nobody may earn a point of the product with an untouched bone.
Status run_check(const Options& options) {
  const auto rubric = scoring::read_rubric(options.rubric);
  if (!rubric) return rubric.error();
  auto work =
      scenario::read_case(options.work_case.empty() ? rubric->case_source : options.work_case);
  if (!work) return work.error();
  if (const Status taken = workshop::take_bone(*work, options.bone); !taken) return taken;
  if (const Status set = workshop::check_session(*work); !set) return set;
  const auto lesson = report::lesson_for(*work, *rubric);
  if (!lesson) return lesson.error();
  const auto made = workshop::open_bone(workshop::recipe_of(*work, options.volume), progress());
  if (!made) return made.error();
  const auto score =
      scoring::score(*rubric, *lesson, *made->bone, *made->bone, nullptr, progress());
  if (!score) return score.error();
  fmt::print("{}: {} items, on the untouched bone of {}\n", rubric->file, rubric->items.size(),
             base::printable(work->name));
  print_items(*rubric, *score);
  std::string met;
  for (std::size_t n = 0; n < rubric->items.size(); ++n)
    if (score->outcomes[n].verdict == scoring::Verdict::met)
      met += (met.empty() ? "" : ", ") + base::printable(rubric->items[n].id);
  if (!met.empty())
    return error(Trouble::data,
                 fmt::format("{}: an untouched bone meets {}; make these items stricter",
                             rubric->file, met));
  if (score->product.assessable == 0)
    return error(
        Trouble::data,
        fmt::format("{}: no item of the product can be assessed on the bone of the case \"{}\"; "
                    "the reasons are above",
                    rubric->file, base::printable(work->name)));
  fmt::print("the untouched bone meets no item of the product; {} of {} were assessed\n",
             score->product.assessable, score->product.items);
  return check_reference(options, *rubric, *work, *lesson, *made->bone);
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

void add_rubric(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("rubric", "check a rubric");
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto* check = command->add_subcommand(
      "check",
      "read a rubric and run it on the untouched bone of its case, which must meet nothing");
  check->add_option("rubric", options->rubric, "a built-in rubric, or a .toml file")->required();
  check->add_option("--case", options->work_case,
                    "the case, built in or a .toml file (default: the one that the rubric names)");
  add_bone_option(*check, options->bone);
  add_volume_options(*check, options->volume);
  check->callback([options, &todo] { todo.work = [options] { return run_check(*options); }; });
}

const Command score_command{66, add_score};
const Command rubric_command{67, add_rubric};
const RowCommand row_command{"score", add_row};

}  // namespace
}  // namespace burr::app
