// Refuses settings that no session can have (setting_table.h).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "burr/tick/second_hand.h"
#include "burr/tick/setting_table.h"

namespace burr::tick {
namespace {

using Kind = About::Kind;

// The fewest digits that give the same value. Not by std::to_chars, which the library of the browser's
// compiler lacks for numbers with a point.
std::string shortest(double value) {
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
  if (about.kind == Kind::choice) {
    std::string all;
    for (const std::string_view name : about.choices)
      all += (all.empty() ? "one of " : ", ") + std::string(name);
    return all;
  }
  std::string all = about.kind == Kind::whole ? "a whole number from " : "a number from ";
  all += shortest(rounded(least, false)) + " to " + shortest(rounded(most, true));
  if (*unit != '\0') all += std::string(" ") + unit;
  return all;
}

Status check_one(const About& about, double value) {
  if (about.range.has(value)) return fine();
  return error(Trouble::usage, std::string(about.name) + ": must be " +
                                   range_of(about, about.range) + ", not " + shortest(value));
}

template <class Of>
Status check_all(std::span<const Setting<Of>> table, const Of& settings) {
  for (const Setting<Of>& one : table)
    if (Status good = check_one(one.about, one.get(settings)); !good) return good;
  return fine();
}

// Short, and without what moves a terminal's cursor; base/printable.h is no part of the core.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string all(text.substr(0, kMost));
  for (char& c : all)
    if (c < ' ' || c > '~') c = '?';
  return '"' + all + (text.size() > kMost ? "...\"" : "\"");
}

// In the person's unit; none: it is of another kind.
std::optional<double> number_of(const About& about, const base::Given& given) {
  if (about.kind == Kind::flag) {
    const bool* yes = std::get_if<bool>(&given);
    return yes != nullptr ? std::optional<double>(*yes ? 1 : 0) : std::nullopt;
  }
  if (about.kind == Kind::choice) {
    const std::string* name = std::get_if<std::string>(&given);
    return name != nullptr ? choice_named(about, *name) : std::nullopt;
  }
  if (const std::int64_t* whole = std::get_if<std::int64_t>(&given))
    return static_cast<double>(*whole);
  const double* number = std::get_if<double>(&given);
  const bool fits =
      number != nullptr && (about.kind == Kind::number || *number == std::floor(*number));
  return fits ? std::optional<double>(*number) : std::nullopt;
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
  if (about.kind == Kind::flag) return "true or false";
  const Typed& typed = about.typed;
  return range_text(about, typed.from_si(about.range.least), typed.from_si(about.range.most),
                    typed.unit);
}

std::string range_of(const About& about, const Range& range) {
  if (about.kind == Kind::flag) return "0 or 1";
  return range_text(about, range.least, range.most, about.unit);
}

const char* property_of(const About& about) {
  return about.typed.property != nullptr ? about.typed.property : about.typed.word;
}

Result<double> si_of(const About& about, const base::Given& given) {
  if (const std::optional<double> value = number_of(about, given)) {
    const double si = about.typed.to_si(*value);
    if (about.range.has(si)) return si;
  }
  return error(Trouble::usage, "must be " + typed_range(about) + ", not " + text_of(given));
}

Status take_typed(const TypedValues& values,
                  const std::function<std::string(const About&)>& word_of,
                  ServoSettings& settings) {
  for (const Setting<ServoSettings>& one : servo_settings()) {
    if (one.about.typed.word == nullptr) continue;
    const auto given = values.find(std::string_view(one.about.typed.word));
    if (given == values.end()) continue;
    const Result<double> si = si_of(one.about, given->second);
    if (!si) return error(si.error().trouble, word_of(one.about) + ": " + si.error().text);
    one.set(settings, *si);
  }
  return fine();
}

base::Given usual_value(const Setting<ServoSettings>& setting) {
  const About& about = setting.about;
  const double usual = setting.get(ServoSettings());
  if (about.kind == Kind::flag) return usual != 0;
  if (about.kind == Kind::choice)
    return std::string(about.choices[static_cast<std::size_t>(usual)]);
  const double typed = with_six_digits(about.typed.from_si(usual));
  if (about.kind == Kind::whole) return static_cast<std::int64_t>(typed);
  return typed;
}

TypedValues usual_values() {
  TypedValues all;
  for (const Setting<ServoSettings>& one : servo_settings())
    if (one.about.typed.word != nullptr) all[one.about.typed.word] = usual_value(one);
  return all;
}

std::string text_of(const base::Given& given) {
  if (const bool* yes = std::get_if<bool>(&given)) return *yes ? "true" : "false";
  if (const double* number = std::get_if<double>(&given)) return shortest(*number);
  if (const std::int64_t* whole = std::get_if<std::int64_t>(&given)) return std::to_string(*whole);
  return quoted(std::get<std::string>(given));
}

std::optional<double> choice_named(const About& about, std::string_view name) {
  const auto found = std::find(about.choices.begin(), about.choices.end(), name);
  if (found == about.choices.end()) return std::nullopt;
  return static_cast<double>(found - about.choices.begin());
}

}  // namespace burr::tick
