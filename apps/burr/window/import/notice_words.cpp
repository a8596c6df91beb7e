#include "window/import/notice_words.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/front_words.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

// A sentence of src/burr/importing or src/burr/io: {} is any text, {v} a volume in mm3.
struct Known {
  std::string_view sentence;
  Word says;
};

constexpr Known kKnown[] = {
    {"One of {} separate parts was removed {o}: {v} mm3, at {o} mm.", Word::notice_part},
    {"{} of {} separate parts were removed {o}: {v} mm3 in all, the largest of {v} mm3 at {o} mm.",
     Word::notice_parts},
    {"There is no bone at {} mm: the part {} mm away is kept (`keep`).", Word::notice_part_near},
    {"Noise of {} {} is smoothed out along the surface; see `smooth`.", Word::notice_smooth},
    {"The values range from {} to {}, as in a CT: Hounsfield units are assumed.",
     Word::notice_hounsfield},
    {"The values are not HU: the surface level {} is an estimate {o}; give another level with "
     "`iso`.",
     Word::notice_level},
    {"The values are not HU: Otsu's threshold {} between dark and bright is used {o}; see `iso`.",
     Word::notice_otsu},
    {"No voxel reaches {} HU: Otsu's threshold {} is used {o}; see `iso`.", Word::notice_no_bone},
    {"{} voxels were padding and {o}.", Word::notice_padded},
    {"{} voxels were below -1024 HU {o}.", Word::notice_below},
    {"The voxels around the body hold 0, amid the other values: they were not measured and count "
     "nowhere.",
     Word::notice_around},
    {"{} voxels hold {}, far from all others: they were not measured and {o}.", Word::notice_fill},
    {"{} voxels hold no finite number, {o}.", Word::notice_no_number},
    {"The voxels are cubic to within {}: cubes of {} mm are used.", Word::notice_cubes},
    {"Voxels of {} mm would need {} MB, more than the memory budget of {} MB: voxels of {} mm are "
     "used instead; {o}.",
     Word::notice_memory},
    {"The file does not state its orientation: {}, {}, {} is assumed.", Word::notice_orientation},
    {"The file states no usable orientation: axial slices are assumed.", Word::notice_axial},
    {"The file states no voxel spacing: 1 mm is assumed; see `spacing_mm`.", Word::notice_spacing},
    {"The file states no usable voxel spacing: 1 mm is assumed; see `spacing_mm`.",
     Word::notice_spacing},
    {"The file states no Pixel Spacing: 1 mm is assumed; see `spacing_mm`.", Word::notice_spacing},
    {"The spacing is {} x {} x {} mm as given by `spacing_mm`, instead of {} x {} x {} mm in the "
     "file.",
     Word::notice_own_spacing},
    {"The file does not state its byte order: little endian is assumed.", Word::notice_bytes},
    {"The stack of slices leans by {} degrees; {o}.", Word::notice_leans},
    {"The slices are shifted against each other (gantry tilt of {} degrees); {o}.",
     Word::notice_tilt},
    {"The slices are unevenly spaced: {} of {} gaps are not {} mm, {o}.", Word::notice_uneven},
    {"{} of {} labels have no name and are treated as solid; {o}.", Word::notice_unnamed},
    {"burr does not understand the {} {} and treats {o} as solid bone; {o}.",
     Word::notice_unknown_labels},
    {"Label {} ({}) is air.", Word::notice_air_label},
    {"The header says Hounsfield units, but {o}: they are read as grey values.",
     Word::notice_not_hounsfield},
    {"{} other files in the folder are damaged or cannot be read.", Word::notice_damaged},
    {"The picture is inverted (MONOCHROME1): dark is dense here.", Word::notice_inverted},
    {"Beside the scan {} ({}); left out, choose with `series`.", Word::notice_beside},
    {"A burr of {} mm is too small for voxels of {} mm: burr takes one of {} mm. A smaller burr "
     "needs {o}.",
     Word::notice_burr},
};

// What a sentence says in the places of {} and {v}; none: it is another sentence. {o}: left out.
std::optional<std::vector<std::string>> taken_from(std::string_view sentence,
                                                   std::string_view pattern) {
  std::vector<std::string> all;
  while (true) {
    const std::size_t open = std::min(pattern.find('{'), pattern.size());
    if (!sentence.starts_with(pattern.substr(0, open))) return std::nullopt;
    sentence.remove_prefix(open);
    pattern.remove_prefix(open);
    if (pattern.empty()) return sentence.empty() ? std::optional(std::move(all)) : std::nullopt;
    const std::size_t close = pattern.find('}');
    const char kind = close == 2 ? pattern[1] : ' ';
    pattern.remove_prefix(close + 1);
    const std::string_view next = pattern.substr(0, std::min(pattern.find('{'), pattern.size()));
    // the last text runs to the end of the sentence, whatever is in it
    const bool last = next.size() == pattern.size();
    const std::size_t end =
        last && sentence.ends_with(next) ? sentence.size() - next.size() : sentence.find(next);
    if (end == std::string_view::npos || end == 0) return std::nullopt;
    std::string text(sentence.substr(0, end));
    sentence.remove_prefix(end);
    if (kind == 'o') continue;
    double mm3 = 0;
    if (kind == 'v') {
      const auto read = std::from_chars(text.data(), text.data() + text.size(), mm3);
      if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
      text = volume_words(mm3);
    }
    all.push_back(std::move(text));
  }
}

// "left" and so on, as the library writes how the patient lies.
std::string direction(const std::string& text) {
  constexpr std::pair<std::string_view, Word> kWays[] = {
      {"left", Word::way_left},           {"right", Word::way_right},
      {"posterior", Word::way_backwards}, {"anterior", Word::way_forwards},
      {"superior", Word::way_up},         {"inferior", Word::way_down}};
  const auto* found = std::find_if(std::begin(kWays), std::end(kWays),
                                   [&](const auto& one) { return one.first == text; });
  return found == std::end(kWays) ? text : word(found->second);
}

// Leaves out what is in brackets, or behind a semicolon, and names what the library can be given.
std::string without_names(std::string text) {
  for (std::size_t at; (at = text.find('`')) != std::string::npos;) {
    const std::size_t bracket = text.rfind(" (", at), closes = text.find(')', at);
    if (bracket != std::string::npos && text.find(')', bracket) == closes &&
        closes != std::string::npos) {
      text.erase(bracket, closes + 1 - bracket);
      continue;
    }
    const std::size_t behind = text.rfind(';', at), sentence = text.rfind(". ", at);
    const std::size_t clause = behind == std::string::npos     ? sentence
                               : sentence == std::string::npos ? behind
                                                               : std::max(behind, sentence);
    const std::size_t end = std::min(text.find(". ", at), text.size());
    if (clause == std::string::npos) return in_options(text);
    // a whole sentence goes with its dot
    text.replace(clause, end - clause, end < text.size() || text[clause] != '.' ? "" : ".");
    if (text.empty() || text.back() != '.') text += '.';
  }
  return text;
}

}  // namespace

std::string volume_words(double mm3) {
  if (mm3 >= 1000) return fmt::format("{:.1f} cm³", 1e-3 * mm3);
  return mm3 < 10 ? fmt::format("{:.2g} mm³", mm3) : fmt::format("{:.0f} mm³", mm3);
}

std::string notice_words(const std::string& sentence) {
  for (const Known& known : kKnown) {
    auto values = taken_from(sentence, known.sentence);
    if (!values) continue;
    fmt::dynamic_format_arg_store<fmt::format_context> store;
    for (std::string& value : *values)
      store.push_back(known.says == Word::notice_orientation ? direction(value) : std::move(value));
    return fmt::vformat(word(known.says), store);
  }
  return without_names(sentence);
}

std::string trouble_words(const std::string& sentence) {
  constexpr std::pair<std::string_view, Word> kLabels[] = {
      {"as_it_is", Word::import_as_it_is}, {"iso", Word::import_level},
      {"labels", Word::import_labels},     {"region", Word::import_region},
      {"series", Word::import_series},     {"voxel_mm", Word::import_voxel}};
  return in_options(with_names_said(sentence, [&kLabels](std::string_view name) {
    const auto* found = std::find_if(std::begin(kLabels), std::end(kLabels),
                                     [name](const auto& one) { return one.first == name; });
    return found == std::end(kLabels) ? std::string() : fmt::format("\"{}\"", word(found->second));
  }));
}

}  // namespace burr::app
