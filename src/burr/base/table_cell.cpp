#include "burr/base/table_cell.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace burr::base {
namespace {

constexpr std::string_view kBegins = "=+-@\t\r\n";

// "-0.5", "-3e-7": digits, not "-inf", which a spreadsheet takes for a name.
bool is_number(std::string_view text) {
  double value = 0;
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool digits = std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
  });
  return wrong == std::errc() && end == text.data() + text.size() && digits;
}

// Apostrophes, and then what a formula begins with.
bool begins_like_formula(std::string_view text) {
  const std::size_t first = text.find_first_not_of('\'');
  return first != std::string_view::npos && kBegins.find(text[first]) != std::string_view::npos;
}

}  // namespace

std::string guarded_cell(std::string_view text) {
  const bool as_it_is = !begins_like_formula(text) || is_number(text);
  return as_it_is ? std::string(text) : "'" + std::string(text);
}

std::string table_cell(std::string_view text) {
  const std::string cell = guarded_cell(text);
  // a semicolon or a tab divides cells where a computer's language has a decimal comma; a # begins a remark
  const bool plain =
      cell.find_first_of(",;\t\"\r\n") == std::string::npos &&
      (cell.empty() || (cell.front() != ' ' && cell.back() != ' ' && cell[0] != '#'));
  if (plain) return cell;
  std::string out = "\"";
  for (const char c : cell) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string text_of_cell(std::string_view cell) {
  if (cell.starts_with('\'') && begins_like_formula(cell)) cell.remove_prefix(1);
  return std::string(cell);
}

}  // namespace burr::base
