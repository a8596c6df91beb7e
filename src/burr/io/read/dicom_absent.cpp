#include "burr/io/read/dicom_absent.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "burr/io/read/bytes.h"

namespace burr::io {
namespace {

constexpr const char* kEnd = "so slices are missing, perhaps at an end of the scan";

// Files that are there: copies of one count once. Some programs give all files one UID.
std::size_t instances(const std::vector<const DicomHeader*>& files) {
  std::set<std::pair<std::string, int>> names;
  for (const DicomHeader* file : files) names.insert({file->sop_instance, file->instance});
  const bool nameless = std::any_of(files.begin(), files.end(), [](const DicomHeader* file) {
    return file->sop_instance.empty();
  });
  return nameless ? files.size() : names.size();
}

std::vector<const DicomHeader*> files_of(const Series& series) {
  std::vector<const DicomHeader*> all;
  for (const DicomHeader& file : series.files) all.push_back(&file);
  return all;
}

// "IM0007, IM0008 and 20 more"
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), kNamed); ++n)
    text += (n > 0 ? ", " : "") + names[n];
  return names.size() > kNamed ? fmt::format("{} and {} more", text, names.size() - kNamed) : text;
}

// Pictures of this series that a DICOMDIR lists and that do not lie beside it.
bool by_index(const Found& found, const Series& series, const std::string& file, Scan& scan) {
  std::set<std::string> members;  // what the index calls this series
  for (const Indexed& one : found.listed)
    if (one.listed.series == series.uid || (one.there && one.series == series.uid))
      members.insert(one.listed.series);
  std::vector<std::string> gone;
  std::size_t listed = 0;
  for (const Indexed& one : found.listed) {
    if (members.count(one.listed.series) == 0) continue;
    ++listed;
    if (!one.there)
      gone.push_back(one.listed.file.empty() ? "a picture without a name"
                                             : short_name(one.listed.file));
  }
  if (gone.empty()) return false;
  scan.ask(
      Ask::absent,
      fmt::format("{}: DICOMDIR lists {} pictures of this series, and {} of them {} not here "
                  "({}), {}",
                  file, listed, gone.size(), gone.size() == 1 ? "is" : "are", some_of(gone), kEnd));
  return true;
}

// Parts of a picture that was cut into several files.
bool by_parts(const Series& series, const Volume& volume, const std::string& file, Scan& scan) {
  struct Parts {
    std::set<int> there;
    int wanted = 0;
  };
  constexpr int kMostParts = 65535;
  std::map<std::string, Parts> all;
  for (const Slice& slice : volume.slices) {
    const DicomHeader& h = series.files[slice.file];
    if (h.concatenation.empty() || h.part < 1 || h.part > kMostParts) continue;
    Parts& parts = all[h.concatenation];
    parts.there.insert(h.part);
    // the total is optional: then a part before the last one is known to be missing
    parts.wanted = std::max({parts.wanted, h.part, std::min(h.parts, kMostParts)});
  }
  for (const auto& [uid, parts] : all) {
    std::vector<std::string> gone;
    for (int part = 1; part <= parts.wanted; ++part)
      if (parts.there.count(part) == 0) gone.push_back(std::to_string(part));
    if (gone.empty()) continue;
    scan.ask(Ask::absent, fmt::format("{}: {} of {} parts of this scan {} not here (part {}), {}",
                                      file, gone.size(), parts.wanted,
                                      gone.size() == 1 ? "is" : "are", some_of(gone), kEnd));
    return true;
  }
  return false;
}

// A file with many pictures states another number of them than it describes or holds.
bool by_frames(const Series& series, const Volume& volume, const std::string& file, Scan& scan) {
  std::set<std::size_t> seen;
  for (const Slice& slice : volume.slices) {
    if (!seen.insert(slice.file).second) continue;
    const DicomHeader& h = series.files[slice.file];
    const std::uint64_t frame = static_cast<std::uint64_t>(h.rows) *
                                static_cast<std::uint64_t>(h.columns) *
                                static_cast<std::uint64_t>(h.bits_allocated / 8);
    const std::uint64_t held = h.encapsulated || frame == 0 ? 0 : h.pixels_length / frame;
    const auto stated = static_cast<std::uint64_t>(h.frame_count);
    const auto described = static_cast<std::uint64_t>(h.described_frames);
    if (described > 0 && described != stated)
      scan.ask(Ask::absent, fmt::format("{}: states {} frames, but describes {}, {}", file, stated,
                                        described, kEnd));
    else if (held > stated)
      scan.ask(Ask::absent, fmt::format("{}: states {} {}, but its pixels hold {}, {}", file,
                                        stated, stated == 1 ? "frame" : "frames", held, kEnd));
    else
      continue;
    return true;
  }
  return false;
}

// The number of files of the series.
bool by_series(const Found& found, const Series& series, std::size_t unread,
               const std::string& file, Scan& scan) {
  if (series.joined > 0) return false;  // each file counts for itself there
  int stated = 0;
  for (const DicomHeader& h : series.files) stated = std::max(stated, h.instances_in_series);
  const auto others = found.others_of.find(series.uid);
  const std::size_t here =
      instances(files_of(series)) + unread + (others == found.others_of.end() ? 0 : others->second);
  if (static_cast<std::size_t>(stated) <= here) return false;
  scan.ask(Ask::absent, fmt::format("{}: states that its series has {} files (Number of Series "
                                    "Related Instances), and {} {} here, {}",
                                    file, stated, here, here == 1 ? "is" : "are", kEnd));
  return true;
}

// The number of pictures of the acquisition, which may have been made into several series. Where
// every slice has an acquisition of its own, the number is that of the series.
bool by_acquisition(const Found& found, const Series& series, std::size_t unread,
                    const std::string& file, Scan& scan) {
  const std::string& study = series.first().study;
  std::map<int, std::vector<const DicomHeader*>> here;  // of each acquisition, all its series
  for (const Series& one : found.series)
    for (const DicomHeader& h : one.files)
      if (h.study == study) here[h.acquisition].push_back(&h);
  std::map<int, int> stated;
  for (const DicomHeader& h : series.files) {
    if (h.frame_count > 1) return false;
    int& most = stated[h.acquisition];
    most = std::max(most, h.images_in_acquisition);
  }
  const auto others = found.others_of.find(series.uid);
  const std::size_t beside = unread + (others == found.others_of.end() ? 0 : others->second);
  const std::size_t whole = instances(files_of(series)) + beside;
  const bool one_each = stated.size() * 3 > series.files.size();
  for (const auto& [acquisition, number] : stated) {
    const std::size_t there = one_each ? whole : instances(here[acquisition]) + beside;
    if (static_cast<std::size_t>(number) <= there) continue;
    scan.ask(Ask::absent, fmt::format("{}: states that its acquisition has {} pictures (Images in "
                                      "Acquisition), and {} {} here, {}",
                                      file, number, there, there == 1 ? "is" : "are", kEnd));
    return true;
  }
  return false;
}

}  // namespace

void say_absent(const Found& found, const Series& series, const Volume& volume,
                const Looked& looked, const std::string& file, Scan& scan) {
  if (volume.slices.empty()) return;
  if (by_parts(series, volume, file, scan) || by_frames(series, volume, file, scan)) return;
  if (!looked.folder || volume.slices.size() < 2) return;
  static_cast<void>(by_index(found, series, file, scan) ||
                    by_series(found, series, looked.unread, file, scan) ||
                    by_acquisition(found, series, looked.unread, file, scan));
}

}  // namespace burr::io
