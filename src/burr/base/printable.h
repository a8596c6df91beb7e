// base/printable.h - makes text from a file safe to print inside a message: short, on one line,
// without characters that move a terminal's cursor.
//
//     error(fmt::format("{}: type: burr does not read \"{}\"", file, base::printable(type)))
//
//     "use one of " + base::list_of(names)
//
// Thread: any.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace burr::base {

// The first `most` bytes. Control characters and invalid UTF-8 become '?'; "..." marks where the
// text was cut.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = 60);

// "nerve, vein": the texts of a list, each made safe, in its order. None: "".
template <class Texts>
[[nodiscard]] std::string list_of(const Texts& texts) {
  std::string list;
  for (const auto& text : texts) list += (list.empty() ? "" : ", ") + printable(text);
  return list;
}

}  // namespace burr::base
