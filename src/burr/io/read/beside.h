// io/read/beside.h - the data file that a header names, which must lie beside the header: on the disk, or
// in the same archive. Internal to io.
//
// Headers come from other computers. Where no file has exactly the name, the one is taken that people
// would call the same (letters.h), and of a name with folders ("D:\scans\jaw.raw") its last part. Only
// regular files in the header's own folder are looked at, whatever the name says.
// Thread: any.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "burr/base/result.h"

namespace burr::io {

// A regular file, no link; in an archive, one of its files.
[[nodiscard]] bool file_is_there(const std::filesystem::path& path);

// The file of that name beside another one. Nothing: none, or several that differ in their letters.
[[nodiscard]] std::optional<std::filesystem::path> find_beside(const std::filesystem::path& header,
                                                               const std::string& name);

struct DataFile {
  std::filesystem::path path;
  std::string notice;  // what the name said and what was taken; empty: it is exactly the name
};
// Error: the name leads elsewhere and no such file lies beside the header. Where the name is a plain one
// that is not there, the path that it should have.
[[nodiscard]] Result<DataFile> data_file_beside(const std::filesystem::path& header,
                                                const std::string& name);

}  // namespace burr::io
