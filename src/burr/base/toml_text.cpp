#include "burr/base/toml_text.h"

#include <fmt/format.h>

namespace burr::base {

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (code < 0x20 || code == 0x7F)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(code));
    else
      out += c;
  }
  return out + '"';
}

}  // namespace burr::base
