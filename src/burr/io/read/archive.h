// io/read/archive.h - a zip archive read as the folder that was packed into it. Nothing is unpacked
// to a disk: open_file() opens the files inside by their place, as if the archive were a folder.
// Internal to io.
//
// The archive may come from a stranger: its table is compared with the size of the file, names are
// only names (never a path on this computer), an entry may not claim more bytes than its packed
// bytes can hold, and there is a limit to the number of entries.
// Thread: one reading at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "burr/base/result.h"

namespace burr::io {

[[nodiscard]] bool is_zip(const std::vector<std::uint8_t>& head);

// Reads the table of the archive; until the next call its files can be opened as "archive/name".
[[nodiscard]] Status open_archive(const std::filesystem::path& archive);

// The files inside, if this is the archive opened last; otherwise nothing.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> files_in_archive(
    const std::filesystem::path& archive);

// The files of the archive that this path lies in; nothing: it lies on the disk.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> archive_around(
    const std::filesystem::path& path);

}  // namespace burr::io
