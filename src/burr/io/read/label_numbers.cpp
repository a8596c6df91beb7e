#include "burr/io/read/label_numbers.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "burr/base/printable.h"

namespace burr::io {
namespace {

using label_numbers::kMostLabels;
using label_numbers::kWhole;

constexpr double kNearlyWhole = 0.05;  // as kWhole, but worth a word

}  // namespace

bool looks_like_labels(const Voxels<std::uint8_t>& bytes, std::ptrdiff_t most_different) {
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t b : bytes) ++count[b];
  const auto different =
      std::count_if(count.begin(), count.end(), [](std::size_t n) { return n > 0; });
  if (different <= 2) return different == 2;
  if (different > most_different) return false;
  std::size_t pairs = 0, same = 0;
  for (std::size_t v = 1; v < bytes.size(); ++v) {
    if (bytes[v] == 0 && bytes[v - 1] == 0) continue;
    ++pairs;
    same += bytes[v] == bytes[v - 1] ? 1 : 0;
  }
  return pairs > 200 && 10 * same > 7 * pairs;
}

WholeNumbers whole_numbers(const Voxels<float>& values) {
  WholeNumbers out;
  float before = std::numeric_limits<float>::quiet_NaN();
  for (const float value : values) {
    if (value == before) continue;
    before = value;
    const double whole = std::round(double{value});
    if (!(std::abs(whole) < 1e15)) {
      out.off = std::numeric_limits<double>::infinity();
      return out;
    }
    out.off = std::max(out.off,
                       std::abs(double{value} - whole) / std::max(kWhole, 1e-6 * std::abs(whole)));
    if (out.off > kNearlyWhole / kWhole) return out;
    const auto number = static_cast<std::int64_t>(whole);
    out.negative = out.negative || number < 0;
    const auto place = std::lower_bound(out.all.begin(), out.all.end(), number);
    if (place != out.all.end() && *place == number) continue;
    out.all.insert(place, number);
    if (out.all.size() > kMostLabels + 1) return out;
  }
  out.complete = true;
  return out;
}

bool flat_whole_numbers(const Voxels<float>& values) {
  float most = 0;
  for (const float value : values) {
    if (!(value >= 0) || value != std::floor(value)) return false;
    most = std::max(most, value);
  }
  std::size_t pairs = 0, same = 0;
  for (std::size_t v = 1; v < values.size(); ++v) {
    if (values[v] == values[v - 1] && (values[v] == 0 || values[v] == most)) continue;
    ++pairs;
    same += values[v] == values[v - 1] ? 1 : 0;
  }
  return pairs > 200 && same > pairs / 5 * 4;
}

std::vector<std::uint8_t> short_numbers(const std::vector<std::int64_t>& file) {
  std::array<bool, 256> taken{};
  for (const std::int64_t value : file)
    if (value <= 255) taken[static_cast<std::size_t>(value)] = true;
  taken[0] = true;
  std::vector<std::uint8_t> out;
  std::size_t free = 0;
  for (const std::int64_t value : file) {
    if (value <= 255) {
      out.push_back(static_cast<std::uint8_t>(value));
      continue;
    }
    while (taken[free]) ++free;
    taken[free] = true;
    out.push_back(static_cast<std::uint8_t>(free));
  }
  return out;
}

void drop_long_numbers(Scan& scan) {
  std::erase_if(scan.label_names, [](const Label& label) { return label.value > 255; });
}

void renumber_names(Scan& scan, const std::vector<std::int64_t>& file,
                    const std::vector<std::uint8_t>& numbers) {
  std::vector<Label> names;
  std::string list;
  std::size_t changed = 0;
  for (std::size_t n = 0; n < file.size(); ++n) {
    if (file[n] == 0) continue;
    bool named = false;
    std::string name;
    for (const Label& label : scan.label_names) {
      if (label.value != file[n]) continue;
      if (!named) name = label.name;
      named = true;
      names.push_back(label);
      names.back().value = numbers[n];
      names.back().in_file = file[n] > 255 ? file[n] : 0;
    }
    if (file[n] <= 255) continue;
    if (!named) {
      names.push_back({.value = numbers[n], .name = "", .colour = volume::Tissue{}.colour});
      names.back().in_file = file[n];
    }
    constexpr std::size_t kShown = 4;
    if (++changed <= kShown)
      list += fmt::format("{}{} is now {}{}", changed == 1 ? "" : ", ", file[n], numbers[n],
                          name.empty() ? "" : " (" + base::printable(name) + ")");
    else if (changed == kShown + 1)
      list += " ...";
  }
  if (changed > 0) {
    scan.label_names = std::move(names);
    scan.notices.push_back(
        fmt::format("burr numbers labels up to 255, so {} of the file has a new number: {}.",
                    changed == 1 ? "one label" : fmt::format("each of {} labels", changed), list));
  }
}

}  // namespace burr::io
