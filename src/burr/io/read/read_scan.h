// io/read/read_scan.h - reads a Scan from the usual formats: DICOM (file or folder), NRRD and
// .seg.nrrd, NIfTI, MetaImage.
//
//     auto scan = io::read_scan("ct_folder", {}, progress);
//     if (!scan) return scan.error();
//
// Input: mm, any orientation. Output: LPS mm, right-handed orthogonal axes, slices upright and
// evenly spaced; Scan::notices says what was done to get there.
//
// Safety: a header is compared with the real size of the file before memory is allocated; a data
// file named by a header must lie beside it; only regular files are opened, and no link that leads
// out of the folder. Reading happens behind a fence (io/sandbox/fence.h): in a separate process
// with limits. So even a crash or an endless loop of a library that burr uses is an Error (data, or
// io where the file cannot be read), never an abort.
// Thread: any, several at once; the reader uses up to two workers to decode DICOM. Cancelling ends
// the reader within 0.05 s. Errors and notices name files without their folder and contain no
// patient data.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

struct ReadOptions {
  std::string series;                 // Series Instance UID, or its beginning, or the number shown
                                      // by info ("#2"); empty: the best one
  math::Vec3 spacing_mm = {0, 0, 0};  // all > 0: overrides the file
  // Limits of the fence; 0: chosen from the size of the files. They are far above what reading
  // needs; only a damaged or hostile file, or a very strongly compressed one, reaches them.
  double seconds = 0;    // of processor time; also the longest time without progress [s]
  double memory_mb = 0;  // of address space [MiB]
};

[[nodiscard]] Result<Scan> read_scan(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);

}  // namespace burr::io
