// burr doctor - why does my device not work, and what do I do about it? Every way to a hand is
// looked at, then the computer, and each line ends in what to do.
//
// Ends with 0 when it could look, whatever it saw. Nothing moves, and only --fix changes anything.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "burr/base/new_file.h"
#include "command.h"
#include "doctor/look.h"
#include "machine_trial.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  double seconds = 10;
  bool json = false, fix = false, yes = false;
};

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

// Asks first; a rule of the user's own is kept beside.
Status fix(const System& system, bool yes) {
  const fs::path file = udev_file(system);
  const std::string rules = udev_rules();
  std::error_code trouble;
  if (fs::exists(file, trouble) && text_of_file(file) == rules) {
    fmt::print("{} is as it should be\n", file.string());
    return fine();
  }
  fmt::print("{} is to hold:\n\n{}\n", file.string(), rules);
  if (!yes && isatty(STDIN_FILENO) == 0)
    return error(
        Trouble::usage,
        "there is no terminal to ask at; burr doctor --fix --yes writes it without asking");
  if (!yes) {
    fmt::print("Write it? [y/N] ");
    std::fflush(stdout);
    const int answer = std::getchar();
    if (answer != 'y' && answer != 'Y') {
      fmt::print("nothing was written\n");
      return fine();
    }
  }
  if (fs::exists(file, trouble)) {
    fs::path old = file;
    old += ".old";
    fs::copy_file(file, old, fs::copy_options::overwrite_existing, trouble);
    if (trouble)
      return error(Trouble::io, fmt::format("{}: cannot be kept as {} ({}); nothing was written",
                                            file.string(), old.string(), trouble.message()));
    fmt::print("what it held is in {}\n", old.string());
  }
  const auto cannot = [&](const std::string& why) {
    return error(Trouble::io,
                 fmt::format("{}; run it as root: sudo burr doctor --fix --seconds 0", why));
  };
  auto out = base::NewFile::beside(file.string());
  if (!out) return cannot(out.error().text);
  out->write(rules);
  const Status put = out->put_in_place();
  if (!put) return cannot(put.error().text);
  fmt::print(
      "written. Now: udevadm control --reload && udevadm trigger, then plug the device in again\n");
  return fine();
}

std::string usable(const std::vector<Finding>& findings) {
  std::string hands = "the mouse";
  for (const Finding& one : findings)
    if (one.health == Health::good && (one.group == "haptic devices" || one.what == "SpaceMouse" ||
                                       one.what == "gamepads, pedals"))
      hands += ", " + one.what;
  return hands;
}

Status run(const Options& options) {
  const System system;
  if (options.fix) return fix(system, options.yes);
  std::vector<Finding> findings = look_at_devices(system);  // first: it forks
  for (auto* look : {&look_at_nodes, &look_at_pads, &look_at_screen, &look_at_machine})
    for (Finding& one : look(system)) findings.push_back(std::move(one));

  nlohmann::json trial;
  std::string verdict;
  if (options.seconds > 0) {
    MachineTrial wished;
    wished.seconds = options.seconds;
    const auto measured = measure_machine(wished);
    Finding tried{"trial", fmt::format("{:g} seconds", options.seconds), Health::trouble, "", ""};
    if (!measured) {
      if (measured.error().trouble == Trouble::interrupted) return measured.error();
      tried.is = measured.error().text;
      tried.todo = "burr check tries it again";
    } else {
      const rt::TickSummary& t = measured->seen.milling_loaded;
      const sim::MachineJudged judged = sim::judge(measured->seen);
      verdict = sim::name(judged.verdict);
      tried.health = judged.verdict == sim::Verdict::not_enough ? Health::trouble : Health::good;
      tried.is = fmt::format(
          "milling with all else at work: a tick took {:.0f} us (p99.9), began {:.0f} us late "
          "(p99.9), at the worst {:.1f} ms; {} of {} left out. {}",
          t.p999_us, t.late_p999_us, 1e-3 * t.worst_lateness_us, t.missed, t.ticks + t.missed,
          judged.sentence);
      if (judged.verdict != sim::Verdict::good)
        tried.todo = "the lines marked !! above; burr check measures longer";
      trial = {{"ticks", t.ticks},
               {"missed", t.missed},
               {"work_p999_us", t.p999_us},
               {"late_p999_us", t.late_p999_us},
               {"late_max_us", t.worst_lateness_us}};
    }
    findings.push_back(std::move(tried));
  }
  if (options.json) {
    nlohmann::json out;
    out["findings"] = nlohmann::json::parse(json_of(findings));
    out["trial"] = trial;
    out["verdict"] = verdict;
    fmt::print("{}\n", out.dump());
    return fine();
  }
  fmt::print(
      "{}\nburr can be led here by: {}.{}\n", text_of(findings), usable(findings),
      verdict.empty() ? "" : fmt::format(" This computer is {} for a haptic device.", verdict));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("doctor", "why does my device not work, and what to do about it");
  command->add_option("--seconds", options->seconds, "of a trial of the tick at the end; 0: none")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--fix", options->fix,
                    "write the udev rule that lets you open devices; asks first");
  command->add_flag("--yes", options->yes, "do not ask")->needs("--fix");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{72, add};

}  // namespace
}  // namespace burr::app
