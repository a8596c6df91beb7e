// io/readers.h - one reader per format; read_scan.cpp picks. Private to io.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read_scan.h"

namespace burr::io {

// Each knows its own files by their first bytes or their name.
[[nodiscard]] Result<Scan> read_nrrd(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);
[[nodiscard]] Result<Scan> read_nifti(const std::filesystem::path& path, const ReadOptions& options,
                                      Progress& progress);
[[nodiscard]] Result<Scan> read_meta(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);
// a folder, searched with its subfolders, or one file
[[nodiscard]] Result<Scan> read_dicom(const std::filesystem::path& path, const ReadOptions& options,
                                      Progress& progress);

}  // namespace burr::io
