#include "burr/io/read/dicom_labels.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/contour_voxels.h"
#include "burr/io/read/dicom_contours.h"
#include "burr/io/read/dicom_seg.h"
#include "burr/io/read/merge_structures.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using Kind = LabelSource::Kind;

std::string list_of(const std::vector<LabelSource>& all) {
  constexpr std::size_t kNamed = 8;
  std::string list;
  for (std::size_t n = 0; n < std::min(all.size(), kNamed); ++n)
    list += (n > 0 ? "; " : "") + all[n].line;
  return all.size() > kNamed ? fmt::format("{}; and {} more", list, all.size() - kNamed) : list;
}

// "lies a DICOM segmentation", "lie 3 DICOM segmentations and a set of contours (RTSTRUCT)"
std::string kinds_in_words(const std::vector<LabelSource>& all) {
  const auto count = [&](Kind kind) {
    return std::count_if(all.begin(), all.end(),
                         [kind](const LabelSource& one) { return one.kind == kind; });
  };
  const auto segmentations = count(Kind::segmentation), contours = count(Kind::contours);
  std::string text = segmentations + contours == 1 ? "lies " : "lie ";
  if (segmentations > 0)
    text += segmentations == 1 ? "a DICOM segmentation"
                               : fmt::format("{} DICOM segmentations", segmentations);
  if (segmentations > 0 && contours > 0) text += " and ";
  if (contours > 0)
    text += contours == 1 ? "a set of contours (RTSTRUCT)"
                          : fmt::format("{} sets of contours (RTSTRUCT)", contours);
  return text;
}

// ---- several segmentations as one

// The labels of a label map as structures.
void take_structures(const Scan& scan, const std::string& file, std::vector<LooseStructure>& out) {
  std::array<LooseStructure, 256> of;
  for (std::size_t v = 0; v < scan.labels.size(); ++v)
    if (scan.labels[v] != 0) of[scan.labels[v]].add(v);
  for (std::size_t value = 1; value < of.size(); ++value) {
    LooseStructure& one = of[value];
    if (one.runs.empty()) continue;
    one.label = {.value = 0,
                 .name = fmt::format("{} segment {}", file, value),
                 .colour = volume::Tissue{}.colour};
    for (const Label& label : scan.label_names)
      if (label.value == static_cast<int>(value) && !label.name.empty()) one.label = label;
    one.label.in_file = 0;
    one.file = file;
    one.places = places_of(scan);
    out.push_back(std::move(one));
  }
}

// Two structures of one name get the names of their files.
void part_names(std::vector<LooseStructure>& all) {
  std::map<std::string, std::set<std::string>> files;
  for (const LooseStructure& one : all) files[one.label.name].insert(one.file);
  for (LooseStructure& one : all)
    if (files[one.label.name].size() > 1) one.label.name += " (" + one.file + ")";
}

Status read_all_segmentations(const Found& found, const ReadOptions& options,
                              const std::string& file, Scan& scan, Progress& progress) {
  std::vector<LooseStructure> all;
  for (const DicomHeader& header : found.segmentations) {
    const std::string name = short_name(header.path);
    Scan one;
    if (Status status = read_segmentation(header, options, name, one, progress); !status)
      return status;
    take_structures(one, name, all);
    for (const std::string& notice : one.notices)
      scan.notices.push_back(fmt::format("{}: {}", name, notice));
    for (const Question& question : one.questions)
      if (scan.questions.empty()) scan.questions.push_back(question);
  }
  part_names(all);
  const std::string was = std::exchange(scan.format, "DICOM segmentations");
  if (Status status = merge_structures(all, std::nullopt, file, scan, progress); !status) {
    scan.format = was;
    return status;
  }
  scan.notices.push_back(fmt::format("{} segmentations became one label map, numbered 1 to {}.",
                                     found.segmentations.size(), scan.label_names.size()));
  return fine();
}

// ---- contours

const DicomHeader& first_of(const Found& found, const Volume& volume) {
  return found.series[volume.series].files[volume.slices.front().file];
}

// The volume on which the contours were drawn: by its series, else by its frame of reference, else the largest.
std::size_t volume_of(const ContourSet& set, const Found& found,
                      const std::vector<Volume>& volumes) {
  std::set<std::string> frames;
  for (const ContouredStructure& one : set.structures) frames.insert(one.frame_of_reference);
  std::size_t best = 0;
  std::pair<int, std::size_t> most = {-1, 0};
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    const DicomHeader& h = first_of(found, volumes[v]);
    const bool series =
        std::find(set.series.begin(), set.series.end(), h.series) != set.series.end();
    const bool frame = !h.frame_of_reference.empty() && frames.count(h.frame_of_reference) != 0;
    const std::pair<int, std::size_t> worth = {2 * (series ? 1 : 0) + (frame ? 1 : 0),
                                               volumes[v].slices.size()};
    if (worth > most) {
      most = worth;
      best = v;
    }
  }
  return best;
}

// Structures of another frame of reference than the scan are left out; where all are, it is a question.
void check_frames(const DicomHeader& volume, const std::string& file, ContourSet& set, Scan& scan) {
  const auto other = [&](const ContouredStructure& one) {
    return !one.contours.empty() && !one.frame_of_reference.empty() &&
           !volume.frame_of_reference.empty() &&
           one.frame_of_reference != volume.frame_of_reference;
  };
  const auto drawn = static_cast<std::size_t>(
      std::count_if(set.structures.begin(), set.structures.end(),
                    [](const ContouredStructure& one) { return !one.contours.empty(); }));
  const auto others =
      static_cast<std::size_t>(std::count_if(set.structures.begin(), set.structures.end(), other));
  if (others == 0) return;
  if (others == drawn) {
    scan.ask(Ask::doubt,
             fmt::format("{}: its contours lie in another frame of reference than the scan beside "
                         "them, so they may have been drawn on another one",
                         file));
    return;
  }
  std::erase_if(set.structures, other);
  scan.notices.push_back(fmt::format(
      "{} of {} structures lie in another frame of reference than the scan and were left out.",
      others, drawn));
}

Status read_contour_labels(const DicomHeader& header, const Found& found,
                           const std::vector<Volume>& volumes, const ReadVolume& read_volume,
                           Scan& scan, Progress& progress) {
  const std::string file = short_name(header.path);
  if (volumes.empty())
    return error(fmt::format(
        "{}: holds contours (RTSTRUCT) and no voxels; give burr a folder that also holds the scan "
        "on which they were drawn",
        file));
  auto set = read_contours(header);
  if (!set) return set.error();
  if (std::all_of(set->structures.begin(), set->structures.end(),
                  [](const ContouredStructure& one) { return one.contours.empty(); }))
    return error(fmt::format(
        "{}: is a set of contours (RTSTRUCT) without a contour; export it again", file));
  const std::size_t volume = volume_of(*set, found, volumes);
  const DicomHeader& drawn_on = first_of(found, volumes[volume]);
  check_frames(drawn_on, file, *set, scan);
  if (!set->series.empty() &&
      std::find(set->series.begin(), set->series.end(), drawn_on.series) == set->series.end())
    scan.notices.emplace_back(
        "The contours refer to a series that is not here; they get the voxels of the scan beside "
        "them.");
  Scan drawn;
  if (Status status = read_volume(volume, drawn); !status) return status;
  for (const Question& question : drawn.questions) scan.questions.push_back(question);
  const VoxelPlaces places = places_of(drawn);
  Voxels<float>().swap(drawn.values);
  auto structures = voxels_of_contours(*set, places, scan, progress);
  if (!structures) return structures.error();
  if (Status status = merge_structures(*structures, places, file, scan, progress); !status)
    return status;
  scan.k_reversed = drawn.k_reversed;
  scan.format = "DICOM contours";
  return fine();
}

}  // namespace

std::vector<LabelSource> label_sources(const Found& found, std::size_t volumes) {
  std::vector<LabelSource> out;
  const auto number = [&] { return volumes + out.size() + 1; };
  for (std::size_t n = 0; n < found.segmentations.size(); ++n) {
    const DicomHeader& h = found.segmentations[n];
    out.push_back({Kind::segmentation, n, h.series, one_line(h, number() - 1), h.study_date});
  }
  const bool one_frame = std::all_of(
      found.segmentations.begin(), found.segmentations.end(), [&](const DicomHeader& h) {
        return h.frame_of_reference == found.segmentations.front().frame_of_reference;
      });
  if (found.segmentations.size() > 1 && one_frame)
    out.push_back({Kind::all_segmentations, 0, "",
                   fmt::format("#{}: all {} segmentations as one label map", number(),
                               found.segmentations.size()),
                   found.segmentations.front().study_date});
  for (std::size_t n = 0; n < found.contour_sets.size(); ++n) {
    const DicomHeader& h = found.contour_sets[n];
    out.push_back({Kind::contours, n, h.series,
                   fmt::format("#{}: contours (RTSTRUCT) as a label map", number()), h.study_date});
  }
  return out;
}

Result<std::optional<LabelSource>> choose_labels(const std::vector<LabelSource>& all,
                                                 const std::vector<std::string>& series,
                                                 std::size_t volumes, const ReadOptions& options,
                                                 const std::string& file, Scan& scan) {
  const std::optional<LabelSource> none;
  if (all.empty()) return none;
  const std::string list = list_of(all);
  if (!options.series.empty()) {
    const std::size_t mark = std::min(options.series.find('#'), options.series.size());
    const std::string uid = options.series.substr(0, mark);
    const bool numbered = mark < options.series.size();
    std::int64_t place = 0;
    if (numbered && (!to_number(options.series.substr(mark + 1), place) || place < 1))
      return none;  // choose() says what is wrong
    if (uid.empty()) {
      const auto n = static_cast<std::size_t>(place - 1);
      if (n >= volumes && n - volumes < all.size()) return std::optional(all[n - volumes]);
      if (volumes > 0) return none;
    }
    const bool scan_fits =
        !uid.empty() && std::any_of(series.begin(), series.end(),
                                    [&](const std::string& s) { return s.rfind(uid, 0) == 0; });
    if (scan_fits) return none;
    std::vector<std::size_t> fits;
    std::set<std::string> different;
    for (std::size_t n = 0; n < all.size(); ++n)
      if (!uid.empty() && all[n].series.rfind(uid, 0) == 0) {
        fits.push_back(n);
        different.insert(all[n].series);
      }
    if (different.size() == 1 && place <= static_cast<std::int64_t>(fits.size()))
      return std::optional(all[fits[numbered ? static_cast<std::size_t>(place - 1) : 0]]);
    if (volumes > 0 && fits.empty()) return none;
    return error(Trouble::usage, fmt::format("{}: {} series match `series` \"{}\"; there are {}",
                                             file, different.size(), options.series, list));
  }
  if (volumes > 0) {
    scan.notices.push_back(fmt::format("Beside the scan {} ({}); left out, choose with `series`.",
                                       kinds_in_words(all), list));
    return none;
  }
  const auto together = std::find_if(all.begin(), all.end(), [](const LabelSource& one) {
    return one.kind == Kind::all_segmentations;
  });
  // recordings of before 2026-11-29 were made from the first
  if (together != all.end() && options.check_scan) return std::optional(*together);
  if (all.size() > 1)
    scan.notices.push_back(fmt::format(
        "{} label maps found ({}); #1 is used, choose another with `series`.", all.size(), list));
  return std::optional(all.front());
}

Status read_labels(const LabelSource& source, const Found& found,
                   const std::vector<Volume>& volumes, const ReadVolume& read_volume,
                   const ReadOptions& options, const std::string& file, Scan& scan,
                   Progress& progress) {
  if (source.kind == Kind::contours)
    return read_contour_labels(found.contour_sets[source.index], found, volumes, read_volume, scan,
                               progress);
  if (source.kind == Kind::all_segmentations)
    return read_all_segmentations(found, options, file, scan, progress);
  const DicomHeader& header = found.segmentations[source.index];
  return read_segmentation(header, options, short_name(header.path), scan, progress);
}

}  // namespace burr::io
