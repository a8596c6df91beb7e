// What a DICOM folder or file holds: volumes, segmentations, contours; and the one of them that is read.
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/dicom_labels.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/dicom_slices.h"
#include "burr/io/read/readers.h"

namespace burr::io {
namespace {

// The number of the study that each volume belongs to, from 1 in the order of the volumes.
std::vector<std::size_t> studies_of(const std::vector<Series>& series,
                                    const std::vector<Volume>& volumes) {
  std::map<std::string, std::size_t> known;
  std::vector<std::size_t> studies;
  for (const Volume& volume : volumes) {
    const std::string& uid = series[volume.series].files[volume.slices.front().file].study;
    studies.push_back(known.try_emplace(uid, known.size() + 1).first->second);
  }
  return studies;
}

// One line for each volume and label map, where there are several.
void list_all(const Found& found, const std::vector<Volume>& volumes,
              const std::vector<LabelSource>& labels, Scan& scan) {
  // more than anyone would look through; beyond this, choose with --series
  constexpr std::size_t kListed = 1000;
  const std::size_t listed = volumes.size() + labels.size();
  if (listed > 1 && listed <= kListed) {
    const std::vector<std::size_t> studies = studies_of(found.series, volumes);
    const bool several = std::any_of(studies.begin(), studies.end(), [](auto n) { return n > 1; });
    for (std::size_t v = 0; v < volumes.size(); ++v) {
      const Series& series = found.series[volumes[v].series];
      scan.series.push_back(one_line(series, volumes[v], v) +
                            (several ? fmt::format(", study {}", studies[v]) : ""));
      scan.series_dates.push_back(series.files[volumes[v].slices.front().file].study_date);
    }
    for (const LabelSource& one : labels) {
      scan.series.push_back(one.line);
      scan.series_dates.push_back(one.date);
    }
  }
}

Status take_study(const DicomHeader& h, const ReadOptions& options, Scan& scan) {
  if (!options.study) return fine();
  auto study = read_dicom_study(h.path);
  if (!study) return study.error();
  scan.study = std::move(*study);
  return fine();
}

struct Labels {
  const Found& found;
  const std::vector<Volume>& volumes;
  const std::vector<LabelSource>& all;
  const LabelSource& source;
};

// Segmentations that lie on different grids cannot become one label map; unless somebody asked for it, the first is read.
Result<Scan> labels_of(const Labels& in, const ReadOptions& options,
                       const std::filesystem::path& path, Scan scan, Progress& progress) {
  const DicomHeader* drawn_on = nullptr;  // of the contours
  const ReadVolume read_volume = [&](std::size_t volume, Scan& into) {
    const Volume& it = in.volumes[volume];
    drawn_on = &in.found.series[it.series].files[it.slices.front().file];
    return read_dicom_volume(in.found, in.volumes[volume], options, path, into, progress);
  };
  const LabelSource* source = &in.source;
  Scan read = scan;
  Status status = read_labels(*source, in.found, in.volumes, read_volume, options, short_name(path),
                              read, progress);
  if (!status && status.error().trouble == Trouble::data && options.series.empty() &&
      source->kind == LabelSource::Kind::all_segmentations) {
    const std::string why = status.error().text;
    source = &in.all.front();
    read = std::move(scan);
    read.notices.push_back(fmt::format("{}. {} is used, choose another with `series`.", why,
                                       source->line.substr(0, source->line.find(':'))));
    status = read_labels(*source, in.found, in.volumes, read_volume, options, short_name(path),
                         read, progress);
  }
  if (!status) return status.error();
  const auto place = std::find_if(in.all.begin(), in.all.end(),
                                  [&](const LabelSource& one) { return one.line == source->line; });
  if (!read.series.empty())
    read.series_taken =
        static_cast<int>(in.volumes.size()) + static_cast<int>(place - in.all.begin());
  // a set of contours names no frame of reference of its own
  const DicomHeader& header =
      drawn_on != nullptr ? *drawn_on : in.found.segmentations[source->index];
  if (status = take_study(header, options, read); !status) return status.error();
  return read;
}

// Why a folder or an archive holds no scan.
Error nothing_in(const Found& found, const std::string& file) {
  if (!found.listed.empty() && found.others == 0)
    return error(
        fmt::format("{}: its DICOMDIR lists {} pictures, and none of them is here; copy the "
                    "whole disc, or give the folder that holds them",
                    file, found.listed.size()));
  if (found.others == 1 && !found.last_reason.empty())
    return error(found.last_trouble, found.last_reason);
  return error(fmt::format("{}: none of its {} files is a slice of a scan (for example {})", file,
                           found.others, found.last_reason));
}

}  // namespace

Result<Scan> read_dicom(const std::filesystem::path& path, const ReadOptions& options,
                        Progress& progress) {
  const std::string file = short_name(path);
  auto found = find_series(path, progress);
  if (!found) return found.error();
  if (found->series.empty() && found->segmentations.empty() && found->contour_sets.empty())
    return nothing_in(*found, file);
  Scan scan;
  scan.format = "DICOM";
  if (found->leading_out > 0)
    scan.notices.push_back(
        fmt::format("{} links lead out of the folder and were not followed.", found->leading_out));
  const std::vector<Volume> volumes = volumes_of(found->series);
  const std::vector<LabelSource> labels = label_sources(*found, volumes.size());
  list_all(*found, volumes, labels, scan);
  std::vector<std::string> uids;
  for (const Series& one : found->series) uids.push_back(one.uid);
  const auto source = choose_labels(labels, uids, volumes.size(), options, file, scan);
  if (!source) return source.error();
  if (*source)
    return labels_of({*found, volumes, labels, **source}, options, path, std::move(scan), progress);
  auto chosen = choose(*found, volumes, options, file, scan);
  if (!chosen) return chosen.error();
  if (!scan.series.empty()) scan.series_taken = static_cast<int>(*chosen);
  if (Status status = read_dicom_volume(*found, volumes[*chosen], options, path, scan, progress);
      !status)
    return status.error();
  const Volume& volume = volumes[*chosen];
  const DicomHeader& h = found->series[volume.series].files[volume.slices.front().file];
  if (Status status = take_study(h, options, scan); !status) return status.error();
  return scan;
}

}  // namespace burr::io
