// Segments of a .seg.nrrd, after 3D Slicer's vtkMRMLSegmentationStorageNode.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string_view>

#include "burr/base/printable.h"
#include "burr/io/read/label_lists.h"
#include "burr/io/read/nrrd_header.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

// What a segment is, by its code, from the tag that 3D Slicer writes:
// "...|TerminologyEntry:LIST~SCT^123037004^Anatomical Structure~SCT^91609006^Mandible~...|...": the
// third part is the type. "Mandible SCT 91609006", or empty where it says no more than "tissue".
std::string coded_meaning(const std::string& tags) {
  constexpr std::string_view kEntry = "TerminologyEntry:";
  const std::size_t at = tags.find(kEntry);
  if (at == std::string::npos) return {};
  std::string_view entry = std::string_view(tags).substr(at + kEntry.size());
  entry = entry.substr(0, entry.find('|'));
  for (int skip = 0; skip < 2; ++skip) {
    const std::size_t next = entry.find('~');
    if (next == std::string_view::npos) return {};
    entry.remove_prefix(next + 1);
  }
  entry = entry.substr(0, entry.find('~'));
  const std::size_t first = entry.find('^'), second = entry.find('^', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return {};
  const std::string_view scheme = entry.substr(0, first),
                         code = entry.substr(first + 1, second - first - 1),
                         meaning = entry.substr(second + 1);
  return meaning_of_code(scheme, code, meaning);
}

// The numbers n of the keys Segment<n>_...: they need not begin at 0, nor follow each other.
std::set<int> segment_numbers(const NrrdHeader& header) {
  constexpr std::string_view kSegment = "Segment";
  constexpr std::size_t kMostSegments = 4096;
  std::set<int> numbers;
  for (const auto& [key, value] : header.keys) {
    const std::size_t end = key.find('_');
    std::int64_t number = 0;
    if (key.rfind(kSegment, 0) == 0 && end != std::string::npos && end > kSegment.size() &&
        to_number(key.substr(kSegment.size(), end - kSegment.size()), number) && number >= 0 &&
        number < 1'000'000 && numbers.size() < kMostSegments)
      numbers.insert(static_cast<int>(number));
  }
  return numbers;
}

// "0.5 0.5 0.5", or 0 to 255. True: it was 0 to 255.
bool take_colour(const std::vector<double>& numbers, Label& label) {
  if (numbers.size() < 3) return false;
  const double most = std::max({numbers[0], numbers[1], numbers[2]});
  const bool bytes = most >= 2 && most <= 255;
  for (std::size_t c = 0; c < 3; ++c)
    if (std::isfinite(numbers[c]))
      label.colour[c] =
          static_cast<float>(std::clamp(numbers[c] / (bytes ? 255.0 : 1.0), 0.0, 1.0));
  return bytes;
}

}  // namespace

NrrdSegments nrrd_segments(const NrrdHeader& header, std::vector<std::string>& notices) {
  NrrdSegments out;
  int byte_colours = 0;
  for (const int n : segment_numbers(header)) {
    const std::string prefix = fmt::format("Segment{}_", n);
    const auto get = [&](const char* what) {
      const auto found = header.keys.find(prefix + what);
      return found == header.keys.end() ? std::string() : found->second;
    };
    const std::string value = get("LabelValue"), name = get("Name"), id = get("ID");
    if (value.empty() && name.empty() && id.empty()) continue;
    Label label;
    std::int64_t number = n + 1, layer = 0;
    if (!value.empty() && !to_number(value, number)) continue;
    if (number < 1 || number > std::numeric_limits<int>::max()) continue;
    if (!to_number(get("Layer"), layer) || layer < 0 || layer > 4096) layer = 0;
    label.value = static_cast<int>(number);
    label.name = !name.empty() ? name : id;
    label.meaning = coded_meaning(get("Tags"));
    byte_colours += take_colour(numbers(get("Color")), label) ? 1 : 0;
    bool twice = false;
    for (std::size_t other = 0; other < out.labels.size() && !twice; ++other) {
      twice = out.labels[other].value == label.value && out.layers[other] == layer;
      if (twice)
        notices.push_back(fmt::format(
            "Two segments, {} and {}, have the same value {}: the first name is taken.",
            base::printable(out.labels[other].name), base::printable(label.name), label.value));
    }
    if (twice) continue;
    out.labels.push_back(label);
    out.layers.push_back(static_cast<int>(layer));
    out.bare.push_back(value.empty() && get("Layer").empty());
  }
  if (byte_colours > 0)
    notices.push_back(
        fmt::format("The colours of {} go beyond 1: they are read as 0 to 255.",
                    byte_colours == 1 ? "one segment" : fmt::format("{} segments", byte_colours)));
  return out;
}

}  // namespace burr::io
