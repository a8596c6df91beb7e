#include "workshop/recording.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "burr/importing/import.h"
#include "burr/importing/keep_greys.h"
#include "burr/io/read/read_scan.h"
#include "burr/record/find_volume.h"
#include "burr/record/place_file.h"
#include "burr/sim/session_words.h"

namespace burr::app {
namespace {

constexpr std::size_t kBrickRows = 8192;  // changed bricks that may wait for the disk

// How the bone was made, with what only the user has: the file, tables, a series by its UID.
Result<scenario::Recipe> recipe_of(const scenario::Recipe& recorded, const scenario::Recipe& given,
                                   const std::string& where) {
  scenario::Recipe recipe = recorded;
  recipe.source = given.source;
  recipe.labels = given.labels;
  recipe.materials = given.materials;
  recipe.read_seconds = given.read_seconds;
  recipe.read_memory_mb = given.read_memory_mb;
  if (!recorded.series.starts_with('#')) recipe.series = given.series;
  if (recorded.series == scenario::kOwn && given.series.empty())
    return error(Trouble::usage, fmt::format("{}: was made from a series chosen by its UID, which "
                                             "recordings do not store; give it again with --series",
                                             where));
  if (!recorded.labels.empty() && given.labels.empty())
    return error(
        Trouble::usage,
        fmt::format("{}: was made with a table of tissues; give that table with --tissues", where));
  return recipe;
}

}  // namespace

Status Recording::start(sim::Session& session, const std::string& file,
                        const scenario::Recipe& volume, const importing::ImportSummary& import,
                        const std::string& motion, bool embed, const std::optional<Tissues>& spared,
                        const std::optional<scenario::Case>& work_case) {
  record::SessionInfo info;
  sim::describe(session.settings(), session.hand().spec(), info);
  info.words["motion"] = motion;
  if (spared) write_spared(*spared, info);
  if (work_case) info.work_case = record::case_info(*work_case);
  const volume::Bone& bone = session.bone();
  info.volume.content_hash = bone.content_hash();
  if (!scenario::is_phantom(volume.source)) {
    auto print = record::fingerprint(volume.source);
    if (print) info.volume.source_fingerprint = *print;
  }
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.has_intensity = bone.has_intensity();
  info.volume.format = import.format;
  info.volume.recipe = scenario::without_paths(volume);
  file_ = file;
  rate_hz_ = info.rate_hz;
  recorder_ =
      std::make_unique<record::Recorder>(info.rate_hz, kBrickRows, session.settings().realtime);
  Status started = recorder_->start(file, info, embed ? &bone : nullptr,
                                    [this](const Error& problem) { tell(problem); });
  if (started) {
    session.set_recorder(recorder_.get());
    return started;
  }
  recorder_.reset();
  // a name that cannot be meant is refused while nothing is lost; a disk that refuses is not the
  // session's fault
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
  }
  fmt::print(stderr, "{}burr: {}; the session continues without recording\n",
             isatty(STDERR_FILENO) != 0 ? "\r\x1b[K" : "", problem.text);
}

std::string Recording::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_ ? "NOT RECORDED ANY MORE: " + trouble_->text : "";
}

Status Recording::finish(sim::Session& session) {
  session.set_recorder(nullptr);
  if (recorder_) {
    const auto done = recorder_->finish();
    if (done && !done->whole())
      return error(
          Trouble::io,
          fmt::format("{}: {} ticks, {} commands and {} bricks could not be written in time "
                      "and are missing; record to a faster disk",
                      file_, done->dropped_ticks, done->dropped_commands, done->dropped_bricks));
  }
  const std::lock_guard lock(mutex_);
  if (!trouble_) return fine();
  std::error_code nobody_asks;
  const bool there = std::filesystem::exists(file_, nobody_asks);
  const double kept = recorder_ ? static_cast<double>(recorder_->safe_ticks()) / rate_hz_ : 0;
  return error(trouble_->trouble,
               fmt::format("{}; the session ended normally, but its recording is incomplete: {}",
                           trouble_->text,
                           there && kept > 0 ? fmt::format("it holds the first {:.3f} s", kept)
                                             : "nothing was kept"));
}

record::RecordingAccount Recording::written() const {
  return recorder_ ? recorder_->account() : record::RecordingAccount{};
}

nlohmann::json Recording::account() const {
  const std::lock_guard lock(mutex_);
  const record::RecordingAccount account = written();
  nlohmann::json out;
  out["file"] = file_;
  out["whole"] = !trouble_ && account.whole();
  out["ticks"] = account.safe_ticks;
  out["dropped_ticks"] = account.dropped_ticks;
  out["bytes"] = account.bytes;
  if (trouble_) out["trouble"] = trouble_->text;
  return out;
}

Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                              const scenario::Recipe& given, Progress& progress) {
  const record::SessionInfo& info = player.info();
  if (info.embedded && given.source.empty())
    return player.embedded_bone(static_cast<std::size_t>(info.volume.recipe.reserve_bricks));

  const scenario::Recipe& recorded = info.volume.recipe;
  auto recipe = recipe_of(recorded, given, player.path());
  if (!recipe) return recipe.error();
  if (scenario::is_phantom(recorded.source) && given.source.empty()) {
    recipe->source = recorded.source;
  } else if (!scenario::is_phantom(given.source)) {
    auto found = record::find_volume(info.volume,
                                     {given.source, record::volume_search_path(), player.path()});
    if (!found) return found.error();
    recipe->source = *found;
  }
  auto made = open_volume(*recipe, progress);
  if (!made) return made.error();
  Status same = record::check_volume(info.volume, *made->bone, recipe->source);
  if (!same) return same.error();
  return std::move(made->bone);
}

std::shared_ptr<const volume::Greys> scan_greys_of(const record::Player& player,
                                                   const scenario::Recipe& given,
                                                   Progress& progress) {
  const auto print = record::fingerprint(given.source);
  if (!print || *print != player.info().volume.source_fingerprint) return nullptr;
  const auto scan = io::read_scan(given.source, read_options(given), progress);
  if (!scan) return nullptr;
  const auto plan = importing::plan_import(*scan, given);
  return plan ? importing::keep_greys(*scan, plan->iso, progress) : nullptr;
}

}  // namespace burr::app
