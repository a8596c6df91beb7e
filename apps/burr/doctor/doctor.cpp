// burr doctor - why does my device not work, and what can I do? It checks every kind of hand, then
// the computer, and each line ends with advice.
//
// The exit code is 0 when it could check, whatever it found. Nothing moves, and only --fix changes
// anything.
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/machine_trial.h"
#include "doctor/doctor_checks.h"
#include "doctor/fix.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  double seconds = 10;
  bool json = false, fix = false, yes = false, print_rule = false;
};

Answer agreed(const std::string& rules) {
  fmt::print("{}", rules);
  return Answer::yes;
}

// Asks at the terminal, if there is one.
Answer ask(const std::string& rules) {
  fmt::print("{}", rules);
  if (isatty(STDIN_FILENO) == 0) return Answer::nobody;
  fmt::print("Write it? [y/N] ");
  std::fflush(stdout);
  const int letter = std::getchar();
  return letter == 'y' || letter == 'Y' ? Answer::yes : Answer::no;
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
  if (options.print_rule) {
    fmt::print("{}", udev_rules());
    return fine();
  }
  if (options.fix) {
    const auto said = write_rules(system, options.yes ? agreed : ask);
    if (!said) return said.error();
    fmt::print("{}\n", *said);
    return fine();
  }
  std::vector<Finding> findings = look_at_devices(system);  // first, because it forks
  for (auto* look : {&look_at_nodes, &look_at_pads, &look_at_screen, &look_at_machine})
    for (Finding& one : look(system)) findings.push_back(std::move(one));

  nlohmann::json trial;
  std::string verdict;
  if (options.seconds > 0) {
    MachineTrial requested;
    requested.seconds = options.seconds;
    const auto measured = measure_machine(requested);
    Finding tried{"trial", fmt::format("{:g} seconds", options.seconds), Health::trouble, "", ""};
    if (!measured) {
      if (measured.error().trouble == Trouble::interrupted) return measured.error();
      tried.value = in_options(measured.error()).text;
      tried.todo = "burr check repeats the trial";
    } else {
      const rt::TickSummary& t = measured->seen.milling_loaded;
      const rt::MachineReport judged = rt::judge(measured->seen);
      verdict = rt::name(judged.verdict);
      tried.health = judged.verdict == rt::Verdict::not_enough ? Health::trouble : Health::good;
      tried.value = fmt::format(
          "milling with everything else at work: a tick took {:.0f} us (p99.9), began {:.0f} us "
          "late (p99.9), {:.1f} ms late at worst; {} of {} left out. {}",
          t.p999_us, t.late_p999_us, 1e-3 * t.worst_lateness_us, t.missed, t.ticks + t.missed,
          judged.sentence);
      if (judged.verdict != rt::Verdict::good)
        tried.todo = "see the lines marked !! above; burr check measures longer";
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
    fmt::print("{}\n", json_line(out));
    return fine();
  }
  fmt::print(
      "{}\nburr can be controlled here with: {}.{}\n", text_of(findings), usable(findings),
      verdict.empty() ? "" : fmt::format(" This computer is {} for a haptic device.", verdict));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("doctor", "find out why a device does not work, and what to do");
  command->add_option("--seconds", options->seconds, "length of the tick trial at the end; 0: none")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--fix", options->fix,
                    "write the udev rule that allows you to open devices; burr asks first");
  command->add_flag("--print-rule", options->print_rule, "print that rule, and do nothing else");
  command->add_flag("--yes", options->yes, "do not ask")->needs("--fix");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{72, add};

}  // namespace
}  // namespace burr::app
