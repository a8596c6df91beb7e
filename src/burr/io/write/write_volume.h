// io/write/write_volume.h - writes a bone as voxels. LPS, millimetres, gzip.
//
//     write_field    .nrrd      unsigned short: 0 air .. 32768 surface .. 65535 solid
//     write_scan     .nrrd      short: the scan's own values (HU), lowered where bone was cut
//     write_labels   .seg.nrrd  unsigned char: a segment with name and colour per tissue, keys as
//                               3D Slicer writes them
//
// A file is written under another name beside its final place and then renamed. Errors:
// Trouble::io, Trouble::data (nothing to write), Trouble::interrupted. Thread: any; the bone must
// be at rest.
#pragma once

#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::io {

[[nodiscard]] Status write_field(const volume::Bone& bone, const std::string& path,
                                 Progress& progress);

// now: the bone `before` after cutting. If a fraction of a voxel's field was cut, its value falls
// by the same fraction towards air (-1000). Needs a bone made from a scan (has_intensity).
[[nodiscard]] Status write_scan(const volume::Bone& before, const volume::Bone& now,
                                const std::string& path, Progress& progress);

// Solid tissue counts where the field is at or above the surface value, soft tissue in every voxel
// that has its id. There is a segment for every tissue but air, even if nothing of it is left.
[[nodiscard]] Status write_labels(const volume::Bone& bone, const std::string& path,
                                  Progress& progress);

// (tissues) The value written for each tissue: the file's own label if these are 1..255 and all
// different, otherwise the tissue's id. [0] is 0, air.
[[nodiscard]] std::vector<int> label_values(const volume::TissueTable& tissues);

}  // namespace burr::io
