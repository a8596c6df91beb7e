// io/read/mesh_builder.h - makes a mesh of triangles from faces of any number of corners: joins equal
// places, cuts faces into triangles, counts. For use of this room only.
//
// Thread: one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/triangle_mesh.h"

namespace burr::io {

using Place = std::array<float, 3>;

class MeshBuilder {
 public:
  // A face; fewer than three corners hold nothing. Error: not a number, too many corners, too many
  // triangles.
  [[nodiscard]] Status face(std::span<const Place> corners);
  // A number of a file as burr keeps it.
  [[nodiscard]] static float number(double value) { return static_cast<float>(value); }
  [[nodiscard]] TriangleMesh done() { return std::move(mesh_); }

 private:
  struct Hash {
    [[nodiscard]] std::size_t operator()(const Place& place) const;
  };
  [[nodiscard]] std::uint32_t point(const Place& place);

  TriangleMesh mesh_;
  std::unordered_map<Place, std::uint32_t, Hash> known_;
};

}  // namespace burr::io
