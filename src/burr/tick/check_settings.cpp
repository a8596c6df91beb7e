// Refuses settings that no session can have (setting_table.h).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "burr/tick/second_hand.h"
#include "burr/tick/setting_table.h"

namespace burr::tick {
namespace {

// The fewest digits that give the same value. Not by std::to_chars, which the library of the browser's
// compiler lacks for numbers with a point.
std::string text_of(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  constexpr int kMostDigits = 17, kLongest = 15;
  char text[64];
  int digits = 1;
  for (; digits <= kMostDigits; ++digits) {
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  const int exponent = std::atoi(std::strchr(text, 'e') + 1);
  if (exponent >= -4 && exponent <= kLongest)
    std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - exponent), value);
  std::string all = text;
  std::replace(all.begin(), all.end(), ',', '.');  // a program may have set such a language
  return all;
}

// Times this, six digits of a number are whole.
double six_digits(double value) {
  return std::pow(10, std::max(0.0, 5 - std::floor(std::log10(std::abs(value)))));
}

double with_six_digits(double value) {
  return value == 0 ? 0 : std::round(value * six_digits(value)) / six_digits(value);
}

// A limit with six digits, without what is left of its way from one unit to another; never one outside.
double rounded(double limit, bool most) {
  if (limit == 0) return 0;
  constexpr double kClose = 1e-6;  // of such a digit
  const double scale = six_digits(limit);
  const double whole = std::round(limit * scale);
  const double over = whole - limit * scale;  // beyond the limit, as it stands for `most`
  if ((most ? over : -over) <= kClose) return whole / scale;
  return (whole + (most ? -1 : 1)) / scale;
}

std::string range_text(const About& about, double least, double most, const char* unit) {
  if (about.kind == About::Kind::flag) return "0 or 1";
  if (about.kind == About::Kind::choice) {
    std::string all;
    for (const std::string_view name : about.choices)
      all += (all.empty() ? "one of " : ", ") + std::string(name);
    return all;
  }
  std::string all = about.kind == About::Kind::whole ? "a whole number from " : "a number from ";
  all += text_of(rounded(least, false)) + " to " + text_of(rounded(most, true));
  if (*unit != '\0') all += std::string(" ") + unit;
  return all;
}

Status check_one(const About& about, double value) {
  if (about.range.has(value)) return fine();
  return error(Trouble::usage, std::string(about.name) + ": must be " +
                                   range_of(about, about.range) + ", not " + text_of(value));
}

template <class Of>
Status check_all(std::span<const Setting<Of>> table, const Of& settings) {
  for (const Setting<Of>& one : table)
    if (Status good = check_one(one.about, one.get(settings)); !good) return good;
  return fine();
}

}  // namespace

Status check_settings(const ServoSettings& settings) {
  if (Status good = check_all(servo_settings(), settings); !good) return good;
  return check_all(limit_settings(), settings.limit);
}

Status check_settings(const volume::IsoSettings& settings) {
  return check_all(surface_settings(), settings);
}

Status check_settings(const SecondHandSettings& settings) {
  Status good = check_all(second_hand_settings(), settings);
  if (good) good = check_all(limit_settings(), settings.limit);
  if (good) return good;
  return error(Trouble::usage, "the second hand's " + good.error().text);
}

Status check_settings(const device::DeviceSpec& spec) {
  const Status good = check_all(device_settings(), spec);
  if (good) return good;
  return error(Trouble::usage, "the device \"" + spec.name + "\": " + good.error().text);
}

std::string typed_range(const About& about) {
  const Typed& typed = about.typed;
  return range_text(about, typed.from_si(about.range.least), typed.from_si(about.range.most),
                    typed.unit);
}

Status check_typed(const About& about, double value) {
  const bool whole = about.kind == About::Kind::number || value == std::floor(value);
  if (whole && about.range.has(about.typed.to_si(value))) return fine();
  return error(Trouble::usage, "must be " + typed_range(about) + ", not " + text_of(value));
}

std::string range_of(const About& about, const Range& range) {
  return range_text(about, range.least, range.most, about.unit);
}

double typed_usual(const Setting<ServoSettings>& setting) {
  return with_six_digits(setting.about.typed.from_si(setting.get(ServoSettings())));
}

std::string number_text(double value) { return text_of(with_six_digits(value)); }

std::optional<double> choice_named(const About& about, std::string_view name) {
  const auto found = std::find(about.choices.begin(), about.choices.end(), name);
  if (found == about.choices.end()) return std::nullopt;
  return static_cast<double>(found - about.choices.begin());
}

}  // namespace burr::tick
