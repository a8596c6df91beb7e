// `burr batch`: does the rows of a manifest that belong to one shard, each once, so that thousands of sessions can be spread over
// the processors of a cluster by whatever starts programs there.
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "batch/child.h"
#include "batch/manifest.h"
#include "batch/result_files.h"
#include "batch/row.h"
#include "burr/base/printable.h"
#include "burr/rt/simd.h"
#include "burr/workshop/bone_cache.h"
#include "shared/console.h"
#include "shared/counted.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

struct Options {
  std::string manifest, shard = "0/1", out, cache;
  double seconds_left = 0;
  bool finish = false, record = false, dry_run = false, json = false;
};

constexpr int kCannotWrite = static_cast<int>(Trouble::io);

struct Tally {
  std::size_t rows = 0, before = 0, done = 0, refused = 0, left = 0;
};

// What all rows of a shard have in common.
struct Batch {
  const Options& options;
  const Manifest& manifest;
  ResultFiles files;
  nlohmann::json engine = this_engine();
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  gmtime_r(&now, &parts);
  std::array<char, 32> text = {};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text.data(), size};
}

nlohmann::json times_of(const ManifestRow& row, const CommandResult& findings,
                        const std::string& began, Clock::time_point start) {
  std::array<char, 256> host = {};
  static_cast<void>(gethostname(host.data(), host.size() - 1));
  rusage used = {};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {{"id", row.id},
          {"host", host.data()},
          {"isa", rt::name(rt::simd())},
          {"began", began},
          {"wall_s", seconds_since(start)},
          {"cpu_s", seconds(used.ru_utime) + seconds(used.ru_stime)},
          {"peak_mb", static_cast<double>(used.ru_maxrss) / 1024},
          {"times", findings.times}};
}

Status write_failure(const Batch& batch, const ManifestRow& row, int code,
                     const std::string& sentence) {
  return ResultFiles::write(batch.files.failure(row.id), {{"code", code},
                                                          {"engine", batch.engine},
                                                          {"id", row.id},
                                                          {"inputs", batch.manifest.inputs(row)},
                                                          {"manifest", batch.manifest.hash},
                                                          {"sentence", sentence}});
}

// The times come first: where there is a result, there are its times.
Status write_result(const Batch& batch, const ManifestRow& row, const CommandResult& findings,
                    const nlohmann::json& times) {
  if (const Status written = ResultFiles::write(batch.files.times(row.id), times); !written)
    return written;
  const Status written =
      ResultFiles::write(batch.files.result(row.id), {{"engine", batch.engine},
                                                      {"id", row.id},
                                                      {"inputs", batch.manifest.inputs(row)},
                                                      {"manifest", batch.manifest.hash},
                                                      {"result", findings.result}});
  if (!written) return written;
  std::error_code nobody_asks;
  fs::remove(batch.files.failure(row.id), nobody_asks);
  return fine();
}

// In the child. Returns its exit code: 0, 65, 75; 74: nothing can be written; 130, 143: stopped.
int work_on(const Batch& batch, const ManifestRow& row) {
  quiet() = true;
  const auto start = Clock::now();
  const std::string began = now_utc();
  std::vector<std::string> more;
  if (batch.options.record && (row.command == "mill" || row.command == "surgeon")) {
    const fs::path file = batch.files.recording(row.id);
    std::error_code trouble;
    fs::create_directories(file.parent_path(), trouble);
    more = {"--record=" + file.string(), "--force"};
  }
  const auto findings = do_row(batch.manifest, row, more);
  if (!findings && findings.error().trouble == Trouble::interrupted) return stopped_code();
  const Status written =
      findings ? write_result(batch, row, *findings, times_of(row, *findings, began, start))
               : write_failure(batch, row, static_cast<int>(findings.error().trouble),
                               findings.error().text);
  if (!written) {
    std::fprintf(stderr, "burr: %s\n", written.error().text.c_str());
    return kCannotWrite;
  }
  if (findings) return 0;
  std::fprintf(stderr, "burr: %s: %s\n", row.id.c_str(), findings.error().text.c_str());
  return findings.error().trouble == Trouble::data ? static_cast<int>(Trouble::data)
                                                   : static_cast<int>(kTryAgain);
}

// The rows of the shard that are not done yet. Error: a file in DIR comes from another row of that id.
Result<std::vector<const ManifestRow*>> rows_to_do(const Batch& batch, const Shard& shard,
                                                   Tally& tally) {
  std::vector<const ManifestRow*> rows;
  for (const ManifestRow& row : batch.manifest.rows) {
    if (!belongs(row, shard)) continue;
    ++tally.rows;
    const auto inputs = batch.manifest.inputs(row);
    const auto result = ResultFiles::read(batch.files.result(row.id));
    if (!result) return result.error();
    if (*result && (**result)["inputs"] != inputs)
      return error(fmt::format(
          "{}: was made from another row of this id; use another --out, another id in {}, or "
          "delete the file",
          base::printable(batch.files.result(row.id).string()), batch.manifest.place(row.line)));
    if (*result) {
      ++tally.before;
      continue;
    }
    const auto failure = ResultFiles::read(batch.files.failure(row.id));
    if (!failure) return failure.error();
    // the same row and the same program: it will be refused again
    if (*failure && (**failure).value("code", 0) == static_cast<int>(Trouble::data) &&
        (**failure)["inputs"] == inputs &&
        (**failure).value("engine", nlohmann::json()) == batch.engine)
      ++tally.refused;
    else
      rows.push_back(&row);
  }
  return rows;
}

Status print_tally(const Options& options, const Tally& tally) {
  if (options.json)
    fmt::print("{}\n", json_line(nlohmann::json{{"shard", options.shard},
                                                {"rows", tally.rows},
                                                {"done_before", tally.before},
                                                {"done", tally.done},
                                                {"refused", tally.refused},
                                                {"left", tally.left}}));
  else
    fmt::print("shard {}: {}: {} done before, {} done now, {} refused, {} left\n", options.shard,
               counted(tally.rows, "row"), tally.before, tally.done, tally.refused, tally.left);
  const std::string left = tally.left == 1
                               ? "1 row of this shard is left"
                               : fmt::format("{} rows of this shard are left", tally.left);
  if (asked_to_end())
    return error(Trouble::interrupted, fmt::format("stopped; {}, the same command goes on", left));
  if (tally.left > 0)
    return error(kTryAgain,
                 fmt::format("{}, and may do at another time: {}/failed says why; the same command "
                             "tries again",
                             left, base::printable(options.out)));
  return fine();
}

// Does a row and counts it. false: no further one.
Result<bool> do_one(const Batch& batch, const ManifestRow& row, double longest_s, Tally& tally) {
  const auto end = in_child([&] {
    if (batch.options.finish && longest_s > 0) grant_time(longest_s, batch.options.seconds_left);
    return work_on(batch, row);
  });
  if (!end) return end.error();
  if (end->signal != 0) {  // it could say nothing itself
    const Status written = write_failure(
        batch, row, static_cast<int>(kTryAgain),
        end->signal == SIGKILL
            ? "was killed from outside, perhaps because memory ran out; ask for more (`burr batch "
              "--dry-run` says how much)"
            : fmt::format("burr crashed ({}); please report it", strsignal(end->signal)));
    if (!written) return written.error();
  }
  if (end->code == 0 && end->signal == 0) {
    ++tally.done;
    --tally.left;
  } else if (end->code == static_cast<int>(Trouble::data)) {
    ++tally.refused;
    --tally.left;
  } else if (end->code == kCannotWrite) {
    return error(kTryAgain, "results cannot be written; mend that, the same command goes on");
  }
  return !asked_to_end();
}

// What decides how much memory a row needs.
std::string kind_of(const Manifest& manifest, const ManifestRow& row) {
  constexpr std::array<std::string_view, 10> kDecide = {
      "command", "case", "volume", "bone", "series", "spacing", "roi", "voxel-mm", "iso", "labels"};
  std::string kind;
  const nlohmann::json inputs = manifest.inputs(row);
  for (const auto& [name, value] : inputs.items())
    if (std::find(kDecide.begin(), kDecide.end(), name) != kDecide.end())
      kind += fmt::format("{}{} {}", kind.empty() ? "" : ", ", name, value.get<std::string>());
  return kind;
}

// Says what is wrong with rows of the shard, and how much memory each kind needs, and does nothing. Each kind of bone is opened
// once, and is in the cache then.
Status dry_run(const Options& options, const Manifest& manifest, const Shard& shard) {
  std::size_t rows = 0, wrong = 0;
  double most = 0;
  std::map<std::string, bool> kinds;  // opened already
  for (const ManifestRow& row : manifest.rows) {
    if (interrupted()) return error(Trouble::interrupted, "stopped");
    if (!belongs(row, shard)) continue;
    ++rows;
    const auto todo = todo_of(manifest, row);
    if (todo && todo->memory_mb && kinds.emplace(kind_of(manifest, row), true).second) {
      const auto needed = todo->memory_mb();
      const double recorder = options.record ? 30 : 0;  // its rings [MB]
      if (needed) fmt::print("{}: {:.0f} MB\n", kind_of(manifest, row), *needed + recorder);
      if (needed) most = std::max(most, *needed + recorder);
      if (!needed) fmt::print("{}: {}\n", manifest.place(row.line), needed.error().text);
      wrong += needed ? 0 : 1;
    }
    if (todo) continue;
    ++wrong;
    fmt::print("{}\n", todo.error().text);
  }
  fmt::print("{} of {} in this shard, {} that cannot be done", counted(rows, "row"),
             manifest.rows.size(), wrong);
  if (most > 0) fmt::print("; the largest needs {:.0f} MB", most);
  fmt::print("\n");
  if (wrong == 0) return fine();
  return error(fmt::format("{} cannot be done; the lines above say why",
                           wrong == 1 ? "1 row" : fmt::format("{} rows", wrong)));
}

Status run(const Options& options) {
  const auto shard = shard_of(options.shard);
  if (!shard) return shard.error();
  if (options.finish && options.seconds_left <= 0)
    return error(Trouble::usage,
                 "--finish needs --seconds-left: how long the program may go on "
                 "after SIGTERM");
  auto manifest = read_manifest(options.manifest);
  if (!manifest) return manifest.error();
  if (const Status known = check_columns(*manifest); !known) return known;
  workshop::keep_bones_in(options.cache, this_engine().dump());
  if (options.dry_run) return dry_run(options, *manifest, *shard);
  if (options.out.empty())
    return error(Trouble::usage, "--out: is missing; name the folder of the results");
  const Batch batch{options, *manifest, ResultFiles(options.out)};
  Tally tally;
  const auto rows = rows_to_do(batch, *shard, tally);
  if (!rows) return rows.error();
  tally.left = rows->size();
  std::map<std::string, double> longest_s;  // of each command
  for (const ManifestRow* row : *rows) {
    if (asked_to_end()) break;
    progress().report(
        static_cast<double>(tally.rows - tally.left) / static_cast<double>(tally.rows), "rows");
    const auto start = Clock::now();
    double& longest = longest_s[row->command];
    const auto more = do_one(batch, *row, longest, tally);
    if (!more) return more.error();
    if (!*more) break;
    longest = std::max(longest, seconds_since(start));
  }
  if (tally.left == 0) progress().report(1, "rows");
  return print_tally(options, tally);
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "batch", "do the rows of a manifest: thousands of sessions, in shards, on many machines");
  command
      ->add_option("--manifest", options->manifest,
                   "M.csv: one row for each session; `command` and its options are the columns")
      ->required();
  command
      ->add_option("--shard", options->shard,
                   "K/N: only the rows of part K of N, K from 0; a row's part follows from its id")
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "DIR: folder of the results; what is done there already is not done again");
  command->add_flag("--record", options->record,
                    "record each session of mill and surgeon into DIR/recordings");
  command->add_option(
      "--cache", options->cache,
      "DIR: keep prepared bones (of scans, and other bones of cases) for all shards");
  command
      ->add_option("--seconds-left", options->seconds_left,
                   "with --finish: the time from SIGTERM to the kill that follows [s]")
      ->check(CLI::Range(1.0, 86'400.0));
  command->add_flag("--finish", options->finish,
                    "at SIGTERM finish the row if the longest one so far would end in time");
  command->add_flag("--dry-run", options->dry_run,
                    "do nothing: say which rows cannot be done, and how much memory a row needs");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{68, add};

}  // namespace
}  // namespace burr::app
