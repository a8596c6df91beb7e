#include "burr/fit/force_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/trimmed.h"

namespace burr::fit {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{512} << 20;  // one hour at 10 kHz [byte]
constexpr std::size_t kMostMaterials = 100;

enum Column { kTime, kNormal, kTangential, kRpm, kRadius, kRemoval, kPower, kEdge, kMaterial };
struct Known {
  const char* name;
  bool needed;
};
constexpr std::array<Known, 9> kKnown = {{{"time_s", true},
                                          {"normal_n", true},
                                          {"tangential_n", true},
                                          {"rpm", true},
                                          {"radius_mm", true},
                                          {"removal_mm3_s", true},
                                          {"power_w", false},
                                          {"edge_mm", false},
                                          {"material", false}}};

// Removes the next piece, up to `end`, from the text; false at the end of the text.
bool next(std::string_view& text, char end, std::string_view& piece) {
  if (text.data() == nullptr) return false;
  const std::size_t at = text.find(end);
  piece = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
  return true;
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  std::string_view piece;
  while (next(line, ',', piece)) cells.push_back(base::trimmed(piece));
}

std::string list_of_columns() {
  std::string list;
  for (const Known& known : kKnown) list += (list.empty() ? "" : ", ") + std::string(known.name);
  return list;
}

// The column of each known quantity; -1: not present.
using Places = std::array<int, kKnown.size()>;

Result<Places> places_of(const std::vector<std::string_view>& names, const std::string& where,
                         std::vector<std::string>& notices) {
  Places places;
  places.fill(-1);
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto known = std::find_if(kKnown.begin(), kKnown.end(),
                                    [&](const Known& one) { return names[n] == one.name; });
    if (known == kKnown.end()) {
      notices.push_back(
          fmt::format("{}: column \"{}\" is not used", where, base::printable(names[n])));
      continue;
    }
    int& place = places[static_cast<std::size_t>(known - kKnown.begin())];
    if (place >= 0)
      return error(fmt::format("{}: column {} appears twice; keep one", where, known->name));
    place = static_cast<int>(n);
  }
  for (std::size_t c = 0; c < kKnown.size(); ++c)
    if (kKnown[c].needed && places[c] < 0)
      return error(fmt::format(
          "{}: column {} is missing; the first line must name the columns, separated by commas: {}",
          where, kKnown[c].name, list_of_columns()));
  return places;
}

}  // namespace

std::size_t ForceLog::material(std::string_view name) {
  const auto found = std::find(materials.begin(), materials.end(), name);
  const auto place = static_cast<std::size_t>(found - materials.begin());
  if (found == materials.end()) materials.emplace_back(name);
  return place;
}

void ForceLog::append(const ForceLog& other) {
  for (ForceRow row : other.rows) {
    row.material = material(other.materials[row.material]);
    rows.push_back(row);
  }
  notices.insert(notices.end(), other.notices.begin(), other.notices.end());
}

Result<ForceLog> read_force_log(const std::string& path) {
  const auto text =
      base::text_of_file(path, kLargestFile, "a force log; split it into several files");
  if (!text) return text.error();
  return parse_force_log(*text, std::filesystem::path(path).filename().string());
}

Result<ForceLog> parse_force_log(std::string_view text, std::string_view file) {
  ForceLog log;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // byte order mark
  Places places;
  places.fill(-1);
  std::size_t columns = 0, number = 0;
  std::string_view line;
  std::vector<std::string_view> cells;
  while (next(text, '\n', line)) {
    ++number;
    line = base::trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    split(line, cells);
    if (columns == 0) {
      auto found = places_of(cells, fmt::format("{}: line {}", file, number), log.notices);
      if (!found) return found.error();
      places = *found;
      columns = cells.size();
      continue;
    }
    if (cells.size() != columns)
      return error(
          fmt::format("{}: line {}: {} values, but the first line names {} columns; correct the "
                      "line or remove it",
                      file, number, cells.size(), columns));
    std::array<double, kKnown.size()> value{};
    for (std::size_t c = 0; c < kMaterial; ++c) {
      if (places[c] < 0) continue;
      const std::string_view cell = cells[static_cast<std::size_t>(places[c])];
      const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value[c]);
      if (cell.empty() || result.ec != std::errc() || result.ptr != cell.data() + cell.size() ||
          !std::isfinite(value[c]) || std::abs(value[c]) > 1e9)
        return error(fmt::format(
            "{}: line {}: column {}: \"{}\" is not a number; write it as 1.25, or remove the line",
            file, number, kKnown[c].name, base::printable(cell)));
    }
    if (!(value[kRadius] > 0))
      return error(fmt::format(
          "{}: line {}: column radius_mm: {:g} is not a radius; give the effective radius, above 0",
          file, number, value[kRadius]));
    if (value[kEdge] < 0)
      return error(fmt::format("{}: line {}: column edge_mm: {:g} is not a length; give 0 or more",
                               file, number, value[kEdge]));
    ForceRow row;
    row.time = value[kTime];
    row.normal = value[kNormal];
    row.tangential = value[kTangential];
    row.speed = value[kRpm] / 60 * 2 * std::numbers::pi;
    row.radius = 1e-3 * value[kRadius];
    row.removal = 1e-9 * value[kRemoval];
    if (places[kPower] >= 0) row.power = value[kPower];
    if (places[kEdge] >= 0) row.edge = 1e-3 * value[kEdge];
    const std::string_view name =
        places[kMaterial] < 0 ? "" : cells[static_cast<std::size_t>(places[kMaterial])];
    if (name.size() > 100)
      return error(fmt::format(
          "{}: line {}: column material: the name is longer than 100 letters; shorten it", file,
          number));
    row.material = log.material(name);
    if (log.materials.size() > kMostMaterials)
      return error(
          fmt::format("{}: line {}: column material: more than {} materials; is this the "
                      "right column?",
                      file, number, kMostMaterials));
    log.rows.push_back(row);
  }
  if (columns == 0)
    return error(fmt::format("{}: is empty; the first line must name the columns: {}", file,
                             list_of_columns()));
  if (log.rows.empty())
    return error(
        fmt::format("{}: has no rows below its first line; give one row for each moment", file));
  return log;
}

}  // namespace burr::fit
