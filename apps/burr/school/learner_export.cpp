#include "school/learner_export.h"

#include <fmt/core.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/io/write/zip.h"
#include "burr/report/marked.h"
#include "burr/report/report_page.h"
#include "burr/school/export.h"
#include "burr/school/forget.h"
#include "burr/school/sessions.h"
#include "burr/school/store.h"
#include "burr/school/uuid.h"
#include "school/store_command.h"
#include "shared/counted.h"
#include "shared/front_words.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using Options = LearnerOptions;

Status write_csv(const Options& options, school::Store& store) {
  const auto files = school::all_tables(store);
  if (!files) return files.error();
  std::error_code trouble;
  fs::create_directories(options.csv, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("--csv {}: cannot make this folder ({})",
                                          base::printable(options.csv), trouble.message()));
  for (const school::TextFile& one : *files) {
    auto file = base::NewFile::create((fs::path(options.csv) / one.name).string());
    if (!file) return file.error();
    file->write(one.text);
    if (const Status written = file->put_in_place(); !written) return written;
  }
  fmt::print("{}: {}, pseudonyms only\n", base::printable(options.csv, 300),
             counted(files->size(), "table"));
  print_json(options.json, {{"tables", files->size()}});
  return fine();
}

// A page for each recording that is there.
void add_reports(const Options& options, const std::vector<school::SessionRow>& sessions,
                 std::vector<school::TextFile>& files, std::vector<std::string>& missing) {
  speak(options.language);
  for (const school::SessionRow& one : sessions) {
    const std::string path = school::path_of(one.recording_uri);
    std::error_code nobody_asks;
    if (path.empty() || !fs::exists(path, nobody_asks)) {
      missing.push_back(one.recording_uri);
      continue;
    }
    // a report of what has its name now may be of somebody else
    if (const auto hash = school::sha1_of_file(path); !hash || *hash != one.recording_hash) {
      missing.push_back(one.recording_uri + " (another file has its name now)");
      continue;
    }
    const auto report = report::marked(path, "", {}, progress());
    if (report)
      files.push_back(
          {fmt::format("report_{}_{}.html", day_of(one.started_ms), one.id.substr(0, 8)),
           report::page_of(*report)});
    else
      missing.push_back(fmt::format("{} ({})", one.recording_uri, in_options(report.error()).text));
  }
}

Status write_zip(const std::string& path, const std::vector<school::TextFile>& files) {
  auto file = base::NewFile::create(path);  // it may hold a name
  if (!file) return file.error();
  io::Zip zip(*file);
  for (const school::TextFile& one : files)
    zip.add(one.name, [&one](io::Deflate& to) {
      to.write(one.text.data(), one.text.size());
      return true;
    });
  if (!zip.finish()) return error(Trouble::io, path + ": larger than 4 GB; use --no-reports");
  return file->put_in_place();
}

}  // namespace

Status export_learners(const LearnerOptions& options) {
  if (options.all != options.id.empty() || options.all == options.csv.empty())
    return error(Trouble::usage, "use `burr learner export ID --out F.zip`, or `--all --csv DIR`");
  if (const Status possible = check_outputs({}, {{"--out", options.out, {".zip"}}}); !possible)
    return possible;
  if (!options.all && options.out.empty())
    return error(Trouble::usage, "--out is missing: F.zip, the file to write");
  auto store = open_store(options);
  if (!store) return store.error();
  if (options.all) return write_csv(options, **store);
  auto files = school::tables_of(**store, options.id);
  if (!files) return files.error();
  const auto sessions = school::sessions_of(**store, options.id);
  if (!sessions) return sessions.error();
  std::vector<std::string> missing;
  if (!options.no_reports) add_reports(options, *sessions, *files, missing);
  if (const Status written = write_zip(options.out, *files); !written) return written;
  fmt::print("{}: {}, all that is known of {}\n", base::printable(options.out, 300),
             counted(files->size(), "file"), options.id);
  for (const std::string& one : missing)
    fmt::print("no report, because the recording is not here: {}\n", base::printable(one, 400));
  print_json(options.json, {{"files", files->size()}, {"missing", missing}});
  return fine();
}

}  // namespace burr::app
