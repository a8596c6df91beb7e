#include "burr/io/read/ply_header.h"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "burr/base/printable.h"

namespace burr::io {
namespace {

constexpr std::size_t kMostElements = 64, kMostProperties = 256;

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
    {"char", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"int", PlyType::int32},
    {"uint", PlyType::uint32},
    {"float", PlyType::float32},
    {"double", PlyType::float64},
    {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},
    {"int16", PlyType::int16},
    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},
    {"uint32", PlyType::uint32},
    {"float32", PlyType::float32},
    {"float64", PlyType::float64},
}};

std::optional<PlyType> type_in(std::string_view word) {
  for (const auto& [name, type] : kTypes)
    if (word == name) return type;
  return std::nullopt;
}

class Head {
 public:
  explicit Head(MeshText& text) : text_(text) {}

  Result<PlyHeader> read() {
    if (text_.word_of_line() != "ply") return no_mesh("ply", "it does not begin with ply");
    text_.rest_of_line();
    bool formed = false;
    while (!text_.at_end()) {
      const std::string_view word = text_.word_of_line();
      if (word == "end_header") {
        text_.rest_of_line();
        if (!formed) return broken("the format is missing");
        return std::move(out_);
      }
      Status status = fine();
      if (word == "format") {
        formed = true;
        status = format();
      } else if (word == "element") {
        status = element();
      } else if (word == "property") {
        status = property();
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        return broken(fmt::format("\"{}\" is no word of its head", base::printable(word)));
      }
      if (!status) return status.error();
      text_.rest_of_line();
    }
    return no_mesh("ply", "its head does not end; copy the file again");
  }

 private:
  [[nodiscard]] Error broken(std::string_view why) const {
    return no_mesh("ply", fmt::format("line {}: {}", text_.line(), why));
  }

  Status format() {
    const std::string_view form = text_.word_of_line();
    if (form == "ascii")
      out_.form = PlyHeader::Form::text;
    else if (form == "binary_little_endian")
      out_.form = PlyHeader::Form::little;
    else if (form == "binary_big_endian")
      out_.form = PlyHeader::Form::big;
    else
      return broken(fmt::format("\"{}\" is no format", base::printable(form)));
    return fine();
  }

  Status element() {
    PlyElement one;
    one.name = std::string(text_.word_of_line());
    const auto count = whole_number_in(text_.word_of_line());
    if (one.name.empty() || !count || *count < 0)
      return broken("an element needs a name and a count");
    if (out_.elements.size() == kMostElements) return broken("it has too many elements");
    one.count = static_cast<std::uint64_t>(*count);
    out_.elements.push_back(std::move(one));
    return fine();
  }

  Status property() {
    if (out_.elements.empty()) return broken("a property comes before the first element");
    PlyProperty one;
    std::string_view word = text_.word_of_line();
    if (word == "list") {
      one.count = type_in(text_.word_of_line());
      if (!one.count || *one.count >= PlyType::float32)
        return broken("the length of a list needs a type of whole numbers");
      word = text_.word_of_line();
    }
    const auto type = type_in(word);
    one.name = std::string(text_.word_of_line());
    if (!type || one.name.empty()) return broken("a property needs a type and a name");
    if (out_.elements.back().properties.size() == kMostProperties)
      return broken("an element has too many properties");
    one.type = *type;
    out_.elements.back().properties.push_back(std::move(one));
    return fine();
  }

  MeshText& text_;
  PlyHeader out_;
};

}  // namespace

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t n = 0; n < properties.size(); ++n)
    if (properties[n].name == property) return n;
  return std::nullopt;
}

Result<PlyHeader> ply_header(MeshText& text) { return Head(text).read(); }

}  // namespace burr::io
