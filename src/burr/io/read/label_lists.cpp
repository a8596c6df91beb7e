#include "burr/io/read/label_lists.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr std::size_t kMostLabels = 4096;

void add(std::vector<Label>& labels, std::int64_t value, std::string_view name,
         const std::array<float, 3>* colour = nullptr) {
  if (value < 1 || value > std::numeric_limits<int>::max() || labels.size() >= kMostLabels) return;
  for (const Label& label : labels)
    if (label.value == value) return;
  Label label;
  label.value = static_cast<int>(value);
  constexpr std::size_t kLongestName = 200;
  label.name = std::string(trimmed(name).substr(0, kLongestName));
  if (colour != nullptr) label.colour = *colour;
  labels.push_back(std::move(label));
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t end = at + name.size();
    const bool whole = at > 0 && (tag[at - 1] == ' ' || tag[at - 1] == '\n' || tag[at - 1] == '\t');
    if (!whole || end + 1 >= tag.size() || tag[end] != '=') continue;
    const char quote = tag[end + 1];
    if (quote != '"' && quote != '\'') continue;
    const std::size_t from = end + 2, to = tag.find(quote, from);
    if (to == std::string_view::npos) return {};
    return tag.substr(from, to - from);
  }
  return {};
}

std::string without_entities(std::string_view text) {
  struct Entity {
    std::string_view name;
    char is;
  };
  static constexpr std::array<Entity, 5> kEntities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    bool found = false;
    for (const Entity& entity : kEntities) {
      if (text.substr(i, entity.name.size()) != entity.name) continue;
      out += entity.is;
      i += entity.name.size();
      found = true;
      break;
    }
    if (!found) out += text[i++];
  }
  return out;
}

bool colour_part(double number, float& out) {
  if (!(number >= 0 && number <= 255)) return false;
  out = static_cast<float>(number / 255.0);
  return true;
}

void walk(const nlohmann::json& node, int depth, std::vector<Label>& labels) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest || (!node.is_object() && !node.is_array())) return;
  if (node.is_object()) {
    bool all_numbers = !node.empty();
    for (const auto& [key, value] : node.items()) {
      std::int64_t number = 0;
      all_numbers = all_numbers && value.is_number_integer() && !to_number(key, number);
      if (!to_number(key, number)) continue;
      if (value.is_string())
        add(labels, number, value.get_ref<const std::string&>());
      else if (value.is_object() && value.contains("name") && value["name"].is_string())
        add(labels, number, value["name"].get_ref<const std::string&>());
    }
    if (all_numbers)
      for (const auto& [key, value] : node.items()) add(labels, value.get<std::int64_t>(), key);
    if (node.contains("name") && node["name"].is_string())
      for (const char* key : {"label", "value", "id", "idx", "key", "labelValue", "index"})
        if (node.contains(key) && node[key].is_number_integer()) {
          add(labels, node[key].get<std::int64_t>(), node["name"].get_ref<const std::string&>());
          break;
        }
  }
  for (const auto& child : node) walk(child, depth + 1, labels);
}

// One label; false: the line is none. In the lists of FreeSurfer and 3D Slicer the name may hold
// blanks; the colour and the alpha are the last numbers.
bool add_line(std::string_view line, std::vector<Label>& labels) {
  std::vector<std::string> parts = words(line);
  std::int64_t value = 0;
  double number = 0;
  if (parts.size() < 5 || !to_number(parts[0], value)) return false;
  const bool colour_first = to_number(parts[1], number);  // ITK-SNAP
  const std::size_t from = colour_first ? 1 : parts.size() - (parts.size() == 5 ? 3 : 4);
  std::array<float, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c)
    if (!to_number(parts[from + c], number) || !colour_part(number, colour[c])) return false;
  const std::size_t open = line.find('"'), close = line.rfind('"');
  std::string name;
  if (open != std::string_view::npos && close > open)
    name = line.substr(open + 1, close - open - 1);
  else if (colour_first)
    return false;
  else
    for (std::size_t word = 1; word < from; ++word) name += (word == 1 ? "" : " ") + parts[word];
  add(labels, value, name, &colour);
  return true;
}

}  // namespace

std::vector<Label> labels_in_xml(std::string_view text) {
  std::vector<Label> labels;
  constexpr std::string_view kBegin = "<Label", kEnd = "</Label>", kData = "<![CDATA[";
  for (std::size_t at = text.find(kBegin); at != std::string_view::npos;
       at = text.find(kBegin, at + 1)) {
    const std::size_t close = text.find('>', at), end = text.find(kEnd, at);
    if (close == std::string_view::npos || end == std::string_view::npos || close > end) continue;
    const std::string_view tag = text.substr(at + kBegin.size(), close - at - kBegin.size());
    std::int64_t value = 0;
    if (!to_number(attribute(tag, "Key"), value)) continue;
    std::string_view name = trimmed(text.substr(close + 1, end - close - 1));
    const bool data = name.substr(0, kData.size()) == kData;
    if (data) {
      name.remove_prefix(kData.size());
      name = name.substr(0, name.find("]]>"));
    }
    std::array<float, 3> colour{};
    bool coloured = true;
    const std::array<const char*, 3> names = {"Red", "Green", "Blue"};
    for (std::size_t c = 0; c < 3; ++c) {
      double part = 0;
      coloured = coloured && to_number(attribute(tag, names[c]), part) && part >= 0 && part <= 1;
      if (coloured) colour[c] = static_cast<float>(part);
    }
    add(labels, value, data ? std::string(name) : without_entities(name),
        coloured ? &colour : nullptr);
  }
  return labels;
}

std::vector<Label> labels_in_json(std::string_view text) {
  std::vector<Label> labels;
  text = trimmed(text);
  if (text.empty() || (text.front() != '{' && text.front() != '[')) return labels;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_discarded()) walk(json, 0, labels);
  return labels;
}

std::vector<Label> labels_in_lut(std::string_view text) {
  std::vector<Label> labels;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);  // byte-order mark
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.empty() || line.front() == '#') continue;
    if (!add_line(line, labels)) return {};
  }
  return labels;
}

std::string meaning_of_code(std::string_view scheme, std::string_view code,
                            std::string_view meaning) {
  // the default of every new segment, and the two words for "a part of the body"
  for (const char* nothing : {"85756007", "T-D0050", "123037004", "T-D000A"})
    if (code == nothing) return {};
  constexpr std::size_t kLongest = 200;
  std::string out(meaning);
  if (!code.empty()) out += fmt::format("{}{} {}", out.empty() ? "" : " ", scheme, code);
  if (out.size() <= kLongest) return out;
  std::size_t end = kLongest;  // not within a letter of UTF-8
  while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0U) == 0x80) --end;
  return out.substr(0, end);
}

}  // namespace burr::io
