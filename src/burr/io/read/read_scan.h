// io/read/read_scan.h - reads a Scan from the usual formats: DICOM (file or folder, scans and
// segmentations), NRRD and .seg.nrrd, NIfTI, MetaImage, and the volumes of AMBF (PNG and .yaml).
//
//     auto scan = io::read_scan("ct_folder", {}, progress);
//     if (!scan) return scan.error();
//
// Input: mm, any orientation. Output: LPS mm, right-handed orthogonal axes, slices upright and
// evenly spaced; Scan::notices says what was done to get there.
//
// Safety: a header is compared with the real size of the file before memory is allocated; a data
// file named by a header must lie beside it (of AMBF: in a folder there, adf_folder.h); only regular files are opened, and no link that leads
// out of the folder. Reading happens behind a fence (io/sandbox/fence.h): in a separate process
// with limits. So even a crash or an endless loop of a library that burr uses is an Error (data, or
// io where the file cannot be read), never an abort.
// Thread: any, several at once; the reader uses up to two workers to decode DICOM. Cancelling ends
// the reader within 0.05 s. Errors and notices name files without their folder and contain no
// patient data.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

[[nodiscard]] Result<Scan> read_scan(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);

}  // namespace burr::io
