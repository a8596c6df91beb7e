// `burr fit`: constants of materials from force logs, with 95 % intervals.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/fit/laws.h"
#include "burr/fit/recorded_log.h"
#include "burr/importing/materials.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  std::vector<std::string> logs;
  std::string out, material, date;
  double window_ms = 50;
  bool json = false;
};

std::string short_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

const importing::MaterialField& field_of(const fit::Fitted& constant) {
  const auto fields = importing::material_fields();
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const importing::MaterialField& one) {
        return std::string_view(one.key) == constant.key;
      });
  BURR_CHECK(found != fields.end());
  return *found;
}

std::string shown_name(const fit::MaterialFit& fit) {
  return fit.material.empty() ? "(material not named)" : base::printable(fit.material);
}

// "2026-11-22"; Error: what is wrong with the date.
Result<std::string> date_of(const std::string& given) {
  namespace time = std::chrono;
  const auto text = [](const time::year_month_day& day) {
    return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()),
                       static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
  };
  if (given.empty()) return text(time::floor<time::days>(time::system_clock::now()));
  int year = 0;
  unsigned month = 0, day = 0;
  char more = 0;
  if (std::sscanf(given.c_str(), "%4d-%2u-%2u%c", &year, &month, &day, &more) == 3) {
    const time::year_month_day date{time::year(year), time::month(month), time::day(day)};
    if (date.ok() && text(date) == given) return given;
  }
  return error(Trouble::usage, fmt::format("--date: \"{}\" is not a date; write it as 2026-11-22",
                                           base::printable(given)));
}

Result<fit::ForceLog> read_log(const Options& options, const std::string& path) {
  if (std::filesystem::path(path).extension() == ".mcap") {
    auto player = record::Player::open(path);
    if (!player) return player.error();
    return fit::log_of_recording(**player, 1e-3 * options.window_ms, options.material);
  }
  auto log = fit::read_force_log(path);
  // rows without a material get the one given on the command line
  if (log)
    for (std::string& name : log->materials)
      if (name.empty()) name = options.material;
  return log;
}

void print(const std::vector<fit::MaterialFit>& fits) {
  for (const fit::MaterialFit& fit : fits) {
    fmt::print("{}: {} rows used, {} rows without cutting left out\n", shown_name(fit), fit.rows,
               fit.left_out);
    if (!fit.constants.empty())
      fmt::print("  {:<22} {:>10}  {:^23} {:<7} {:>7}  {}\n", "constant", "estimate",
                 "95 % interval", "unit", "rows", "residual");
    for (const fit::Fitted& one : fit.constants) {
      const importing::MaterialField& field = field_of(one);
      fmt::print("  {:<22} {:>10.4g}  {:>10.4g} to {:<10.4g} {:<7} {:>7}  {:.3g} {}\n", one.key,
                 one.value / field.si, (one.value - one.half) / field.si,
                 (one.value + one.half) / field.si, field.unit, one.rows, one.residual,
                 one.residual_unit);
    }
    for (const std::string& sentence : fit.undetermined)
      fmt::print("  not determined: {}\n", sentence);
  }
}

nlohmann::json to_json(const Options& options, const fit::ForceLog& log,
                       const std::vector<fit::MaterialFit>& fits) {
  nlohmann::json out;
  for (const std::string& path : options.logs) out["logs"].push_back(short_name(path));
  out["notices"] = in_options(log.notices);
  for (const fit::MaterialFit& fit : fits) {
    nlohmann::json one = {{"material", fit.material},
                          {"rows_used", fit.rows},
                          {"rows_left_out", fit.left_out},
                          {"constants", nlohmann::json::object()},
                          {"not_told", fit.undetermined}};
    for (const fit::Fitted& c : fit.constants) {
      const double si = field_of(c).si;
      one["constants"][c.key] = {
          {"value", c.value / si},           {"low", (c.value - c.half) / si},
          {"high", (c.value + c.half) / si}, {"rows", c.rows},
          {"residual", c.residual},          {"residual_unit", c.residual_unit}};
    }
    out["materials"].push_back(one);
  }
  return out;
}

// Writes a file that `burr materials --materials` and every volume can read. Constants that are not
// above 0 are noise and are left out.
Status write(const Options& options, const std::string& date,
             const std::vector<fit::MaterialFit>& fits) {
  std::string names;
  for (const std::string& path : options.logs)
    names += (names.empty() ? "" : ", ") + base::printable(short_name(path));
  std::vector<importing::Material> materials;
  for (const fit::MaterialFit& fit : fits) {
    if (fit.constants.empty()) continue;
    if (fit.material.empty())
      return error(Trouble::usage,
                   "--out: the log does not name the material; name it with --material");
    importing::Material& material = materials.emplace_back();
    material.name = fit.material;
    for (const fit::Fitted& one : fit.constants) {
      const importing::MaterialField& field = field_of(one);
      if (!(one.value > 0)) {
        fmt::print(stderr, "{}: {} is not above 0 and is left out of {}\n", shown_name(fit),
                   one.key, options.out);
        continue;
      }
      material.*(field.place) =
          importing::Constant{one.value, std::max(0.0, one.value - one.half), one.value + one.half,
                              fmt::format("burr fit {}, {}, {} rows", names, date, one.rows), true};
    }
  }
  // check that burr can read what it writes
  const std::string text = importing::materials_toml(materials);
  const auto again =
      importing::parse_materials(text, short_name(options.out), importing::built_in_materials());
  if (!again)
    return error(fmt::format("the fitted constants are no valid material: {}", again.error().text));
  auto file = base::NewFile::create(options.out, base::kForAll);
  if (!file) return file.error();
  file->write(text);
  return file->put_in_place();
}

Status run(const Options& options) {
  auto date = date_of(options.date);
  if (!date) return date.error();
  const Status possible = check_outputs(options.logs, {{"--out", options.out, {".toml"}}});
  if (!possible) return possible;
  fit::ForceLog log;
  for (const std::string& path : options.logs) {
    auto one = read_log(options, path);
    if (!one) return one.error();
    log.append(*one);
  }
  print_notices(log.notices);
  const std::vector<fit::MaterialFit> fits = fit::fit_laws(log);
  bool any = false;
  for (const fit::MaterialFit& fit : fits) any = any || !fit.constants.empty();
  if (options.json)
    fmt::print("{}\n", json_line(to_json(options, log, fits)));
  else
    print(fits);
  if (!any) {
    const std::string why = fits.empty() || fits.front().undetermined.empty()
                                ? std::string("nothing was cut in it")
                                : fits.front().undetermined.front();
    return error(fmt::format("{}: no constant can be determined: {}",
                             short_name(options.logs.front()), why));
  }
  return options.out.empty() ? fine() : write(options, *date, fits);
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("fit", "fit the constants of a material to force logs");
  auto options = std::make_shared<Options>();
  command->add_option("logs", options->logs, "force logs: .csv, or recordings .mcap")->required();
  command->add_option("--out", options->out,
                      "F.toml: write the constants as a table for --materials");
  command->add_option("--material", options->material,
                      "name of the material, if the log does not name it");
  command->add_option("--date", options->date, "date of the measurement (default: today)");
  command
      ->add_option("--window-ms", options->window_ms,
                   "for recordings: length of the interval that one row averages")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{64, add};

}  // namespace
}  // namespace burr::app
