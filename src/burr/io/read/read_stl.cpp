// STL (3D Systems, 1988): triangles with corners of their own. Binary: 80 bytes, a count, 50 bytes for each.
// Text: words. A binary file may begin with "solid" too; its length tells.
#include <fmt/core.h>

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "burr/base/printable.h"
#include "burr/io/read/mesh_builder.h"
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/mesh_text.h"

namespace burr::io {
namespace {

constexpr std::size_t kHead = 84, kEach = 50, kNormal = 12;
static_assert(std::endian::native == std::endian::little);

std::uint32_t count_in(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

Result<TriangleMesh> read_binary(std::string_view bytes) {
  MeshBuilder mesh;
  const std::uint32_t count = count_in(bytes);
  for (std::size_t n = 0; n < count; ++n) {
    std::array<Place, 3> corners{};
    std::memcpy(&corners, bytes.data() + kHead + n * kEach + kNormal, sizeof corners);
    if (Status status = mesh.face(corners); !status) return status.error();
  }
  return mesh.done();
}

Result<TriangleMesh> read_words(std::string_view bytes) {
  MeshBuilder mesh;
  MeshText text(bytes);
  std::vector<Place> corners;
  const auto broken = [&](std::string_view why) {
    return no_mesh("stl", fmt::format("line {}: {}", text.line(), why));
  };
  const auto three = [&](Place& to) {
    for (float& x : to) {
      const auto number = number_in(text.word());
      if (!number) return false;
      x = MeshBuilder::number(*number);
    }
    return true;
  };
  for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
    Place place{};
    if (same_word(word, "solid") || same_word(word, "endsolid")) {
      text.rest_of_line();  // a name, or several
    } else if (same_word(word, "vertex")) {
      if (!three(place)) return broken("a corner needs three numbers");
      corners.push_back(place);
    } else if (same_word(word, "normal")) {
      for (int n = 0; n < 3; ++n) static_cast<void>(text.word());  // follows from the corners
    } else if (same_word(word, "endloop")) {
      if (Status status = mesh.face(corners); !status) return status.error();
      corners.clear();
    } else if (!same_word(word, "facet") && !same_word(word, "outer") && !same_word(word, "loop") &&
               !same_word(word, "endfacet")) {
      return broken(fmt::format("\"{}\" is no word of STL", base::printable(word)));
    }
  }
  if (!corners.empty()) return broken("the file ends within a triangle; copy it again");
  return mesh.done();
}

}  // namespace

Result<TriangleMesh> read_stl(std::string_view bytes) {
  const bool long_enough = bytes.size() >= kHead;
  if (long_enough && bytes.size() - kHead == std::size_t{count_in(bytes)} * kEach)
    return read_binary(bytes);
  MeshText text(bytes);
  if (same_word(text.word(), "solid")) return read_words(bytes);
  if (!long_enough) return no_mesh("stl", "it neither begins with solid nor is as long as a count");
  const std::size_t there = (bytes.size() - kHead) / kEach;
  if (count_in(bytes) > there)
    return no_mesh("stl", fmt::format("it says {} triangles and holds {}; copy it again",
                                      count_in(bytes), there));
  return read_binary(bytes);
}

}  // namespace burr::io
