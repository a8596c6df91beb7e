// burr repair - makes a complete recording from an incomplete one.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "burr/record/repair.h"
#include "shared/front_words.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace {

using namespace burr;

struct Options {
  std::string path, out;
  bool force = false;
};

Status run(const Options& options) {
  if (const Status possible =
          app::check_outputs({options.path}, {{"--out", options.out, {".mcap"}}}, options.force);
      !possible)
    return possible;
  const std::string& out = options.out.empty() ? options.path : options.out;
  const auto report = record::repair(options.path, out, app::progress());
  if (!report) return report.error();
  app::print_notices(report->notices, stdout);
  if (report->was_whole) {
    fmt::print("{}: is complete, nothing to repair ({} ticks, {:.3f} s)\n", options.path,
               report->ticks, report->seconds);
    return fine();
  }
  fmt::print("{}: kept {} ticks, up to {:.3f} s, in {} chunks; {} bytes were lost\n", out,
             report->ticks, report->seconds, report->chunks, report->lost_bytes);
  return fine();
}

void add(CLI::App& app, app::Todo& todo) {
  auto* command = app.add_subcommand("repair", "repair an incomplete recording");
  auto options = std::make_shared<Options>();
  command->add_option("recording", options->path, "the recording (.mcap)")->required();
  command->add_option("--out", options->out,
                      "write the repaired recording here and leave the original unchanged");
  app::add_force(*command, options->force);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const app::Command command{60, add};

}  // namespace
