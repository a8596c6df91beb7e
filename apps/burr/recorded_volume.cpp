#include "recorded_volume.h"

#include <fmt/core.h>

#include "burr/base/hash.h"
#include "burr/record/find_volume.h"

namespace burr::app {
namespace {

constexpr const char* kPhantom = "phantom:";

// one number for a text that must not be written down
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = base::mix(0, std::uint64_t{text.size()});
  for (const char c : text) hash = base::mix(hash, std::uint64_t{static_cast<unsigned char>(c)});
  return hash;
}

// the words of VolumeOptions that may be recorded as typed
struct Word {
  const char* name;
  std::string VolumeOptions::*value;
};
constexpr Word kWords[] = {{"spacing_mm", &VolumeOptions::spacing_mm},
                           {"roi", &VolumeOptions::roi},
                           {"iso", &VolumeOptions::iso}};
struct Number {
  const char* name;
  double VolumeOptions::*value;
};
constexpr Number kNumbers[] = {{"voxel_mm", &VolumeOptions::voxel_mm},
                               {"smooth", &VolumeOptions::smooth},
                               {"memory_mb", &VolumeOptions::memory_mb}};

}  // namespace

Result<record::VolumeInfo> volume_info(const VolumeOptions& options, const io::Imported& opened) {
  const volume::Bone& bone = *opened.bone;
  record::VolumeInfo info;
  info.content_hash = bone.content_hash();
  info.grid = bone.grid();
  info.tissues = bone.tissues();
  info.has_intensity = bone.has_intensity();
  info.reserve_bricks = options.reserve_bricks;
  info.words["format"] = opened.summary.format;
  if (is_phantom(options.path)) {
    info.words["phantom"] = options.path.substr(std::string(kPhantom).size());
  } else {
    const auto fingerprint = record::fingerprint(options.path);
    if (!fingerprint) return fingerprint.error();
    info.source_fingerprint = *fingerprint;
  }

  const VolumeOptions defaults;
  for (const Word& word : kWords)
    if (!(options.*word.value).empty()) info.words[word.name] = options.*word.value;
  for (const Number& number : kNumbers)
    if (options.*number.value != defaults.*number.value)
      info.numbers[number.name] = options.*number.value;
  if (options.series.rfind('#', 0) == 0)
    info.words["series"] = options.series;
  else if (!options.series.empty())
    info.words["series_hash"] = record::hex(hash_of(options.series));
  if (!options.tissues.empty()) info.words["tissues"] = "a table of the user's own";
  return info;
}

Result<std::unique_ptr<volume::Bone>> recorded_bone(const record::Player& player,
                                                    const VolumeOptions& given,
                                                    Progress& progress) {
  const record::SessionInfo& session = player.info();
  const record::VolumeInfo& wanted = session.volume;
  if (session.embedded && given.path.empty()) return player.embedded_bone(wanted.reserve_bricks);

  // as recorded, but for what is said now
  VolumeOptions options = given;
  options.reserve_bricks = wanted.reserve_bricks;
  const VolumeOptions defaults;
  for (const Word& word : kWords)
    if (const auto at = wanted.words.find(word.name);
        at != wanted.words.end() && (options.*word.value).empty())
      options.*word.value = at->second;
  for (const Number& number : kNumbers)
    if (const auto at = wanted.numbers.find(number.name);
        at != wanted.numbers.end() && options.*number.value == defaults.*number.value)
      options.*number.value = at->second;
  if (const auto at = wanted.words.find("series");
      at != wanted.words.end() && options.series.empty())
    options.series = at->second;
  if (wanted.words.contains("series_hash") && options.series.empty())
    return error(Trouble::usage, player.path() +
                                     ": its bone was read from a series given by UID, which is not "
                                     "recorded; give the same --series again");
  if (wanted.words.contains("tissues") && options.tissues.empty())
    return error(
        Trouble::usage,
        player.path() + ": its bone was made with a tissue table; give the same --tissues again");

  if (const auto at = wanted.words.find("phantom"); at != wanted.words.end()) {
    options.path = kPhantom + at->second;
  } else {
    auto path =
        record::find_volume(wanted, {given.path, record::volume_search_path(), player.path()});
    if (!path) return path.error();
    options.path = *path;
  }
  auto opened = open_volume(options, progress);
  if (!opened) return opened.error();
  const Status same = record::check_volume(wanted, *opened->bone, options.path);
  if (!same) return same.error();
  return std::move(opened->bone);
}

}  // namespace burr::app
