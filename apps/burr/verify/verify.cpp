// burr verify - measures everything that burr claims about touch: one line per check, all series as
// CSV, one report.
// one report.
#include "verify.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "batch/row_command.h"
#include "page.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify_law.h"

namespace burr::app {
namespace {

struct Known {
  int place;
  const char *name, *title, *about;
  VerifyPart::Work work;
};

std::vector<Known>& known() {
  static std::vector<Known> all;
  return all;
}

struct Options {
  std::vector<std::string> names;
  std::string out, data;
  std::uint64_t seed = 0;
  bool quick = false, json = false;
};

// The findings of a row: without the times of the parts.
CommandResult result_of(const VerifyReport& report) {
  CommandResult findings;
  findings.result = nlohmann::json::parse(report.json());
  for (nlohmann::json& part : findings.result["parts"]) {
    findings.times["took_s"][part["name"].get<std::string>()] = part["took_s"];
    part.erase("took_s");
  }
  return findings;
}

// given: takes the findings, in which a check that failed is a result; nullptr: all is printed.
Status run(const Options& options, CommandResult* given) {
  std::vector<Known> parts = known();
  std::sort(parts.begin(), parts.end(),
            [](const Known& a, const Known& b) { return a.place < b.place; });
  VerifyReport report;
  // report a folder that cannot be written now, not after minutes
  if (!options.out.empty())
    if (Status written = report.write(options.out, page(report)); !written) return written;
  for (const Known& one : parts) {
    if (!options.names.empty() &&
        std::find(options.names.begin(), options.names.end(), one.name) == options.names.end())
      continue;
    if (interrupted()) break;
    progress().report(0, one.name);
    const auto start = std::chrono::steady_clock::now();
    VerifyReport::Part& part = report.begin(one.name, one.title, one.about);
    one.work({options.quick, options.data, options.seed}, part);
    part.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.json || given != nullptr) continue;
    for (const Check& check : part.checks) fmt::print("{}\n", VerifyReport::line(check));
    for (const std::string& sentence : part.left_out) fmt::print("not checked: {}\n", sentence);
    std::fflush(stdout);
  }
  if (!options.out.empty())
    if (Status written = report.write(options.out, page(report)); !written) return written;
  if (given != nullptr) {
    *given = result_of(report);
  } else if (options.json) {
    fmt::print("{}\n", report.json());
  } else {
    fmt::print("{} checks, {} failed{}\n", report.checks(), report.failed(),
               options.out.empty() ? "" : fmt::format("; {}/report.html", options.out));
  }
  if (interrupted()) return error(Trouble::interrupted, "stopped; the checks so far are kept");
  if (report.failed() > 0 && given == nullptr)
    return error(Trouble::failed,
                 fmt::format("{} of {} checks failed", report.failed(), report.checks()));
  return fine();
}

// chosen: gets the options when they were parsed.
CLI::App* add_verify(CLI::App& app,
                     const std::function<void(std::shared_ptr<const Options>)>& chosen) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("verify", "check touch and cutting against known results");
  std::vector<std::string> names;
  for (const Known& one : known()) names.emplace_back(one.name);
  std::sort(names.begin(), names.end());
  command
      ->add_option("names", options->names,
                   fmt::format("parts to check (default: all): {}", fmt::join(names, ", ")))
      ->check(CLI::IsMember(names));
  command->add_flag("--quick", options->quick,
                    "finish within a minute: one resolution, short strokes");
  command->add_option(
      "--seed", options->seed,
      "seed of what is drawn at random in safety and bones (default: the usual one)");
  command->add_option(
      "--data", options->data,
      "DIR: folder of the real bones (docs/understand/validation.md); default: none");
  command->add_option(
      "--out", options->out,
      "DIR: write report.html, every series as CSV, verify.json and validation.md there");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, chosen, command] {
    if (command->get_subcommands().empty()) chosen(options);
  });
  return command;
}

void add(CLI::App& app, Todo& todo) {
  auto* command = add_verify(
      app, [&todo](auto options) { todo.work = [options] { return run(*options, nullptr); }; });
  add_verify_law(*command, todo);
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_verify(app, [&todo](auto options) {
    todo.work = [options](CommandResult& findings) { return run(*options, &findings); };
  });
}

const Command command{50, add};
const RowCommand row_command{"verify", add_row};

}  // namespace

VerifyPart::VerifyPart(int place, const char* name, const char* title, const char* about,
                       Work work) {
  known().push_back({place, name, title, about, work});
}

}  // namespace burr::app
