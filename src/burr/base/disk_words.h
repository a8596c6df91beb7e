// base/disk_words.h - what to do about an error of the file system, by its number (errno).
//
//     path + ": cannot be written: " + disk_trouble(errno)
//     // -> "s.mcap: cannot be written: No space left on device; free some space or choose another disk"
//
// Thread: any.
#pragma once

#include <string>

namespace burr::base {

// The system's words, and a remedy where there is one.
[[nodiscard]] std::string disk_trouble(int number);

// The file system does not offer what was asked of it: locks, or to bring data to the disk at once. Nothing
// is broken, and writing goes on without it.
[[nodiscard]] bool not_offered(int number) noexcept;

}  // namespace burr::base
