// io/read/volume_folder.h - a folder (or archive) of several NIfTI, NRRD and MetaImage files: a scan beside its labels,
// or masks, one file a structure, which become one label map. Internal to io.
//
// A mask holds one value above 0, or a probability from 0 to 1, of which half and more is inside. Its structure has the
// name of the file. Masks may be cut to their structure, or have exchanged axes, as long as their voxels lie in one grid.
// Units: mm. Frame: LPS. Thread: one at a time. Memory: one file at a time, and merge_structures.h.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

// "a.nii, b.nii and 5 more"
[[nodiscard]] std::string names_of(const std::vector<std::filesystem::path>& files);

struct VolumeFolder {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  // two or more, sorted
  // reads one of them
  std::function<Result<Scan>(const std::filesystem::path&)> read;
};

// The scan, if there is one (then the labels beside it are the second line of Scan::series); else the masks as one label
// map. Error: several scans, or several label maps of several structures each.
[[nodiscard]] Result<Scan> read_volume_folder(const VolumeFolder& in, const ReadOptions& options,
                                              Progress& progress);

}  // namespace burr::io
