// io/read/readers.h - one reader per format; read_unfenced.cpp chooses. They are part of
// `burr-read`, behind the fence, and not of libburr. For use of this room only.
#pragma once

#include <filesystem>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/read_scan.h"

namespace burr::io {

// Reads without the fence, in this process: for burr-read and for the fuzzers. If a library that is
// used here crashes, this process crashes.
[[nodiscard]] Result<Scan> read_unfenced(const std::filesystem::path& path,
                                         const ReadOptions& options, Progress& progress);

// Each one recognizes its files by their first bytes or their name.
[[nodiscard]] Result<Scan> read_nrrd(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);
[[nodiscard]] Result<Scan> read_nifti(const std::filesystem::path& path, const ReadOptions& options,
                                      Progress& progress);
[[nodiscard]] Result<Scan> read_meta(const std::filesystem::path& path, const ReadOptions& options,
                                     Progress& progress);
// path: one file, or a folder, which is searched with its subfolders
[[nodiscard]] Result<Scan> read_dicom(const std::filesystem::path& path, const ReadOptions& options,
                                      Progress& progress);

// path: the description file (.yaml) of AMBF, which names PNG pictures (adf_folder.h)
[[nodiscard]] Result<Scan> read_adf(const std::filesystem::path& path, const ReadOptions& options,
                                    Progress& progress);
// Whether a .yaml file is such a description. Error: it is no YAML.
[[nodiscard]] Result<bool> describes_pictures(const std::filesystem::path& path);

}  // namespace burr::io
