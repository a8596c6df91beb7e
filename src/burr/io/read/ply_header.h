// io/read/ply_header.h - the head of a PLY: which elements follow, and what each consists of. For use of
// this room only.
//
// Source: Turk, The PLY Polygon File Format, 1994. Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/mesh_text.h"

namespace burr::io {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
[[nodiscard]] std::size_t bytes_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::int8;
  std::optional<PlyType> count;  // of a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
  enum class Form { text, little, big } form = Form::text;
  std::vector<PlyElement> elements;
};

// Reads up to and with the line end_header. Error: what is wrong, with its line.
[[nodiscard]] Result<PlyHeader> ply_header(MeshText& text);

}  // namespace burr::io
