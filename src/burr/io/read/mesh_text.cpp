#include "burr/io/read/mesh_text.h"

#include <fmt/core.h>

#include <charconv>
#include <limits>
#include <system_error>

namespace burr::io {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

Error no_mesh(std::string_view kind, std::string_view why) {
  return error(fmt::format("this is no {} mesh ({})", kind, why));
}

std::string_view MeshText::take_word() {
  const std::size_t from = at_;
  while (at_ < text_.size() && !blank(text_[at_]) && text_[at_] != '\n') ++at_;
  return text_.substr(from, at_ - from);
}

std::string_view MeshText::word() {
  for (; at_ < text_.size() && (blank(text_[at_]) || text_[at_] == '\n'); ++at_)
    if (text_[at_] == '\n') ++line_;
  return take_word();
}

std::string_view MeshText::word_of_line() {
  while (at_ < text_.size()) {
    if (blank(text_[at_])) {
      ++at_;
      continue;
    }
    if (text_[at_] != '\\') break;
    std::size_t end = at_ + 1;
    if (end < text_.size() && text_[end] == '\r') ++end;
    if (end >= text_.size() || text_[end] != '\n') break;
    at_ = end + 1;
    ++line_;
  }
  return take_word();
}

std::string_view MeshText::rest_of_line() {
  const std::size_t from = at_;
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  std::string_view line = text_.substr(from, at_ - from);
  if (at_ < text_.size()) {
    ++at_;
    ++line_;
  }
  while (!line.empty() && blank(line.back())) line.remove_suffix(1);
  return line;
}

std::optional<double> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, trouble] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (trouble == std::errc()) return value;
  if (trouble != std::errc::result_out_of_range) return std::nullopt;
  // too small or too large: the exponent says which
  const std::size_t exponent = word.find_first_of("eE");
  const bool small =
      exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-';
  return small ? 0.0 : std::numeric_limits<double>::infinity();
}

std::optional<long long> whole_number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  long long value = 0;
  const auto [end, trouble] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || trouble != std::errc())
    return std::nullopt;
  return value;
}

bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t n = 0; n < word.size(); ++n) {
    const char c = word[n];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c) != lower[n]) return false;
  }
  return true;
}

}  // namespace burr::io
