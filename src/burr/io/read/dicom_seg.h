// io/read/dicom_seg.h - DICOM segmentations as labels: Segmentation Storage (BINARY, FRACTIONAL)
// and Label Map Segmentation Storage. Internal to io.
//
// Names, colours and codes come from the Segment Sequence, the place of each frame from the
// functional groups. Slices without a frame are empty. Where segments overlap, the one with fewer
// voxels stays, of two equal ones the later; a notice states in how many voxels.
// Units: mm. Frame: LPS. Thread: one at a time. Errors and names: no patient data.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_header.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

// By its class, or a picture of one bit a pixel.
[[nodiscard]] bool is_segmentation(const DicomHeader& header);

// Why it cannot be read, as the end of a sentence that begins with the file's name; empty: it can,
// as far as its header tells.
[[nodiscard]] std::string no_segmentation(const DicomHeader& header);

// For the list of series: kind, frames, size, number of segments.
[[nodiscard]] std::string one_line(const DicomHeader& segmentation, std::size_t place);

// Reads it into the scan, whose notices stay.
[[nodiscard]] Status read_segmentation(const DicomHeader& header, const ReadOptions& options,
                                       const std::string& file, Scan& scan, Progress& progress);

// sRGB of a CIELab value as DICOM stores it (PS3.3 C.10.7.1.1): 16 bit each, white of D50.
[[nodiscard]] std::array<float, 3> srgb_of_dicom_lab(const std::array<int, 3>& lab);

}  // namespace burr::io
