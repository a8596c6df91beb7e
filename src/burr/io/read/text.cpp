#include "burr/io/read/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace burr::io {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
  };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> out;
  std::string word;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      if (!word.empty()) out.push_back(std::move(word));
      word.clear();
    } else {
      word += c;
    }
  }
  if (!word.empty()) out.push_back(std::move(word));
  return out;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool to_number(std::string_view text, double& out) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  if (lower(text) == "nan") {
    out = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

bool to_number(std::string_view text, std::int64_t& out) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

std::vector<double> numbers(std::string_view text) {
  std::string plain(text);
  for (char& c : plain)
    if (c == ',' || c == '(' || c == ')' || c == '[' || c == ']') c = ' ';
  std::vector<double> out;
  for (const std::string& word : words(plain)) {
    double value = 0;
    if (!to_number(word, value)) return {};
    out.push_back(value);
  }
  return out;
}

std::vector<double> numbers(std::string_view text, std::size_t count, bool& commas) {
  std::vector<double> plain = numbers(text);
  if (plain.size() == count) return plain;
  std::string spaced(text);
  if (spaced.find(',') == std::string::npos || spaced.find('.') != std::string::npos) return {};
  for (char& c : spaced)
    if (c == '(' || c == ')' || c == '[' || c == ']') c = ' ';
  std::vector<std::string> pieces = words(spaced);
  if (pieces.size() == 1) {  // "1,5,2,5": every second comma is a decimal one
    std::size_t n = 0;
    for (char& c : spaced)
      if (c == ',' && n++ % 2 == 1) c = ' ';
    pieces = words(spaced);
  }
  std::vector<double> out;
  bool decimal = false;
  for (const std::string& piece : pieces) {
    double value = 0;
    if (!to_number(piece, value, decimal)) return {};
    out.push_back(value);
  }
  if (out.size() != count) return {};
  commas = commas || decimal;
  return out;
}

bool to_number(std::string_view text, double& out, bool& commas) {
  std::string point(text);
  const bool comma =
      std::count(point.begin(), point.end(), ',') == 1 && point.find('.') == std::string::npos;
  if (comma) point[point.find(',')] = '.';
  if (!to_number(point, out)) return false;
  commas = commas || comma;
  return true;
}

}  // namespace burr::io
