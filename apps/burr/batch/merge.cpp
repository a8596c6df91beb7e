// `burr merge`: one table of the results of all shards, or the list of what is missing.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <unordered_set>
#include <utility>
#include <vector>

#include "batch/canonical.h"
#include "batch/manifest.h"
#include "batch/merged.h"
#include "batch/result_files.h"
#include "batch/row.h"
#include "burr/base/printable.h"
#include "shared/counted.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  std::string folder, manifest, out, sqlite;
  bool mixed = false;
};

// What was found in DIR, and what is wrong with it, one line each.
struct Gathered {
  Merged merged;
  std::vector<std::string> missing, foreign;
  std::map<std::string, std::size_t> engines;  // how many results each made
  std::size_t refused = 0, earlier = 0;        // earlier: made when the manifest was another one
};

// Takes a row's result, or why it was refused. false: it has neither.
Result<bool> take(const ResultFiles& files, const Manifest& manifest, const ManifestRow& row,
                  Gathered& out) {
  const auto inputs = manifest.inputs(row);
  MergedRow& one = out.merged.rows.emplace_back();
  const auto result = ResultFiles::read(files.result(row.id));
  if (!result) return result.error();
  if (*result) {
    const nlohmann::json& found = **result;
    if (found["inputs"] != inputs) {
      out.foreign.push_back(
          fmt::format("{}: was made from another row than {}", row.id, manifest.place(row.line)));
      return true;
    }
    ++out.engines[canonical(found.value("engine", nlohmann::json()))];
    if (found.value("manifest", "") != manifest.hash) ++out.earlier;
    one.found = flat(found.value("result", nlohmann::json::object()));
    return true;
  }
  const auto failure = ResultFiles::read(files.failure(row.id));
  if (!failure) return failure.error();
  if (!*failure || (**failure)["inputs"] != inputs) return false;
  one.code = (**failure).value("code", 0);
  one.sentence = (**failure).value("sentence", "");
  if (one.code != static_cast<int>(Trouble::data)) return false;
  ++out.refused;
  return true;
}

Result<Gathered> gather(const ResultFiles& files, const Manifest& manifest,
                        const ResultFiles::Found& found) {
  Gathered out{.merged = {.manifest = manifest, .rows = {}, .engines = {}},
               .missing = {},
               .foreign = {},
               .engines = {}};
  out.merged.rows.reserve(manifest.rows.size());
  std::unordered_set<std::string> known;
  for (const ManifestRow& row : manifest.rows) {
    known.insert(row.id);
    const auto there = take(files, manifest, row, out);
    if (!there) return there.error();
    if (!*there) {
      const std::string& why = out.merged.rows.back().sentence;
      out.missing.push_back(row.id + (why.empty() ? "" : ": " + why));
    }
  }
  for (const std::string& id : found.results)
    if (known.count(id) == 0)
      out.foreign.push_back(fmt::format("{}: is no row of {}", id, manifest.file));
  for (const auto& [engine, count] : out.engines)
    out.merged.engines.push_back(nlohmann::json::parse(engine, nullptr, false));
  return out;
}

// Prints what is wrong, and says it in a sentence.
Status judged(const Gathered& gathered, const Options& options) {
  for (const std::string& line : gathered.missing) fmt::print("missing {}\n", line);
  for (const std::string& line : gathered.foreign) fmt::print("foreign {}\n", line);
  if (gathered.engines.size() > 1)
    for (const auto& [engine, count] : gathered.engines)
      fmt::print("{} by {}\n", counted(count, "result"), engine);
  const std::string where = base::printable(options.folder);
  if (!gathered.foreign.empty())
    return error(fmt::format(
        "{}: {} not of this manifest; the lines above say which: delete them, or "
        "name the manifest that they were made from",
        where,
        gathered.foreign.size() == 1 ? "1 result is"
                                     : fmt::format("{} results are", gathered.foreign.size())));
  if (!gathered.missing.empty())
    return error(
        kTryAgain,
        fmt::format("{}: {} missing; the lines above say which, and `burr batch` does them", where,
                    gathered.missing.size() == 1
                        ? "1 row is"
                        : fmt::format("{} rows are", gathered.missing.size())));
  if (gathered.engines.size() > 1 && !options.mixed)
    return error(
        fmt::format("{}: the results come from {} builds of burr, and only one build gives "
                    "equal bits; do the rows again with one, or allow it with --mixed",
                    where, gathered.engines.size()));
  return fine();
}

Status run(const Options& options) {
  if (const Status possible = check_outputs(
          {options.manifest},
          {{"--out", options.out, {".csv"}}, {"--sqlite", options.sqlite, {".sqlite"}}});
      !possible)
    return possible;
  std::error_code nobody_asks;
  if (!std::filesystem::is_directory(options.folder, nobody_asks))
    return error(Trouble::io, fmt::format("{}: is no folder; name the --out of `burr batch`",
                                          base::printable(options.folder)));
  const auto manifest = read_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const ResultFiles files(options.folder);
  const auto found = files.look();
  if (!found) return found.error();
  const auto gathered = gather(files, *manifest, *found);
  if (!gathered) return gathered.error();
  if (const Status good = judged(*gathered, options); !good) return good;
  if (const Status written = write_csv(gathered->merged, options.out); !written) return written;
  if (!options.sqlite.empty())
    if (const Status written = write_sqlite(gathered->merged, options.sqlite); !written)
      return written;
  // all is there, so nobody needs what killed processes left
  for (const auto& file : found->remains) std::filesystem::remove(file, nobody_asks);
  if (gathered->earlier > 0)
    fmt::print(stderr, "{} made when the manifest was another one; their rows are the same\n",
               gathered->earlier == 1 ? "1 result was"
                                      : fmt::format("{} results were", gathered->earlier));
  fmt::print("{}: {}, {} of them refused\n", base::printable(options.out),
             counted(manifest->rows.size(), "row"), gathered->refused);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("merge", "one table of the results of `burr batch`");
  command->add_option("folder", options->folder, "DIR: the --out of `burr batch`")->required();
  command->add_option("--manifest", options->manifest, "M.csv: the manifest of the batch")
      ->required();
  command->add_option("--out", options->out, "R.csv: the table")->required();
  command->add_option("--sqlite", options->sqlite, "R.sqlite: the same as a database");
  command->add_flag("--mixed", options->mixed, "allow results of several builds of burr");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{69, add};

}  // namespace
}  // namespace burr::app
