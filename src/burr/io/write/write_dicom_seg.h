// io/write/write_dicom_seg.h - writes labels as a DICOM segmentation (PS3.3 A.51) on the grid of the labels: binary, one
// segment for each structure, or a label map, one number for each voxel.
//
//     auto written = io::write_dicom_seg(scan, "seg.dcm", {.study = ct.study}, progress);
//
// The library that writes DICOM runs in a process of its own, `burr-seg`, which is looked for in the environment variable
// BURR_SEG, then as burr-read is. The file is complete or not there.
//
// Segments without a voxel are left out. Binary: frames without a voxel of their segment are left out too, and segments are
// numbered from 1 without a gap, in the order of their labels, as DICOM wants it. Label map: a frame for each slice from
// the first to the last with a label; segments keep the numbers of their labels, and 0 is the segment "Background" (Pixel
// Padding Value). Segments never overlap, because a voxel has one label.
// Frame: LPS. Thread: any. Memory: the labels, and in the other process three bits for each voxel of each frame.
// Errors: Trouble::io, Trouble::data, Trouble::interrupted, Trouble::usage (a root of UIDs that is none).
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"
#include "burr/io/write/seg_options.h"
#include "burr/volume/bone.h"

namespace burr::io {

struct SegWritten {
  std::vector<SegSegment> segments;
  std::size_t frames = 0;
  std::vector<std::string> notices;  // what the user must know, one sentence each
};

// labels: a label map (Scan::labels); the label 0 is the background.
[[nodiscard]] Result<SegWritten> write_dicom_seg(const Scan& labels, const std::string& path,
                                                 const SegOptions& options, Progress& progress);

// The labels of a bone, on its grid, as write_labels() of write_volume.h writes them; with the names and colours of its
// tissues. Nothing is written.
[[nodiscard]] Scan labels_of_bone(const volume::Bone& bone);

// Recommended Display CIELab Value of a colour of sRGB 0..1; the reader has the inverse (io/read/dicom_seg.h).
[[nodiscard]] std::array<int, 3> dicom_lab_of_srgb(const std::array<float, 3>& rgb);

// A UID that nobody else has: root, a point, and a random number. Error: the root is none, or too long.
[[nodiscard]] Result<std::string> new_uid(const std::string& root);

}  // namespace burr::io
