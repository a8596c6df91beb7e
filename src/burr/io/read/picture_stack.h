// io/read/picture_stack.h - a stack of grey pictures (TIFF, PNG, BMP) as a volume: a folder of them, or the
// pages of one TIFF file. Internal to io.
//
// Pictures state no place in the patient: the columns are taken to run to the left, the rows to the back and
// the pictures upwards, and a notice says so. What TIFF says of the size of a voxel is used (picture_scale.h);
// otherwise it is asked for.
// Thread: any.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

// One file; a single picture is refused.
[[nodiscard]] Result<Scan> read_picture(const std::filesystem::path& path,
                                        const ReadOptions& options, Progress& progress);

// The pictures among the files of a folder.
[[nodiscard]] std::vector<std::filesystem::path> pictures_among(
    const std::vector<std::filesystem::path>& files);

// files: the pictures of a folder, one at least; folder: its name, for sentences
[[nodiscard]] Result<Scan> read_picture_stack(const std::vector<std::filesystem::path>& files,
                                              const std::string& folder, const ReadOptions& options,
                                              Progress& progress);

}  // namespace burr::io
