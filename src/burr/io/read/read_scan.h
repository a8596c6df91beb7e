// io/read/read_scan.h - whatever people have becomes a Scan: DICOM (file or folder), NRRD and .seg.nrrd,
// NIfTI, MetaImage.
//
//     auto scan = io::read_scan("ct_folder", {}, progress);
//     if (!scan) return scan.error();
//
// In: mm, any orientation. Out: LPS mm, right-handed orthogonal axes, slices upright and evenly
// spaced; what had to be done for that is in Scan::notices.
//
// Trust: a header is compared with the real size of the file before memory is taken; a data file
// named by a header must lie beside it; only regular files are opened, and no link that leads out
// of the folder. Reading happens behind a fence (fence.h): in a process of its own, with limits, so
// that even a crash or an endless loop of a library under us is an Error (data, or io where the
// file cannot be read), never an abort.
// Thread: any, several at once; the reader uses up to two workers to decode DICOM. Cancelling ends
// the reader within a twentieth of a second. Errors and notices name files without their folder and
// hold no patient data.
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
  // Limits of the fence; 0: by how large the files are. They are far above what reading takes, so
  // only a file that lies, or a very strongly packed one, meets them.
  double seconds = 0;    // of processor time; also the longest it may stand still
  double memory_mb = 0;  // of address space
};

[[nodiscard]] Result<Scan> read_scan(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);

}  // namespace burr::io
