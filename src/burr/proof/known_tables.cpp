#include "burr/proof/known_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "burr/base/printable.h"
#include "burr/proof/built_in_tables.h"

namespace burr::proof {
namespace {

std::string without_ends(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") + 1 - first));
}

// The first word, and what follows it.
std::pair<std::string, std::string> first_word(const std::string& text) {
  const auto end = std::min(text.find_first_of(" \t"), text.size());
  return {text.substr(0, end), without_ends(std::string_view(text).substr(end))};
}

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream all(text);
  for (std::string part; std::getline(all, part, between);) parts.push_back(without_ends(part));
  return parts;
}

std::optional<double> number_of(const std::string& text) {
  std::istringstream from(text);
  double x = 0;
  if (!(from >> x) || !from.eof() || !std::isfinite(x)) return std::nullopt;
  return x;
}

std::optional<Tolerance> tolerance_of(const std::string& word) {
  static const std::map<std::string, Tolerance> kWords = {
      {"width", kWidth},   {"entry", kEntry},   {"depth", kDepth},
      {"angle", kAngle},   {"plane", kPlane},   {"plane-angle", kPlaneAngle},
      {"cavity", kCavity}, {"floor", kFloor},   {"outline", kOutline},
      {"share", kShare},   {"border", kBorder}, {"trace", kTrace},
      {"gap", kGap},       {"hole", kHole},     {"way", kWay},
      {"volume", kVolume}, {"breach", kBreach}};
  const auto found = kWords.find(word);
  if (found == kWords.end()) return std::nullopt;
  return found->second;
}

// "gap(REGION | tube NAME r | far)" and the like: the words before "(", and the parts between "|".
std::optional<RightValue> gap_of(const std::vector<std::string>& parts) {
  if (parts.size() != 3) return std::nullopt;
  const auto far = number_of(parts[2]);
  std::istringstream words(parts[1]);
  std::string kind, name;
  double a = 0, b = 0, c = 0;
  words >> kind;
  if (kind == "tube" && words >> name >> a && far) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return least_gap(parts[0], from_tube(name, a), *far);
  }
  if (kind == "oval" && words >> a >> b >> c && far)
    return least_gap(parts[0], from_oval(a, b, c), *far);
  return std::nullopt;
}

std::optional<RightValue> value_of(const std::string& text) {
  if (const auto number = number_of(text))
    return RightValue([x = *number](const KnownScene&) { return x; });
  const auto open = text.find('(');
  if (open == std::string::npos || text.back() != ')') return std::nullopt;
  const std::string kind = without_ends(text.substr(0, open));
  const std::string inside = text.substr(open + 1, text.size() - open - 2);
  const std::vector<std::string> parts = parts_of(inside, '|');
  if (kind == "gap") return gap_of(parts);
  if (kind == "above" && parts.size() == 3) {
    const auto floor = number_of(parts[1]), less = number_of(parts[2]);
    if (floor && less) return median_above(parts[0], *floor, *less);
  }
  if (parts.size() != 1) return std::nullopt;
  if (kind == "gone") return share_gone(inside);
  if (kind == "filled") return share_filled(inside);
  if (kind == "beside") return share_beside(inside);
  if (kind == "volume") return volume_gone(inside);
  return std::nullopt;
}

class TableReader {
 public:
  explicit TableReader(std::string file) : file_(std::move(file)) {}

  // One line of the text; empty: it was understood.
  std::string line(const std::string& text) {
    const auto [word, rest] = first_word(text);
    if (word == "case") return table_.case_name = rest, "";
    if (word == "coarser") return coarser(rest);
    if (word == "few") return few(rest);
    if (word == "let") return let(rest);
    if (word == "left" && rest.starts_with("out:")) {
      const auto [item, why] = first_word(without_ends(rest.substr(4)));
      if (why.empty()) return "leaves an item out without a reason; add it";
      table_.left_out.push_back({item, why});
      return "";
    }
    if (word == "bone") {
      table_.bones.push_back({rest, "", {}});
      return rest.empty() ? "names no bone; add a name" : "";
    }
    if (table_.bones.empty()) return "stands before the first bone; begin one with \"bone NAME\"";
    std::string all;
    if (std::string wrong = filled_in(rest, all); !wrong.empty()) return wrong;
    if (word == "cut") return table_.bones.back().shapes = all, "";
    return right(word, all);
  }
  [[nodiscard]] KnownTable& table() { return table_; }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string coarser(const std::string& text) {
    const auto number = number_of(text);
    if (!number || *number <= 0) return "gives no voxel size above 0; give one in mm";
    table_.coarser_mm = *number;
    return "";
  }
  std::string few(const std::string& text) {
    const auto number = number_of(text);
    if (!number || *number < 1) return "gives no number of bones; give 1 or more";
    table_.few = static_cast<std::size_t>(*number);
    return "";
  }
  std::string let(const std::string& text) {
    const auto [name, rest] = first_word(text);
    return filled_in(rest, names_[name]);
  }
  // Puts what a name stands for in place of {NAME}.
  std::string filled_in(const std::string& text, std::string& out) const {
    out.clear();
    for (std::size_t n = 0; n < text.size(); ++n) {
      if (text[n] != '{') {
        out += text[n];
        continue;
      }
      const auto end = text.find('}', n);
      const auto found = names_.find(text.substr(n + 1, std::min(end, text.size()) - n - 1));
      if (end == std::string::npos || found == names_.end())
        return "has a {NAME} that no line before it lets stand for something; add \"let NAME ...\"";
      out += found->second;
      n = end;
    }
    return "";
  }
  std::string right(const std::string& items, const std::string& says) {
    const bool met = says == "met", unmet = says == "unmet";
    const auto space = says.find_last_of(" \t");
    std::optional<RightValue> value;
    std::optional<Tolerance> tolerance;
    if (!met && !unmet) {
      if (space == std::string::npos)
        return "gives an item no answer; write met, unmet, or a value and a tolerance";
      value = value_of(without_ends(says.substr(0, space)));
      tolerance = tolerance_of(says.substr(space + 1));
      if (!value)
        return "gives a value that is neither a number nor gone, filled, beside, volume, gap or "
               "above";
      if (!tolerance) return "names no tolerance that right.h has; name one, such as width";
    }
    for (const std::string& item : parts_of(items, ','))
      if (value)
        table_.bones.back().right.emplace_back(item, *value, *tolerance);
      else
        table_.bones.back().right.emplace_back(item, met ? kMet : kUnmet);
    return "";
  }

  std::string file_;
  std::map<std::string, std::string, std::less<>> names_;
  KnownTable table_;
};

}  // namespace

Result<KnownTable> read_table(std::string_view text, const std::string& file) {
  TableReader reader(file);
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string raw; std::getline(lines, raw);) {
    ++number;
    const std::string line = without_ends(raw.substr(0, raw.find('#')));
    if (line.empty()) continue;
    if (const std::string wrong = reader.line(line); !wrong.empty())
      return error(fmt::format("{}, line {}: \"{}\" {}", base::printable(file), number,
                               base::printable(line), wrong));
  }
  if (reader.table().case_name.empty())
    return error(
        fmt::format("{}: it names no case; add a line \"case NAME\"", base::printable(file)));
  return std::move(reader.table());
}

std::vector<std::string> known_cases() {
  std::vector<std::string> names;
  for (const BuiltInTable& one : built_in_tables()) names.emplace_back(one.case_name);
  return names;
}

Result<KnownTable> known_table(const std::string& case_name) {
  for (const BuiltInTable& one : built_in_tables())
    if (one.case_name == case_name) return read_table(one.text, case_name + ".txt");
  return error(Trouble::usage,
               fmt::format("the case \"{}\" has no table of known bones; take a built-in case",
                           base::printable(case_name)));
}

}  // namespace burr::proof
