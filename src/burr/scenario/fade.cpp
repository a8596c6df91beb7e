#include "burr/scenario/fade.h"

#include <charconv>
#include <system_error>

namespace burr::scenario {
namespace {

constexpr std::uint32_t kMostAttempts = 1000;
constexpr std::string_view kAlternate = "alternate:";

std::optional<std::uint32_t> attempts_of(std::string_view digits) {
  std::uint32_t value = 0;
  const auto done = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (done.ec != std::errc() || done.ptr != digits.data() + digits.size() || value > kMostAttempts)
    return std::nullopt;
  return value;
}

}  // namespace

std::optional<Fade> fade_of(std::string_view text) {
  Fade fade;
  for (;;) {
    const std::size_t comma = text.find(',');
    std::string_view part = text.substr(0, comma);
    if (part == "on" || part == "off") {
      fade.after = part == "on";
      if (comma != std::string_view::npos) return std::nullopt;  // nothing comes after it
      return fade;
    }
    if (comma == std::string_view::npos) return std::nullopt;
    const bool alternate = part.starts_with(kAlternate);
    if (alternate) part.remove_prefix(kAlternate.size());
    const auto attempts = attempts_of(part);
    if (!attempts) return std::nullopt;
    fade.parts.push_back({*attempts, alternate});
    text.remove_prefix(comma + 1);
  }
}

bool guided(const Fade& fade, std::uint32_t attempt, bool marks_fell) {
  if (attempt == 0 || marks_fell) return true;
  for (const Fade::Part& part : fade.parts) {
    if (attempt <= part.attempts) return !part.alternate || attempt % 2 == 0;
    attempt -= part.attempts;
  }
  return fade.after;
}

}  // namespace burr::scenario
