#include "doctor/finding.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

namespace burr::app {
namespace {

constexpr std::size_t kWide = 100;  // width of a line

const char* name_of(Health health) {
  switch (health) {
    case Health::good:
      return "good";
    case Health::absent:
      return "absent";
    case Health::trouble:
      break;
  }
  return "trouble";
}

// Wraps the text into lines of at most kWide characters.
std::string wrapped(std::string_view words, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  while (!words.empty()) {
    const std::size_t space = words.find(' ');
    const std::string_view word = words.substr(0, space);
    if (column > indent && column + 1 + word.size() > kWide) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
    words = space == std::string_view::npos ? std::string_view() : words.substr(space + 1);
  }
  return out;
}

}  // namespace

std::string text_of(const std::vector<Finding>& findings) {
  constexpr std::size_t kIndent = 24;
  std::string text, group;
  for (const Finding& one : findings) {
    if (one.group != group) text += fmt::format("{}{}\n", group.empty() ? "" : "\n", one.group);
    group = one.group;
    const char* sign = one.health == Health::good     ? "ok"
                       : one.health == Health::absent ? "--"
                                                      : "!!";
    text += fmt::format("  {} {:<18} {}\n", sign, one.what, wrapped(one.value, kIndent));
    if (!one.todo.empty())
      text += fmt::format("{:{}}{}\n", "", kIndent, wrapped("-> " + one.todo, kIndent));
  }
  return text;
}

std::string json_of(const std::vector<Finding>& findings) {
  nlohmann::json out = nlohmann::json::array();
  for (const Finding& one : findings)
    out.push_back({{"group", one.group},
                   {"what", one.what},
                   {"health", name_of(one.health)},
                   {"is", one.value},
                   {"todo", one.todo}});
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace burr::app
