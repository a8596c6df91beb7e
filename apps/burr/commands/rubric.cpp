// `burr rubric check`: reads a rubric, runs it on the untouched bone of its case and on the reference result, and tries
// cheap ways to a mark.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/printable.h"
#include "burr/proof/cheap_marks.h"
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
#include "score_items.h"
#include "shared/bone_option.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

struct Options {
  std::string rubric, work_case;
  std::uint32_t bone = 0;
  scenario::BoneRecipe volume;
  bool tricks = false, json = false;
  int careless = 3;
  std::uint64_t seed = 1;
};

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

std::string words_of(const proof::PartMark& mark) {
  return fmt::format("{:4.1f} of {:2.0f}{}", mark.met, mark.items,
                     mark.points ? fmt::format(", {:4.1f} points", *mark.points) : "");
}

nlohmann::json json_of(const proof::PartMark& mark) {
  return {{"met", mark.met},
          {"assessable", mark.items},
          {"points", mark.points ? nlohmann::json(*mark.points) : nlohmann::json()}};
}

nlohmann::json json_of(const proof::CheapMark& mark) {
  nlohmann::json out = {{"name", mark.name},
                        {"how", mark.how},
                        {"product", json_of(mark.product)},
                        {"process", mark.process ? json_of(*mark.process) : nlohmann::json()},
                        {"no_mark", mark.no_mark},
                        {"earned", mark.earned},
                        {"beats", mark.beats}};
  return out;
}

void print_marks(const proof::CheapMarks& marks) {
  fmt::print(
      "cheap ways to a mark, the best first, and those without a mark last: items of the product "
      "that are met\n");
  const auto line = [](const proof::CheapMark& one) {
    fmt::print("  {:<24}  {}{}{}{}\n", words_of(one.product), base::printable(one.name, 80),
               one.how.empty() ? "" : ": " + base::printable(one.how, 120),
               one.process ? fmt::format("; process {}", words_of(*one.process)) : "",
               one.no_mark.empty() ? "" : "; no mark: " + one.no_mark);
  };
  for (const proof::CheapMark& one : marks.tricks) line(one);
  if (marks.careless) {
    fmt::print("beside them, the mean of {} careless surgeons\n", marks.sessions);
    line(*marks.careless);
  } else {
    fmt::print("no scripted surgeon can do this case, so the marks are compared with nothing: {}\n",
               in_options(Error{Trouble::data, marks.why_none}).text);
  }
}

// No cheap way may earn what careless, honest work earns.
Status try_tricks(const Options& options, const scoring::Rubric& rubric,
                  const scenario::Case& work) {
  const auto marks = proof::cheap_marks(options.rubric, work, options.volume,
                                        {options.careless, options.seed}, progress());
  if (!marks) return marks.error();
  print_marks(*marks);
  if (options.json) {
    nlohmann::json out = {{"rubric", rubric.name}, {"tricks", nlohmann::json::array()}};
    for (const proof::CheapMark& one : marks->tricks) out["tricks"].push_back(json_of(one));
    out["careless"] = marks->careless ? json_of(*marks->careless) : nlohmann::json();
    out["sessions"] = marks->sessions;
    fmt::print("{}\n", json_line(out));
  }
  std::string beats;
  for (const proof::CheapMark& one : marks->tricks)
    if (one.beats)
      beats += fmt::format("{}\"{}\" (it meets {})", beats.empty() ? "" : ", ",
                           base::printable(one.name, 80), base::list_of(one.earned));
  if (beats.empty()) {
    if (!marks->tricks.front().no_mark.empty())
      fmt::print("no cheap way has a mark\n");
    else if (marks->careless)
      fmt::print("no cheap way reaches the mean of the careless surgeons; the best is \"{}\"\n",
                 base::printable(marks->tricks.front().name, 80));
    return fine();
  }
  return error(Trouble::data,
               fmt::format("{}: a cheap way earns as much as careless work: {}; make these items "
                           "stricter, or add one that it does not meet",
                           rubric.file, beats));
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
  if (const Status good = check_reference(options, *rubric, *work, *lesson, *made->bone); !good)
    return good;
  return options.tricks ? try_tricks(options, *rubric, *work) : fine();
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
  check->add_flag("--tricks", options->tricks,
                  "try cheap ways to a mark, and compare them with careless surgeons (minutes)");
  check->add_option("--careless", options->careless, "with --tricks: how many careless surgeons")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  check
      ->add_option("--seed", options->seed, "with --tricks: of the surgeons and the random strokes")
      ->capture_default_str();
  check->add_flag("--json", options->json, "with --tricks: one JSON object as the last line");
  add_bone_option(*check, options->bone);
  add_volume_options(*check, options->volume);
  check->callback([options, &todo] { todo.work = [options] { return run_check(*options); }; });
}

const Command command{67, add_rubric};

}  // namespace
}  // namespace burr::app
