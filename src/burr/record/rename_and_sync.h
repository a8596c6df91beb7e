// record/rename_and_sync.h - gives a finished file its final name on disk; tells whether a
// recording is still being written.
//
// Thread: any.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::record {

// Renames the file and brings the folder's entry to the disk. On failure both files stay as they
// were.
[[nodiscard]] Status rename_and_sync(const std::string& beside, const std::string& path);

// True: a recorder has it open (McapWriter holds a lock, which ends with its process). Always false on a
// file system without locks.
[[nodiscard]] bool being_written(const std::string& path);

}  // namespace burr::record
