#include "burr/school/database.h"

#include <fmt/format.h>

#include <cmath>

namespace burr::school {

std::int64_t whole(const Value& value) {
  if (const auto* n = std::get_if<std::int64_t>(&value)) return *n;
  if (const auto* n = std::get_if<double>(&value)) return std::llround(*n);
  return 0;
}

double number(const Value& value) {
  if (const auto* n = std::get_if<double>(&value)) return *n;
  if (const auto* n = std::get_if<std::int64_t>(&value)) return static_cast<double>(*n);
  return 0;
}

std::string text(const Value& value) {
  const auto* words = std::get_if<std::string>(&value);
  return words != nullptr ? *words : std::string();
}

std::string written(const Value& value) {
  if (const auto* n = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *n);
  if (const auto* n = std::get_if<double>(&value)) return fmt::format("{}", *n);
  return text(value);
}

}  // namespace burr::school
