// base/shown.h - text out of a file, made fit to stand in a sentence: short, one line, nothing that
// moves a terminal's cursor.
//
//     error(fmt::format("{}: type: \"{}\" is no number burr reads", file, base::shown(type)))
//
// Thread: any.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace burr::base {

// At most `most` bytes of it, control characters and what is no UTF-8 as '?', "..." where it was
// cut.
[[nodiscard]] std::string shown(std::string_view text, std::size_t most = 60);

}  // namespace burr::base
