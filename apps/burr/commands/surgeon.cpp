// `burr surgeon`: a scripted surgeon does a case, and the session is recorded like anybody's.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "batch/row_command.h"
#include "burr/base/printable.h"
#include "burr/proof/assistant.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/surgeon/surgeon.h"
#include "burr/tick/flag_words.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/other_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "shared/bone_option.h"
#include "shared/identity_options.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/recorded_session.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

constexpr double kLongest = 5400;  // if nobody says how long; the same for all levels [s]

struct Options {
  std::string work_case, level = "expert", record;
  record::Identity identity;
  std::uint32_t bone = 0;
  std::vector<std::string> vices;
  scenario::BoneRecipe volume;
  std::uint64_t seed = 1;
  double seconds = kLongest, least_seconds = 0;
  bool embed = false, force = false, json = false;
};

Result<surgeon::Skill> skill_of(const Options& options) {
  const auto level = surgeon::level_of(options.level);
  if (!level)
    return error(Trouble::usage, fmt::format("--level {}: is not known; use one of {}",
                                             base::printable(options.level),
                                             fmt::join(surgeon::level_words(), ", ")));
  surgeon::Skill skill = surgeon::drawn(surgeon::skill_of(*level), options.seed);
  for (const std::string& vice : options.vices) {
    const std::size_t equals = vice.find('=');
    double value = 0;
    std::size_t read = 0;
    try {
      if (equals != std::string::npos) value = std::stod(vice.substr(equals + 1), &read);
    } catch (const std::exception&) {
      read = 0;
    }
    if (read == 0 || equals + 1 + read != vice.size())
      return error(Trouble::usage,
                   fmt::format("--vice {}: write NAME=VALUE, for example perception_mm=1.5",
                               base::printable(vice)));
    if (const Status set = surgeon::set_vice(skill, vice.substr(0, equals), value); !set)
      return set.error();
  }
  return skill;
}

void print(const Options& options, sim::Session& session, const proof::Assistant& assistant,
           const CommandResult& findings) {
  const sim::Outcome outcome = session.outcome();
  if (!options.json) {
    const std::string ending = findings.result["ending"];
    fmt::print("{}, seed {}: {:.1f} s, {:.1f} mm3 removed, {:.2f} N mean in contact; {}\n",
               options.level, options.seed, outcome.seconds, 1e9 * outcome.ledger.removed,
               outcome.mean_force, ending);
    for (const proof::StepDone& step : assistant.steps())
      fmt::print("  {}: from {:.1f} s{}\n", base::printable(step.step), step.from_s,
                 step.to_s ? fmt::format(" to {:.1f} s, {:.1f} % of its plan left", *step.to_s,
                                         100 * step.left)
                           : "");
    for (const std::string& sentence : tick::words(tick::worth_telling(outcome.flags)))
      fmt::print("noted: {}\n", sentence);
    return;
  }
  fmt::print("{}\n", json_line(findings.whole()));
}

nlohmann::json steps_of(const proof::Assistant& assistant) {
  nlohmann::json all = nlohmann::json::array();
  for (const proof::StepDone& step : assistant.steps()) {
    all.push_back({{"step", step.step}, {"from_s", step.from_s}});
    if (step.to_s) all.back().update({{"to_s", *step.to_s}, {"left", step.left}});
  }
  return all;
}

CommandResult result_of(const Options& options, sim::Session& session,
                        const proof::Assistant& assistant, const Recording& recording) {
  const sim::Outcome outcome = session.outcome();
  CommandResult findings;
  nlohmann::json& out = findings.result;
  out["finished"] = assistant.done() || !interrupted();
  out["level"] = options.level;
  out["seed"] = options.seed;
  out["seconds"] = outcome.seconds;
  out["removed_mm3"] = 1e9 * outcome.ledger.removed;
  out["mean_force_N"] = outcome.mean_force;
  out["ending"] = assistant.done() ? "declared done" : interrupted() ? "stopped" : "time up";
  out["steps"] = steps_of(assistant);
  out["noted"] = tick::words(tick::worth_telling(outcome.flags));
  out["bone_hash"] = record::hex(session.bone().content_hash());
  if (!options.record.empty()) findings.times["recording"] = recording.account();
  return findings;
}

// given: takes the findings; nullptr: it is printed.
Status run(const Options& options, CommandResult* given) {
  const Status possible = check_outputs({options.volume.materials},
                                        {{"--record", options.record, {".mcap"}}}, options.force);
  if (!possible) return possible;
  const auto skill = skill_of(options);
  if (!skill) return skill.error();
  auto work = scenario::read_case(options.work_case);
  if (!work) return work.error();
  if (const Status taken = workshop::take_bone(*work, options.bone); !taken) return taken;
  const auto lesson = workshop::placed_lesson(*work);
  if (!lesson) return lesson.error();
  auto prepared = workshop::prepare(*work, progress(), {}, options.volume);
  if (!prepared) return prepared.error();
  const sim::SessionSettings settings = workshop::settings_of(*prepared);
  auto surgeon =
      surgeon::Surgeon::make(*prepared->bone, *lesson, prepared->burr, prepared->place.at, *skill,
                             options.seed, settings.servo.rate_hz, progress());
  if (!surgeon) return surgeon.error();
  (*surgeon)->stay_until(static_cast<std::uint64_t>(options.least_seconds * settings.servo.rate_hz /
                                                    surgeon::kConsultTicks));
  auto begun = workshop::begin(*prepared, (*surgeon)->take_hand(), settings, progress());
  if (!begun) return begun.error();
  sim::Session& session = **begun;

  Recording recording;
  recording.belongs_to(options.identity);
  if (!options.record.empty()) {
    const Status started = recording.start(
        session, options.record, prepared->recipe, prepared->summary, "scripted surgeon",
        options.embed, workshop::to_spare(session.bone_tissues(), work->spare), *work);
    if (!started) return started;
  }
  proof::Assistant assistant(**surgeon, session, recording.diary());
  session.set_between_ticks([&assistant] { assistant.work(); }, surgeon::kConsultTicks);
  session.run(options.seconds, progress());
  const Status recorded = options.record.empty() ? fine() : recording.finish(session);
  CommandResult findings = result_of(options, session, assistant, recording);
  if (given == nullptr) print(options, session, assistant, findings);
  if (given != nullptr) *given = std::move(findings);
  if (!recorded) return recorded;
  if (interrupted()) return error(Trouble::interrupted, "stopped; the results so far are kept");
  return fine();
}

Result<double> memory_needed(const Options& options) {
  auto work = scenario::read_case(options.work_case);
  if (!work) return work.error();
  if (const Status taken = workshop::take_bone(*work, options.bone); !taken) return taken.error();
  const auto opened = workshop::open_bone(workshop::recipe_of(*work, options.volume), progress());
  if (!opened) return opened.error();
  return memory_mb(opened->bone->grid().size.cast<double>().prod());
}

// chosen: gets the options when they were parsed.
void add_surgeon(CLI::App& app, const std::function<void(std::shared_ptr<const Options>)>& chosen) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("surgeon", "a scripted surgeon does a case, to test scores");
  command->add_option("case", options->work_case, "a built-in case, or a .toml file")->required();
  command
      ->add_option("--level", options->level,
                   fmt::format("how well: {}", fmt::join(surgeon::level_words(), ", ")))
      ->capture_default_str();
  command
      ->add_option("--seed", options->seed,
                   "the same seed gives the same session; 1 to 99 to try out, from 1000 to compare")
      ->capture_default_str();
  add_bone_option(*command, options->bone);
  command->add_option("--vice", options->vices,
                      fmt::format("NAME=VALUE, several times: sets one number of the level: {}",
                                  fmt::join(surgeon::vice_names(), ", ")));
  command->add_option("--seconds", options->seconds, "the longest time, of the session's clock")
      ->check(CLI::Range(1.0, 36'000.0))
      ->capture_default_str();
  command
      ->add_option("--least-seconds", options->least_seconds,
                   "declare the work done no earlier; who is ready before looks on")
      ->check(CLI::Range(0.0, 36'000.0));
  command->add_option("--record", options->record, "F.mcap: record the session");
  command->add_flag("--embed", options->embed, "with --record: store the bone in the file");
  add_identity_options(*command, options->identity);
  add_force(*command, options->force);
  command->add_flag("--json", options->json, "one JSON object on the last line");
  add_volume_options(*command, options->volume);
  command->callback([options, chosen] { chosen(options); });
}

void add(CLI::App& app, Todo& todo) {
  add_surgeon(app,
              [&todo](auto options) { todo.work = [options] { return run(*options, nullptr); }; });
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_surgeon(app, [&todo](auto options) {
    todo.work = [options](CommandResult& findings) { return run(*options, &findings); };
    todo.memory_mb = [options] { return memory_needed(*options); };
  });
}

const Command command{65, add};
const RowCommand row_command{"surgeon", add_row};

}  // namespace
}  // namespace burr::app
