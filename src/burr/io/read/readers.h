// io/read/readers.h - one reader per format; read_unfenced.cpp picks. They are in `burr-read`, behind
// the fence, and not in libburr: a header of this room only.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_scan.h"

namespace burr::io {

// Without the fence, in this process: what burr-read calls, and what fuzzers look at. A crash of a
// library under us is a crash.
[[nodiscard]] Result<Scan> read_unfenced(const std::filesystem::path& path,
                                         const ReadOptions& options, Progress& progress);

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
