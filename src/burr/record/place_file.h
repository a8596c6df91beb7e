// record/place_file.h - a file written beside takes its final name, for good; and who is writing
// it.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::record {

// Renames and brings the folder's entry to the disk. On failure both files stay as they were.
[[nodiscard]] Status place_file(const std::string& beside, const std::string& path);

// true: a recorder has it open (McapWriter holds a lock, which ends with its process).
[[nodiscard]] bool being_written(const std::string& path);

}  // namespace burr::record
