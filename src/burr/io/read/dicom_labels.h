// io/read/dicom_labels.h - what lies beside the volumes of a DICOM folder and becomes a label map: segmentations, all of
// them as one, and structure sets (contours). Internal to io.
//
// They follow the volumes in the list that `--series "#2"` counts: each segmentation, then, if there are several in one
// frame of reference, all of them as one label map, then the structure sets.
// Units: mm. Frame: LPS. Thread: one at a time. Errors and names: no patient data.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

struct LabelSource {
  enum class Kind { segmentation, all_segmentations, contours };
  Kind kind = Kind::segmentation;
  std::size_t index = 0;  // in Found::segmentations or Found::contour_sets; of all: 0
  std::string series;     // UID; of all: empty
  std::string line;       // for the list of series
  std::string date;       // of the study
};
// volumes: how many lines come before.
[[nodiscard]] std::vector<LabelSource> label_sources(const Found& found, std::size_t volumes);

// The one that the options name, or, where there is no volume, the first, or all segmentations as one. Nothing: a volume
// is to be taken; if label maps lie beside it, a notice says so. series: UIDs of the volumes' series.
[[nodiscard]] Result<std::optional<LabelSource>> choose_labels(
    const std::vector<LabelSource>& all, const std::vector<std::string>& series,
    std::size_t volumes, const ReadOptions& options, const std::string& file, Scan& scan);

// Reads one volume of the folder: its place in the list.
using ReadVolume = std::function<Status(std::size_t volume, Scan& scan)>;

// Reads it into the scan, whose notices stay.
[[nodiscard]] Status read_labels(const LabelSource& source, const Found& found,
                                 const std::vector<Volume>& volumes, const ReadVolume& read_volume,
                                 const ReadOptions& options, const std::string& file, Scan& scan,
                                 Progress& progress);

}  // namespace burr::io
