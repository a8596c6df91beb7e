#include "burr/io/read/nrrd_shape.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "burr/base/printable.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

std::string field_text(const NrrdHeader& header, const char* name) {
  const auto found = header.fields.find(name);
  return found == header.fields.end() ? std::string() : found->second;
}

// The sizes of all axes.
Result<std::vector<std::int64_t>> sizes_of(const NrrdHeader& header, const std::string& file) {
  if (header.fields.count("sizes") == 0)
    return error(fmt::format("{}: the field \"sizes\" is missing", file));
  std::vector<std::int64_t> all;
  for (const std::string& word : words(field_text(header, "sizes"))) {
    std::int64_t n = 0;
    if (!to_number(word, n) || n < 1)
      return error(
          fmt::format("{}: sizes: \"{}\" is not a size of an axis", file, base::printable(word)));
    all.push_back(n);
  }
  std::int64_t dimension = 0;
  if (!to_number(field_text(header, "dimension"), dimension) ||
      dimension != static_cast<std::int64_t>(all.size()))
    return error(fmt::format("{}: dimension does not agree with {} sizes", file, all.size()));
  return all;
}

// Kinds that are no axis of space: of them the first three give volumes, one after the other.
bool is_list(const std::string& kind) {
  return kind == "list" || kind == "time" || kind == "vector";
}
bool no_space(const std::string& kind) {
  return is_list(kind) || kind.find("color") != std::string::npos || kind == "3-vector";
}

// Which of four axes counts volumes: by its kind, or because it has no direction, or the last.
std::size_t axis_of_volumes(const NrrdHeader& header, const std::vector<std::string>& kinds,
                            const std::vector<std::size_t>& axes) {
  for (const std::size_t a : axes)
    if (is_list(kinds[a])) return a;
  const std::vector<std::string> directions = nrrd_directions(header);
  for (const std::size_t a : axes)
    if (a < directions.size() && directions.size() == kinds.size() && directions[a] == "none")
      return a;
  return axes.back();
}

}  // namespace

std::vector<std::string> nrrd_directions(const NrrdHeader& header) {
  std::vector<std::string> moves;
  for (std::string text = field_text(header, "spacedirections"); !text.empty();) {
    const std::string_view rest = trimmed(text);
    if (rest.empty()) break;
    const std::size_t end = rest.front() == '(' ? rest.find(')') : rest.find(' ');
    const std::size_t n =
        end == std::string_view::npos ? rest.size() : end + (rest.front() == '(' ? 1 : 0);
    moves.emplace_back(rest.substr(0, n));
    text = std::string(rest.substr(n));
  }
  return moves;
}

Result<NrrdShape> nrrd_shape(const NrrdHeader& header, const std::string& file, bool segmentation) {
  const auto all = sizes_of(header, file);
  if (!all) return all.error();
  std::vector<std::string> kinds = words(lower(field_text(header, "kinds")));
  kinds.resize(all->size());
  std::vector<std::size_t> left;  // axes of more than one entry, and of space
  for (std::size_t a = 0; a < all->size(); ++a)
    if ((*all)[a] > 1 || (all->size() <= 3 && !no_space(kinds[a]))) left.push_back(a);

  NrrdShape shape;
  constexpr std::int64_t kMostLayers = 64, kFewest = 4;
  const std::size_t several = left.size() == 4 ? axis_of_volumes(header, kinds, left) : all->size();
  for (const std::size_t a : left) {
    const std::int64_t n = (*all)[a];
    if (segmentation && no_space(kinds[a]) && all->size() == 4 && (a == 0 || a == 3)) {
      if (n > kMostLayers)
        return error(
            fmt::format("{}: its segments overlap in {} layers, and burr reads at most {}; merge "
                        "them in 3D Slicer (Segmentations, Collapse segments) and save again",
                        file, n, kMostLayers));
      shape.layers = n;
      shape.layers_first = a == 0;
      continue;
    }
    // two to four numbers of every voxel are a vector more often than volumes
    const bool vector = kinds[a] == "vector" && a == 0 && n <= kFewest;
    if (a == several && !segmentation && !vector && (is_list(kinds[a]) || !no_space(kinds[a]))) {
      shape.volumes = n;
      for (std::size_t b = 0; b < a; ++b) shape.before_volumes *= (*all)[b];
      continue;
    }
    if (no_space(kinds[a]))
      return error(
          fmt::format("{}: axis {} is \"{}\" with {} entries, not an axis of space; burr reads one "
                      "value per voxel",
                      file, a, base::printable(kinds[a]), n));
    shape.sizes.push_back(n);
    shape.axes.push_back(a);
  }
  if (shape.sizes.size() != 3)
    return error(fmt::format(
        "{}: 3 axes expected, {} found; {}", file, shape.sizes.size(),
        shape.sizes.size() > 3 ? "save one volume of it" : "a single picture is not a volume"));
  return shape;
}

bool nrrd_type(const std::string& name, SampleType& type) {
  static const std::map<std::string, SampleType> known = {
      {"signed char", SampleType::i8},
      {"int8", SampleType::i8},
      {"int8_t", SampleType::i8},
      {"uchar", SampleType::u8},
      {"unsigned char", SampleType::u8},
      {"uint8", SampleType::u8},
      {"uint8_t", SampleType::u8},
      {"short", SampleType::i16},
      {"short int", SampleType::i16},
      {"signed short", SampleType::i16},
      {"signed short int", SampleType::i16},
      {"int16", SampleType::i16},
      {"int16_t", SampleType::i16},
      {"ushort", SampleType::u16},
      {"unsigned short", SampleType::u16},
      {"unsigned short int", SampleType::u16},
      {"uint16", SampleType::u16},
      {"uint16_t", SampleType::u16},
      {"int", SampleType::i32},
      {"signed int", SampleType::i32},
      {"int32", SampleType::i32},
      {"int32_t", SampleType::i32},
      {"uint", SampleType::u32},
      {"unsigned int", SampleType::u32},
      {"uint32", SampleType::u32},
      {"uint32_t", SampleType::u32},
      {"longlong", SampleType::i64},
      {"long long", SampleType::i64},
      {"long long int", SampleType::i64},
      {"signed long long", SampleType::i64},
      {"signed long long int", SampleType::i64},
      {"int64", SampleType::i64},
      {"int64_t", SampleType::i64},
      {"ulonglong", SampleType::u64},
      {"unsigned long long", SampleType::u64},
      {"unsigned long long int", SampleType::u64},
      {"uint64", SampleType::u64},
      {"uint64_t", SampleType::u64},
      {"float", SampleType::f32},
      {"double", SampleType::f64}};
  const auto found = known.find(name);
  if (found == known.end()) return false;
  type = found->second;
  return true;
}

}  // namespace burr::io
