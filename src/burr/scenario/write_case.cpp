#include "burr/scenario/write_case.h"

#include <fmt/core.h>
#include <safe_toml.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace burr::scenario {
namespace {

// In this order a person reads a case; what is not here comes last.
constexpr std::string_view kOrder[] = {"format",   "title",  "description", "phantom", "volume",
                                       "voxel_mm", "rubric", "tool",        "work",    "burr",
                                       "session",  "demo",   "spare",       "target",  "own_tool",
                                       "landmark", "region", "structure",   "step"};

void put(toml::table& table, std::string_view key, double value) {
  table.insert_or_assign(key, value);
}
void put(toml::table& table, std::string_view key, const std::string& value) {
  if (value.empty())
    table.erase(key);
  else
    table.insert_or_assign(key, value);
}

toml::table session_table(const CaseSettings& wish) {
  toml::table table;
  for (const CaseSettings::Field& field : wish.fields)
    std::visit([&](const auto& value) { table.insert_or_assign(field.word, value); }, field.value);
  return table;
}

// The definition of the tool in a list of tools, if it is there.
Status put_own_tool(const CaseFile& file, toml::table& all) {
  if (file.tool.empty() || file.tools.empty()) return fine();
  const auto tools = parse_toml(file.tools, "the list of tools");
  if (!tools) return tools.error();
  const toml::array* list = tools->get_as<toml::array>("tool");
  if (list == nullptr) return fine();
  for (const toml::node& node : *list) {
    const toml::table* tool = node.as_table();
    if (tool == nullptr || tool->get("name") == nullptr) continue;
    if (tool->get("name")->value_or(std::string()) == file.tool)
      all.insert_or_assign("own_tool", toml::array{*tool});  // the last one counts, as in a rack
  }
  return fine();
}

// ---- TOML as a person writes it. The printer of toml++ gives numbers 17 digits and a line to each
// table; this one writes the shortest number that comes back to the bit, and small tables in a line.

constexpr auto kPlain =
    toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings;

bool is_list_of_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty() || !array->is_array_of_tables()) return false;
  return std::none_of(array->begin(), array->end(),
                      [](const toml::node& one) { return one.as_table()->is_inline(); });
}

void write_key(std::ostream& out, std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  const toml::value<std::string> quoted{std::string(key)};
  if (bare)
    out << key;
  else
    out << toml::toml_formatter(quoted, kPlain & ~toml::format_flags::allow_multi_line_strings);
}

void write_value(std::ostream& out, const toml::node& node) {
  if (const auto* number = node.as_floating_point()) {
    const std::string digits = fmt::format("{}", number->get());
    out << digits << (digits.find_first_of(".en") == std::string::npos ? ".0" : "");
  } else if (const toml::array* array = node.as_array()) {
    out << '[';
    for (std::size_t n = 0; n < array->size(); ++n) {
      out << (n == 0 ? "" : ", ");
      write_value(out, (*array)[n]);
    }
    out << ']';
  } else if (const toml::table* table = node.as_table()) {
    out << '{';
    const char* between = " ";
    for (const auto& [key, value] : *table) {
      out << std::exchange(between, ", ");
      write_key(out, key.str());
      out << " = ";
      write_value(out, value);
    }
    out << (table->empty() ? "}" : " }");
  } else {
    out << toml::toml_formatter(node, kPlain);
  }
}

// The fields of a table, then its lists of tables. place: "own_tool."
void write_fields(std::ostream& out, const std::string& place, const toml::table& table) {
  for (const auto& [key, value] : table) {
    if (is_list_of_tables(value)) continue;
    write_key(out, key.str());
    out << " = ";
    write_value(out, value);
    out << '\n';
  }
  for (const auto& [key, value] : table) {
    if (!is_list_of_tables(value)) continue;
    const std::string name = place + std::string(key.str());
    for (const toml::node& one : *value.as_array()) {
      out << "\n[[" << name << "]]\n";
      write_fields(out, name + ".", *one.as_table());
    }
  }
}

std::string text_of(const toml::table& all) {
  std::vector<std::string_view> keys(std::begin(kOrder), std::end(kOrder));
  for (const auto& [key, node] : all)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) keys.push_back(key.str());
  std::ostringstream out;
  const auto is_title = [](std::string_view key) { return key == "title" || key == "description"; };
  for (const std::string_view key : keys) {
    const toml::node* node = all.get(key);
    if (node == nullptr || is_list_of_tables(*node) || (node->is_table() && !is_title(key)))
      continue;
    out << key << " = ";
    write_value(out, *node);
    out << '\n';
  }
  for (const std::string_view key : keys) {
    const toml::node* node = all.get(key);
    if (node == nullptr || is_title(key)) continue;
    if (const toml::table* table = node->as_table()) {
      out << "\n[" << key << "]\n";
      write_fields(out, std::string(key) + ".", *table);
    } else if (is_list_of_tables(*node)) {
      for (const toml::node& one : *node->as_array()) {
        out << "\n[[" << key << "]]\n";
        write_fields(out, std::string(key) + ".", *one.as_table());
      }
    }
  }
  return std::move(out).str();
}

}  // namespace

Result<std::string> write_case(const CaseFile& file) {
  toml::table all;
  if (!file.from.empty()) {
    auto read = parse_toml(file.from, file.name + ".toml");
    if (!read) return read.error();
    all = std::move(*read);
  }
  if (!file.title.empty()) put(all, "title", file.title);
  put(all, "phantom", file.phantom);
  put(all, "volume", file.volume);
  put(all, "rubric", file.rubric);
  put(all, "tool", file.tool);
  all.erase("voxel_mm");
  if (file.voxel_mm > 0) put(all, "voxel_mm", file.voxel_mm);
  toml::table burr;
  put(burr, "diameter_mm", file.burr_mm);
  put(burr, "kind", std::string(file.diamond ? "diamond" : "cutting"));
  put(burr, "rpm", file.rpm);
  all.insert_or_assign("burr", std::move(burr));
  all.insert_or_assign("session", session_table(file.session));
  if (!file.motion.empty()) {
    toml::table demo;
    put(demo, "motion", file.motion);
    put(demo, "seconds", file.seconds);
    all.insert_or_assign("demo", std::move(demo));
  }
  if (const Status put_there = put_own_tool(file, all); !put_there) return put_there.error();
  std::string text = text_of(all);
  if (const auto readable = parse_case(text, file.name + ".toml"); !readable)
    return readable.error();
  return text;
}

}  // namespace burr::scenario
