#include "verify_law.h"

#include <fmt/core.h>
#include <sys/mman.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/workshop/law_file.h"
#include "burr/workshop/sha256.h"
#include "doctor/run_in_process.h"
#include "law_trial.h"
#include "page.h"
#include "shared/subcommand.h"
#include "verify_report.h"

namespace burr::app {
namespace {

constexpr double kBarUs = 20;       // of one call, p99  [us]
constexpr double kAllowed = 20e-6;  // that a hand may get, as in stability.cpp  [J]

struct Options {
  LawTrial trial{.file = {}, .settings = {}, .seed = 20261128};
  std::string out;
  double seconds = 300;
  bool json = false;
};

// The stage of the trial, in memory that both processes see.
class SharedStage {
 public:
  SharedStage()
      : memory_(mmap(nullptr, sizeof(LawStage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                     -1, 0)) {
    stage_ = memory_ == MAP_FAILED ? &own_ : new (memory_) LawStage(0);
  }
  ~SharedStage() {
    if (memory_ != MAP_FAILED) munmap(memory_, sizeof(LawStage));
  }
  SharedStage(const SharedStage&) = delete;
  SharedStage& operator=(const SharedStage&) = delete;
  LawStage& stage() { return *stage_; }

 private:
  void* memory_;
  LawStage own_ = 0;
  LawStage* stage_ = nullptr;
};

void tell(const nlohmann::json& said, std::uint64_t seed, VerifyReport::Part& part) {
  const nlohmann::json &none = said["no_numbers"], &random = said["random"], &time = said["time"];
  part.at_most("crashes", 0, 0, "");
  part.table(
      {fmt::format("Inputs that burr never gives (NaN, infinity, 1e300): the law must come back. "
                   "Of {} it refused "
                   "{} and answered {} with numbers that can be; the rest would switch it off.",
                   none["asked"].get<int>(), none["refused"].get<int>(),
                   none["possible"].get<int>()),
       {"input", "asked", "refused", "answered with possible numbers"},
       {{"no numbers", none["asked"].dump(), none["refused"].dump(), none["possible"].dump()}}});
  part.at_most(fmt::format("random.refused (of {}, seed {})", random["asked"].get<int>(), seed), 0,
               random["refused"].get<double>(), "");
  part.at_most("random.impossible", 0, random["impossible"].get<double>(), "");
  part.at_most("random.force", BURR_LAW_MOST_FORCE * 1.8, random["most_n"].get<double>(), "N");
  part.at_least("same.new_state", 1, said["twice"]["same_state"].get<bool>() ? 1 : 0, "");
  part.at_least("same.new_copy", 1, said["twice"]["same_copy"].get<bool>() ? 1 : 0, "");
  part.at_most("time.p99", kBarUs, time["p99_us"].get<double>(), "us");
  part.table(
      {"Time of one call, thread CPU, the least of five runs of the same calls, with that of "
       "reading the clock.",
       {"p50 [us]", "p99 [us]", "worst [us]"},
       {{fmt::format("{:.2f}", time["p50_us"].get<double>()),
         fmt::format("{:.2f}", time["p99_us"].get<double>()),
         fmt::format("{:.2f}", time["max_us"].get<double>())}}});
  const nlohmann::json& wall = said["wall"];
  part.at_least("loop.wall.stable", 1,
                wall["stable"].get<bool>() && !wall["off"].get<bool>() ? 1 : 0, "");
  Table table{
      fmt::format(
          "A simulated hand presses with this law: the least energy that it had given at any time "
          "(below -{:.0f} uJ the law gave it energy), that at the end, and the force.",
          1e6 * kAllowed),
      {"contact", "least [mJ]", "at the end [mJ]", "force [N]"},
      {}};
  for (const nlohmann::json& loop : said["loops"]) {
    const std::string name = loop["name"].get<std::string>();
    const double least = loop["least_j"].get<double>();
    part.at_least("loop." + name + ".energy", -1e3 * kAllowed, 1e3 * least, "mJ");
    part.at_most("loop." + name + ".switched_off", 0, loop["off"].get<bool>() ? 1 : 0, "");
    table.rows.push_back({name, fmt::format("{:.4f}", 1e3 * least),
                          fmt::format("{:.3f}", 1e3 * loop["end_j"].get<double>()),
                          fmt::format("{:.3f}", loop["force_n"].get<double>())});
  }
  part.table(std::move(table));
}

// What the bytes are called that were tried. Their library is not loaded here: it might crash.
Result<tick::LawAbout> about(const LawTrial& trial, const std::string& sha256) {
  tick::LawAbout law{.kind = "compiled", .name = {}, .sha256 = sha256, .settings_sha256 = {}};
  if (trial.settings.empty()) return law;
  auto hash = workshop::sha256_of_file(trial.settings);
  if (!hash) return hash.error();
  law.settings_sha256 = std::move(*hash);
  return law;
}

Status run(const Options& options) {
  VerifyReport report;
  if (!options.out.empty())
    if (Status written = report.write(options.out, page(report)); !written) return written;
  SharedStage shared;
  LawStage& stage = shared.stage();
  const auto began = std::chrono::steady_clock::now();
  const ProcessResult seen =
      run_in_process([&] { return try_law(options.trial, stage); },
                     std::chrono::milliseconds(static_cast<int>(1e3 * options.seconds)));
  const nlohmann::json said = nlohmann::json::parse(seen.words, nullptr, false);
  if (seen.ended && said.is_object() && said.contains("error"))
    return error(said["error"].get<std::string>());
  VerifyReport::Part& part =
      report.begin("law", "A custom law",
                   "Does a compiled force law come back whatever it is given, answer with numbers "
                   "that can be, give the same "
                   "answers to the same inputs, take little time, and give a hand no energy?");
  const bool whole = seen.ended && said.is_object() && said.contains("loops");
  if (whole) {
    tell(said, options.trial.seed, part);
  } else {
    part.at_most("crashes", 0, 1, "");
    const auto at = static_cast<std::size_t>(
        std::clamp(stage.load(), 0, static_cast<int>(kLawStages.size()) - 1));
    part.cannot(fmt::format("{}: {} when {}; the checks after it were not made", options.trial.file,
                            seen.words, kLawStages[at]));
  }
  part.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (!options.out.empty())
    if (Status written = report.write(options.out, page(report)); !written) return written;
  if (options.json) {
    fmt::print("{}\n", report.json());
  } else {
    for (const Check& check : part.checks) fmt::print("{}\n", VerifyReport::line(check));
    for (const std::string& sentence : part.left_out) fmt::print("not checked: {}\n", sentence);
    fmt::print("{} checks, {} failed{}\n", report.checks(), report.failed(),
               options.out.empty() ? "" : fmt::format("; {}/report.html", options.out));
  }
  if (report.failed() > 0)
    return error(
        Trouble::failed,
        whole ? fmt::format(
                    "{}: {} of {} checks failed; a session in real time will not take this law",
                    options.trial.file, report.failed(), report.checks())
              : fmt::format("{}: {} when {}; a session in real time will not take this law",
                            options.trial.file, seen.words,
                            kLawStages[static_cast<std::size_t>(std::clamp(
                                stage.load(), 0, static_cast<int>(kLawStages.size()) - 1))]));
  const auto law = about(options.trial, said["sha256"].get<std::string>());
  if (!law) return law.error();
  const Status kept = workshop::remember_pass(
      workshop::law_passes(), *law,
      fmt::format("seed {}\np99 {} us\n", options.trial.seed, said["time"]["p99_us"].dump()));
  if (!kept) return kept;
  if (!options.json)
    fmt::print("{}: passed; sessions in real time on this computer take it now\n",
               options.trial.file);
  return fine();
}

}  // namespace

CLI::App* add_verify_law(CLI::App& verify, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = verify.add_subcommand("law",
                                        "try a compiled force law of your own, in a process of its "
                                        "own (docs/develop/how_to_add_a_force_law.md)");
  command->add_option("file", options->trial.file, "FILE.so")->required();
  command->add_option("--law-settings", options->trial.settings,
                      "FILE: the text that this law gets");
  command->add_option("--seed", options->trial.seed, "seed of the random inputs")
      ->capture_default_str();
  command->add_option("--out", options->out, "DIR: write report.html and verify.json there");
  command->add_option("--longest", options->seconds, "stop the trial after so many seconds")
      ->check(CLI::Range(1.0, 36'000.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
  return command;
}

}  // namespace burr::app
