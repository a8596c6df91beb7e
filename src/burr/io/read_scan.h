// io/read_scan.h - whatever people have becomes a Scan: DICOM (file or folder), NRRD and .seg.nrrd,
// NIfTI, MetaImage.
//
//     auto scan = io::read_scan("ct_folder", {}, progress);
//     if (!scan) return scan.error();
//
// In: mm, any orientation. Out: LPS mm, right-handed orthogonal axes, slices upright and evenly
// spaced; what had to be done for that is in Scan::notices.
//
// Trust: a header is compared with the real size of the file before memory is taken; a data file
// named by a header must lie beside it; only regular files are opened. Wrong files give an Error
// (data, or io where the file cannot be read), never an abort.
// Thread: any; uses up to two workers to decode DICOM. Errors and notices name files without their
// folder and hold no patient data.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

struct ReadOptions {
  std::string series;                 // Series Instance UID or how it begins, or the number
                                      // shown by info ("#2"); empty: the best one
  math::Vec3 spacing_mm = {0, 0, 0};  // all > 0: overrides the file
};

[[nodiscard]] Result<Scan> read_scan(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);

}  // namespace burr::io
