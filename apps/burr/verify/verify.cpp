// burr verify - measures everything that burr claims about touch: one line per check, all series as
// CSV, one report.
// one report.
#include "verify.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <tuple>

#include "commands/command.h"
#include "commands/interrupt.h"
#include "page.h"

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
  bool quick = false, json = false;
};

Status run(const Options& options) {
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
    one.work({options.quick, options.data}, part);
    part.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.json) continue;
    for (const Check& check : part.checks) fmt::print("{}\n", VerifyReport::line(check));
    for (const std::string& sentence : part.left_out) fmt::print("not checked: {}\n", sentence);
    std::fflush(stdout);
  }
  if (!options.out.empty())
    if (Status written = report.write(options.out, page(report)); !written) return written;
  if (options.json) {
    fmt::print("{}\n", report.json());
  } else {
    fmt::print("{} checks, {} failed{}\n", report.checks(), report.failed(),
               options.out.empty() ? "" : fmt::format("; {}/report.html", options.out));
  }
  if (interrupted()) return error(Trouble::interrupted, "stopped; the checks so far are kept");
  if (report.failed() > 0)
    return error(Trouble::failed,
                 fmt::format("{} of {} checks failed", report.failed(), report.checks()));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
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
  command->add_option("--data", options->data,
                      "DIR: folder of the real bones (docs/validation.md); default: none");
  command->add_option(
      "--out", options->out,
      "DIR: write report.html, every series as CSV, verify.json and validation.md there");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{50, add};

}  // namespace

VerifyPart::VerifyPart(int place, const char* name, const char* title, const char* about,
                       Work work) {
  known().push_back({place, name, title, about, work});
}

}  // namespace burr::app
