#include "shared/recorded_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "burr/base/places.h"
#include "burr/record/course.h"
#include "burr/record/rename_and_sync.h"
#include "burr/record/scan_list.h"
#include "burr/report/questions.h"
#include "burr/scoring/rubric.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
#include "shared/subcommand.h"

namespace burr::app {

Status Recording::start(sim::Session& session, const std::string& file,
                        const scenario::BoneRecipe& volume, const importing::ImportSummary& import,
                        const std::string& motion, bool embed,
                        const std::optional<workshop::Tissues>& spared,
                        const std::optional<scenario::Case>& work_case) {
  record::Identity who = identity_;
  if (const std::string rubric = work_case ? report::rubric_of(*work_case) : ""; !rubric.empty())
    if (const auto read = scoring::read_rubric(rubric)) who.rubric_hash = read->text_hash;
  const workshop::About about{volume,    import.format, motion,     embed,    spared,
                              work_case, who,           scan_list_, earlier_, sealer_};
  file_ = file;
  rate_hz_ = session.settings().servo.rate_hz;
  auto begun =
      workshop::record(session, file, about, [this](const Error& problem) { tell(problem); });
  if (begun) {
    recorder_ = std::move(*begun);
    print_notices(recorder_->notices());
    diary_.emplace(*recorder_, rate_hz_);
    return fine();
  }
  const Status started = begun.error();
  // an impossible name is refused now, while nothing is lost; after a disk error the session runs
  // without recording
  std::error_code nobody_asks;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (started.error().trouble != Trouble::io || record::being_written(file) ||
      std::filesystem::is_directory(file, nobody_asks) ||
      !(folder.empty() || std::filesystem::is_directory(folder, nobody_asks)))
    return started;
  tell(started.error());
  return fine();
}

void Recording::tell(const Error& problem) {
  {
    const std::lock_guard lock(mutex_);
    trouble_ = problem;
    if (ending_) return;  // finish() says it
  }
  fmt::print(stderr, "{}burr: {}; the session continues without recording\n",
             isatty(STDERR_FILENO) != 0 ? "\r\x1b[K" : "", in_options(problem).text);
}

std::string Recording::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_ ? "NOT RECORDED ANY MORE: " + in_options(*trouble_).text : "";
}

Status Recording::finish(sim::Session& session, bool stopped) {
  stopped_ = stopped;
  session.set_recorder(nullptr);
  if (diary_) {
    const std::uint64_t ticks = session.outcome().ticks;
    diary_->end(ticks > 0 ? ticks - 1 : 0,
                stopped ? record::Ending::broke_off : record::Ending::time_up);
  }
  if (recorder_) {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    const auto done = recorder_->finish(stopped);
    if (done && !done->whole())
      return error(
          Trouble::io,
          fmt::format("{}: {} ticks, {} commands, {} bricks and {} notes on the view and the "
                      "course could not be written in time and are missing; record to a faster "
                      "disk",
                      file_, done->dropped_ticks, done->dropped_commands, done->dropped_bricks,
                      done->dropped_notes));
  }
  const std::lock_guard lock(mutex_);
  if (!trouble_) return fine();
  std::error_code nobody_asks;
  const bool there = std::filesystem::exists(file_, nobody_asks);
  const std::uint64_t ticks = recorder_ ? recorder_->written_ticks() : 0;
  const double kept = static_cast<double>(ticks) / rate_hz_;
  if (there && ticks > 0 && ticks == session.outcome().ticks)
    return error(trouble_->trouble,
                 fmt::format("{}; the session ended normally, and all its {:.3f} s can be read in "
                             "the recording, but perhaps not after a power cut: copy it to another "
                             "disk, or repair it",
                             trouble_->text, kept));
  return error(trouble_->trouble,
               fmt::format("{}; the session ended normally, but its recording is incomplete: {}",
                           trouble_->text,
                           there && kept > 0 ? fmt::format("it holds the first {:.3f} s", kept)
                                             : "nothing was kept"));
}

record::RecordingStats Recording::written() const {
  return recorder_ ? recorder_->stats() : record::RecordingStats{};
}

nlohmann::json Recording::account() const {
  const std::lock_guard lock(mutex_);
  const record::RecordingStats account = written();
  nlohmann::json out;
  out["file"] = file_;
  out["whole"] = !trouble_ && account.whole();
  out["finished"] = !trouble_ && account.whole() && !stopped_;
  out["ticks"] = account.written_ticks;
  out["dropped_ticks"] = account.dropped_ticks;
  out["bytes"] = account.bytes;
  if (trouble_) out["trouble"] = trouble_->text;
  return out;
}

std::string scan_list_by(const Settings& settings, const std::filesystem::path& state) {
  if (settings.remember_scans) return record::scan_list(state);
  std::error_code nobody_asks;
  if (!state.empty())
    for (const char* name : {"scans.txt", "scans.txt.lock"})
      std::filesystem::remove(state / name, nobody_asks);
  return {};
}

std::string users_scan_list() {
  const DeskPlaces places = users_places();
  if (places.config.empty()) return record::scan_list(places.state);
  return scan_list_by(read_settings(places.config / "settings.toml").settings, places.state);
}

}  // namespace burr::app
