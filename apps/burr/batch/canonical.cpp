#include "batch/canonical.h"

#include <array>
#include <charconv>
#include <cmath>

#include "shared/json_line.h"

namespace burr::app {
namespace {

void write_number(double value, std::string& out) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  std::array<char, 32> text = {};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(text.data(), end.ptr);
}

void write(const nlohmann::json& value, std::string& out) {
  if (value.is_object()) {
    out += '{';
    for (const auto& [key, inside] : value.items()) {  // nlohmann::json keeps them sorted
      if (out.back() != '{') out += ',';
      out += json_line(nlohmann::json(key)) + ":";
      write(inside, out);
    }
    out += '}';
  } else if (value.is_array()) {
    out += '[';
    for (const auto& inside : value) {
      if (&inside != &value.front()) out += ',';
      write(inside, out);
    }
    out += ']';
  } else if (value.is_number_float()) {
    write_number(value.get<double>(), out);
  } else {
    out += json_line(value);
  }
}

}  // namespace

std::string canonical(const nlohmann::json& value) {
  std::string out;
  write(value, out);
  return out;
}

}  // namespace burr::app
