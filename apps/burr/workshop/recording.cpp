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

constexpr const char* kPhantom = "phantom:";
constexpr std::size_t kBrickRows = 8192;  // changed bricks that may wait for the disk

// How the bone was made, without any path or identifier.
void describe_volume(const VolumeOptions& options, const importing::ImportSummary& import,
                     record::VolumeInfo& info) {
  info.words["format"] = import.format;
  if (is_phantom(options.path))
    info.words["phantom"] = options.path.substr(std::string(kPhantom).size());
  info.numbers["voxel_mm"] = options.voxel_mm;
  info.numbers["smooth"] = options.smooth;
  info.numbers["memory_mb"] = options.memory_mb;
  if (!options.iso.empty()) info.words["iso"] = options.iso;
  if (!options.roi.empty()) info.words["roi"] = options.roi;
  if (!options.spacing_mm.empty()) info.words["spacing_mm"] = options.spacing_mm;
  if (!options.series.empty())
    info.words["series"] = options.series.front() == '#' ? options.series : "given by name";
  if (!options.tissues.empty()) info.words["tissue_table"] = "own";
  if (!options.materials.empty()) info.words["materials"] = "own";
}

Result<VolumeOptions> options_of(const record::SessionInfo& session, const VolumeOptions& given,
                                 const std::string& where) {
  const record::VolumeInfo& info = session.volume;
  VolumeOptions options = given;
  const auto number = [&info](const char* name, double otherwise) {
    const auto found = info.numbers.find(name);
    return found == info.numbers.end() ? otherwise : found->second;
  };
  const auto word = [&info](const char* name) {
    const auto found = info.words.find(name);
    return found == info.words.end() ? std::string() : found->second;
  };
  options.voxel_mm = number("voxel_mm", 0);
  options.smooth = number("smooth", -1);
  options.memory_mb = number("memory_mb", 0);
  options.reserve_bricks = info.reserve_bricks;
  options.iso = word("iso");
  options.roi = word("roi");
  options.spacing_mm = word("spacing_mm");
  const std::string series = word("series");
  if (!series.empty() && series.front() == '#') options.series = series;
  if (!series.empty() && series.front() != '#' && given.series.empty())
    return error(Trouble::usage, fmt::format("{}: was made from a series chosen by its UID, which "
                                             "recordings do not store; give it again with --series",
                                             where));
  if (!word("tissue_table").empty() && given.tissues.empty())
    return error(
        Trouble::usage,
        fmt::format("{}: was made with a table of tissues; give that table with --tissues", where));
  return options;
}

}  // namespace

Status Recording::start(sim::Session& session, const std::string& file, const VolumeOptions& volume,
                        const importing::ImportSummary& import, const std::string& motion,
                        bool embed, const std::optional<Tissues>& spared) {
  record::SessionInfo info;
  sim::describe(session.settings(), session.hand().spec(), info);
  info.words["motion"] = motion;
  if (spared) write_spared(*spared, info);
  const volume::Bone& bone = session.bone();
  info.volume.content_hash = bone.content_hash();
  if (!is_phantom(volume.path)) {
    auto print = record::fingerprint(volume.path);
    if (print) info.volume.source_fingerprint = *print;
  }
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.has_intensity = bone.has_intensity();
  info.volume.reserve_bricks = volume.reserve_bricks;
  describe_volume(volume, import, info.volume);
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
                                              const VolumeOptions& given, Progress& progress) {
  const record::SessionInfo& info = player.info();
  if (info.embedded && given.path.empty())
    return player.embedded_bone(static_cast<std::size_t>(info.volume.reserve_bricks));

  auto options = options_of(info, given, player.path());
  if (!options) return options.error();
  const auto phantom = info.volume.words.find("phantom");
  if (phantom != info.volume.words.end() && given.path.empty()) {
    options->path = kPhantom + phantom->second;
  } else if (!is_phantom(given.path)) {
    auto found =
        record::find_volume(info.volume, {given.path, record::volume_search_path(), player.path()});
    if (!found) return found.error();
    options->path = *found;
  }
  auto made = open_volume(*options, progress);
  if (!made) return made.error();
  Status same = record::check_volume(info.volume, *made->bone, options->path);
  if (!same) return same.error();
  return std::move(made->bone);
}

std::shared_ptr<const volume::Greys> scan_greys_of(const record::Player& player,
                                                   const VolumeOptions& given, Progress& progress) {
  const auto print = record::fingerprint(given.path);
  if (!print || *print != player.info().volume.source_fingerprint) return nullptr;
  const auto reading = read_options(given);
  const auto importing = import_options(given);
  if (!reading || !importing) return nullptr;
  const auto scan = io::read_scan(given.path, *reading, progress);
  if (!scan) return nullptr;
  const auto plan = importing::plan_import(*scan, *importing);
  return plan ? importing::keep_greys(*scan, plan->iso, progress) : nullptr;
}

}  // namespace burr::app
