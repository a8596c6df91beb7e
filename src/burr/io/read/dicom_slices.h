// io/read/dicom_slices.h - reads the slices of one volume of a DICOM folder and makes an upright stack of evenly spaced
// slices of them. Internal to io.
//
// Units: mm. Frame: LPS. Thread: one at a time; uses up to two workers to decode. Errors and notices: no patient data.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

// Into the scan, whose notices stay. path: the folder or file that was given.
[[nodiscard]] Status read_dicom_volume(const Found& found, Volume volume,
                                       const ReadOptions& options,
                                       const std::filesystem::path& path, Scan& scan,
                                       Progress& progress);

}  // namespace burr::io
