// base/text_file.h - reads a small text file whole: a case, a table, a log.
//
// A UTF-8 byte-order mark is removed; UTF-16 is refused. Files that may be hostile (scans) are read behind the fence of io/, not here. An error names the
// file without its folder. Thread: any.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::base {

// for_what: a phrase for the error message when the file has more than `most` bytes ("{file}: the
// file is too large ({n} bytes) for {for_what}"), for example "a case; check that this is the right
// file".
[[nodiscard]] Result<std::string> text_of_file(const std::string& path, std::uintmax_t most,
                                               std::string_view for_what);

}  // namespace burr::base
