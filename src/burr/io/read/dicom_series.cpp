// Reads the headers of all files in a folder and sorts them into series. What is a slice but cannot
// be read is kept in a list of its own, so that nobody loses the end of a scan without a word.
#include "burr/io/read/dicom_series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <system_error>
#include <tuple>

#include "burr/base/printable.h"
#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_contours.h"
#include "burr/io/read/dicom_seg.h"
#include "burr/io/read/foreign.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;

constexpr std::size_t kMostFiles = 100000;
constexpr int kDeepestFolder = 10;

struct Verdict {
  std::string reason;    // why the file is not a slice of grey values; empty: it is one
  bool damaged = false;  // it would be one, if it were whole
};

bool has(const std::string& text, const char* part) {
  return lower(text).find(part) != std::string::npos;
}

Verdict not_a_slice(const DicomHeader& h) {
  // CT, MR and cone-beam, classic and enhanced: such a file has a picture unless it was cut off
  const auto is = [&](const std::string& root) {
    return h.sop_class == root || h.sop_class.starts_with(root + ".");
  };
  const std::string storage = "1.2.840.10008.5.1.4.1.1.";
  const bool slice_class = is(storage + "2") || is(storage + "4") || is(storage + "13.1");
  if (!h.damage.empty())
    return {fmt::format("is a damaged DICOM file: {}; copy it again", h.damage),
            h.has_pixels || slice_class || h.rows > 0};
  if (!h.has_pixels) {
    if (slice_class || h.rows > 0)
      return {"it holds no picture though it is a slice; it may be cut off, copy it again", true};
    return {"it holds no picture", false};
  }
  const std::string& syntax = h.transfer_syntax;
  const bool plain = syntax.empty() || syntax == "1.2.840.10008.1.2" ||
                     syntax == "1.2.840.10008.1.2.1" || syntax == "1.2.840.10008.1.2.2" ||
                     syntax == "1.2.840.10008.1.2.1.99" || syntax == "1.2.840.113619.5.2";
  if (plain == h.encapsulated)
    return {plain
                ? "its pixels are compressed, although the transfer syntax says that they are not"
                : "its pixels are not compressed, although the transfer syntax says that they are",
            true};
  if (h.float_pixels) return {"it holds floating-point pixels, not a scan", false};
  if (h.rows < 1 || h.columns < 1)
    return {"it holds no picture (Rows or Columns missing)", slice_class};
  if (h.samples != 1) return {"it is a colour picture; burr reads grey values", false};
  if (has(h.photometric, "palette"))
    return {"it is a colour picture with a palette; burr reads grey values", false};
  if (h.bits_allocated == 1)
    return {"it is a picture of one bit a pixel; burr reads grey values", false};
  if (h.bits_allocated != 8 && h.bits_allocated != 16 && h.bits_allocated != 32)
    return {fmt::format("Bits Allocated is {}, but burr reads 8, 16 or 32", h.bits_allocated),
            true};
  if (h.bits_stored < 1 || h.bits_stored > h.bits_allocated || h.high_bit >= h.bits_allocated ||
      h.high_bit < h.bits_stored - 1)
    return {
        fmt::format(
            "Bits Stored is {} of {} allocated bits, or High Bit does not fit; the header is wrong",
            h.bits_stored, h.bits_allocated),
        true};
  const auto pixels = static_cast<std::uint64_t>(h.rows) * static_cast<std::uint64_t>(h.columns) *
                      static_cast<std::uint64_t>(h.frame_count);
  const std::uint64_t bytes = pixels * static_cast<std::uint64_t>(h.bits_allocated / 8);
  if (!h.encapsulated && bytes > h.pixels_length)
    return {fmt::format("Pixel Data has {} bytes, but {} are needed; the file is cut off",
                        h.pixels_length, bytes),
            true};
  if (!h.bad_scale.empty()) return {fmt::format("its {} is no number", h.bad_scale), true};
  for (const DicomFrame& frame : h.frames)
    if (!(std::abs(frame.slope) < 1e6 && std::abs(frame.intercept) < 1e9))
      return {fmt::format("a Rescale Slope of {:g} or an Intercept of {:g} is out of range",
                          frame.slope, frame.intercept),
              true};
  // JPEG 2000 of an empty picture is tiny, but not as tiny as that
  if (h.encapsulated && (bytes > h.pixels_length * 20000 || bytes > (std::uint64_t{1} << 33)))
    return {
        fmt::format("{} bytes of compressed pixels cannot hold {} pixels", h.pixels_length, pixels),
        true};
  return {};
}

// ".dcm" of "031.DCM"; an ending of digits, as in names that are UIDs, counts as none.
std::string ending_of(const std::filesystem::path& path) {
  std::string ending = lower(path.extension().string());
  const bool word = std::any_of(ending.begin(), ending.end(),
                                [](unsigned char c) { return std::isalpha(c) != 0; });
  return word ? ending : std::string();
}

void sort_in(Found& found, DicomHeader header) {
  Verdict verdict;
  if (is_segmentation(header)) {
    verdict.reason = no_segmentation(header);
    if (verdict.reason.empty()) {
      found.segmentations.push_back(std::move(header));
      return;
    }
  } else if (is_contour_set(header) && header.damage.empty()) {
    found.contour_sets.push_back(std::move(header));
    return;
  } else {
    verdict = not_a_slice(header);
  }
  if (!verdict.reason.empty()) {
    ++found.others;
    if (!verdict.damaged) ++found.others_of[header.series];
    // a damaged slice says more than a file that is something else
    if (verdict.damaged || found.unread.empty()) {
      found.last_reason = fmt::format("{}: {}", short_name(header.path), verdict.reason);
      found.last_trouble = Trouble::data;
    }
    if (verdict.damaged)
      found.unread.push_back({header.path, header.series, briefly(header.path, verdict.reason)});
    return;
  }
  auto series = std::find_if(found.series.begin(), found.series.end(),
                             [&](const Series& s) { return s.uid == header.series; });
  if (series == found.series.end()) {
    series = found.series.emplace(found.series.end());
    series->uid = header.series;
    series->number = header.series_number;
  }
  series->places.insert(place_of(header.path));
  series->files.push_back(std::move(header));
}

// A file without a readable header: a slice that was lost, or something else.
void sort_out(Found& found, const std::filesystem::path& path, const Error& trouble) {
  ++found.others;
  if (found.unread.empty()) {
    found.last_reason = trouble.text;
    found.last_trouble = trouble.trouble;
  }
  const auto head = first_bytes(path, 132);
  std::string why;
  if (!head)
    why = "cannot be opened";
  else if (head->empty())
    why = "empty";
  else if (std::all_of(head->begin(), head->end(), [](std::uint8_t b) { return b == 0; }))
    why = "holds only zeros";
  else if (head->size() == 132 && std::memcmp(head->data() + 128, "DICM", 4) == 0)
    why = briefly(path, trouble.text);
  else if (ending_of(path) == ".dcm")
    why = "no DICOM file";
  if (!why.empty()) found.unread.push_back({path, "", why});
}

bool lies_in(const std::filesystem::path& root, const std::filesystem::path& link) {
  std::error_code trouble;
  const auto target = std::filesystem::canonical(link, trouble);
  if (trouble) return true;  // a dead link
  const auto rest = target.lexically_relative(root);
  return !rest.empty() && *rest.begin() != "..";
}

// All files in a folder, in the order of their names; without what systems leave there.
Result<std::vector<std::filesystem::path>> files_in(const std::filesystem::path& path,
                                                    Found& found) {
  std::vector<std::filesystem::path> paths;
  std::error_code trouble;
  const auto root = std::filesystem::canonical(path, trouble);
  auto walk = std::filesystem::recursive_directory_iterator(
      path, std::filesystem::directory_options::skip_permission_denied, trouble);
  for (; !trouble && walk != std::filesystem::recursive_directory_iterator();
       walk.increment(trouble)) {
    if (walk.depth() >= kDeepestFolder) walk.disable_recursion_pending();
    std::error_code kind;
    if (left_by_a_system(walk->path())) {
      if (walk->is_directory(kind)) walk.disable_recursion_pending();
      continue;
    }
    if (walk->is_symlink(kind)) {  // a slice with two names counts once; links that lead out of
                                   // the folder are not followed
      if (!lies_in(root, walk->path())) ++found.leading_out;
      continue;
    }
    if (!walk->is_regular_file(kind)) continue;
    paths.push_back(walk->path());
    if (paths.size() > kMostFiles)
      return error(fmt::format("{}: holds more than {} files; give the folder of one study",
                               short_name(path), kMostFiles));
  }
  std::sort(paths.begin(), paths.end());  // the order on disk means nothing
  if (paths.empty() && found.leading_out > 0)
    return error(
        fmt::format("{}: holds only links that lead out of it; give the folder that holds the "
                    "files, or copy them",
                    short_name(path)));
  if (paths.empty())
    return error(fmt::format("{}: the folder holds no files; give the folder of the scan",
                             short_name(path)));
  return paths;
}

// Whether these series of one picture each lie evenly spaced along their normal.
bool even(const std::vector<const Series*>& all) {
  std::vector<double> places;
  const DicomFrame& first = all.front()->first().frames.front();
  for (const Series* series : all) {
    const DicomFrame& frame = series->first().frames.front();
    if (!frame.has_position && !frame.has_location) return false;
    places.push_back(frame.has_position ? first.row.cross(first.column).dot(frame.position_mm)
                                        : frame.location_mm);
  }
  std::sort(places.begin(), places.end());
  std::vector<double> gaps;
  for (std::size_t n = 1; n < places.size(); ++n) gaps.push_back(places[n] - places[n - 1]);
  std::sort(gaps.begin(), gaps.end());
  const double usual = gaps[gaps.size() / 2];
  return usual > 1e-3 && gaps.front() > 0.8 * usual && gaps.back() < 1.2 * usual;
}

// Some programs give every slice a series of its own. Such series are one where their number, frame
// of reference, kind, size and orientation agree and they are evenly spaced.
void join_single_pictures(std::vector<Series>& all) {
  constexpr std::size_t kLeast = 3;
  using Key = std::tuple<std::string, std::string, std::string, std::string, int, int, int,
                         std::array<long, 8>>;
  std::map<Key, std::vector<std::size_t>> alike;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (all[s].pictures() != 1) continue;
    const DicomHeader& h = all[s].first();
    const DicomFrame& f = h.frames.front();
    const auto rounded = [](double v) { return std::lround(std::clamp(v, -1e6, 1e6) * 500); };
    alike[{h.study,
           h.frame_of_reference,
           h.modality,
           h.kernel,
           h.series_number,
           h.rows,
           h.columns,
           {rounded(f.row.x()), rounded(f.row.y()), rounded(f.row.z()), rounded(f.column.x()),
            rounded(f.column.y()), rounded(f.column.z()), rounded(f.row_gap_mm),
            rounded(f.column_gap_mm)}}]
        .push_back(s);
  }
  std::vector<bool> gone(all.size(), false);
  for (const auto& [key, members] : alike) {
    if (members.size() < kLeast) continue;
    std::vector<const Series*> series;
    for (const std::size_t s : members) series.push_back(&all[s]);
    if (!even(series)) continue;
    Series& one = all[members.front()];
    one.joined = members.size();
    for (std::size_t n = 1; n < members.size(); ++n) {
      Series& other = all[members[n]];
      one.places.insert(other.places.begin(), other.places.end());
      one.files.push_back(std::move(other.files.front()));
      gone[members[n]] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t s = 0; s < all.size(); ++s)
    if (!gone[s]) {
      if (kept != s) all[kept] = std::move(all[s]);
      ++kept;
    }
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(kept), all.end());
}

// A path as it can be compared with one of a DICOMDIR: discs write names in large letters, and with
// a version (";1") or a dot at their end.
std::string comparable(const std::filesystem::path& path) {
  std::string name = lower(path.lexically_normal().string());
  if (name.ends_with(";1")) name.resize(name.size() - 2);
  while (name.ends_with(".")) name.pop_back();
  return name;
}

// Looks for the pictures that indexes list: by their UID, and by their place.
void look_for_listed(const std::vector<std::filesystem::path>& indexes,
                     const std::vector<std::filesystem::path>& paths, Found& found) {
  if (indexes.empty()) return;
  std::map<std::string, std::string> by_place, by_instance;  // to the UID of the series
  for (const std::filesystem::path& path : paths) by_place[comparable(path)];
  for (const Series& series : found.series)
    for (const DicomHeader& file : series.files) {
      by_place[comparable(file.path)] = series.uid;
      if (!file.sop_instance.empty()) by_instance[file.sop_instance] = series.uid;
    }
  for (const std::filesystem::path& index : indexes)
    for (Listed& listed : read_dicomdir(index)) {
      if (found.listed.size() >= kMostFiles) return;
      Indexed one{std::move(listed), false, ""};
      auto at = by_instance.find(one.listed.instance);
      one.there = !one.listed.instance.empty() && at != by_instance.end();
      if (!one.there && !one.listed.file.empty()) {
        at = by_place.find(comparable(index.parent_path() / one.listed.file));
        one.there = at != by_place.end();
      }
      if (one.there) one.series = at->second;
      found.listed.push_back(std::move(one));
    }
}

}  // namespace

std::pair<std::string, std::string> place_of(const std::filesystem::path& path) {
  return {path.parent_path().string(), ending_of(path)};
}

std::string briefly(const std::filesystem::path& path, std::string reason) {
  if (reason.find("cut off") != std::string::npos) return "cut off";
  for (const std::string& before :
       {short_name(path) + ": ", std::string("is a damaged DICOM file: ")})
    if (reason.starts_with(before)) reason.erase(0, before.size());
  return reason.substr(0, reason.find("; "));
}

Result<Found> find_series(const std::filesystem::path& path, Progress& progress) {
  Found found;
  std::error_code trouble;
  std::vector<std::filesystem::path> paths = {path};
  if (auto packed = files_in_archive(path)) {
    std::erase_if(*packed, [&](const auto& file) { return left_by_a_system(file, path); });
    paths = std::move(*packed);
  } else if (std::filesystem::is_directory(path, trouble)) {
    auto inside = files_in(path, found);
    if (!inside) return inside.error();
    paths = std::move(*inside);
  }
  std::vector<std::filesystem::path> indexes;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (i % 32 == 0) {
      progress.report(static_cast<double>(i) / static_cast<double>(paths.size()),
                      "searching the files");
      if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
    }
    if (lower(paths[i].filename().string()) == "dicomdir" &&
        (paths.size() > 1 || is_dicomdir(paths[i]))) {
      indexes.push_back(paths[i]);
      continue;
    }
    auto header = read_dicom_header(paths[i]);
    if (header)
      sort_in(found, std::move(*header));
    else
      sort_out(found, paths[i], header.error());
  }
  look_for_listed(indexes, paths, found);
  join_single_pictures(found.series);
  return found;
}

}  // namespace burr::io
