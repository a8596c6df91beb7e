// base/text_file.h - a small file of text, whole: a case, a table, a log.
//
// Files that may be hostile (scans) are read behind the fence of io/, not here. Errors name the
// file, not where on the disk it lies. Thread: any.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::base {

// for_what: "a case; is this another file?", said of a file of more than `most` bytes.
[[nodiscard]] Result<std::string> text_of_file(const std::string& path, std::uintmax_t most,
                                               std::string_view for_what);

}  // namespace burr::base
