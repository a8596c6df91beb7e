// base/trimmed.h - a text without the blanks around it.
//
// Thread: any.
#pragma once

#include <string_view>

namespace burr::base {

// Blanks are spaces, tabs, ends of lines, and zeros.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
  };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace burr::base
