// render/skin_mesh.h - a patch of surface in compact form for drawing and picking: 20 B a vertex
// and 2 B an index, where surface::Patch has 28 and 4.
//
// Positions are those of the patch to the bit, so that seams stay closed. Normals are stored as an
// octahedron map of 2 x 12 bit (Meyer et al. 2010), exact to 0.06 degrees. Exported meshes are made
// from the field and never use this form.
// Units: m. Frame: world (LPS). Thread: any; a mesh is never changed after it was made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/surface/patch.h"

namespace burr::render {

struct SkinVertex {
  math::Vec3f p;           // world, LPS [m]
  std::uint32_t rest = 0;  // tissue: 8 bit; x and y of the octahedron map: 12 bit each
  // what shines through, 8 bit each: its tissue, its share of 255, and how far this vertex is part
  // of the wall around it
  std::uint32_t under = 0;
};
static_assert(sizeof(SkinVertex) == 20, "goes to the GPU as it is");

[[nodiscard]] std::uint32_t folded(const math::Vec3f& n, volume::TissueId tissue);
[[nodiscard]] math::Vec3f normal_of(const SkinVertex& vertex);  // unit
[[nodiscard]] inline volume::TissueId tissue_of(const SkinVertex& vertex) {
  return static_cast<volume::TissueId>(vertex.rest & 0xFFU);
}

class SkinMesh {
 public:
  explicit SkinMesh(const surface::Patch& patch);

  [[nodiscard]] const std::vector<SkinVertex>& vertices() const { return vertices_; }
  [[nodiscard]] std::size_t index_count() const { return small_.size() + large_.size(); }
  [[nodiscard]] std::uint32_t index(std::size_t n) const {
    return large_.empty() ? small_[n] : large_[n];
  }
  // One of the two is empty: 16 bit unless there are too many vertices.
  [[nodiscard]] const std::vector<std::uint16_t>& small_indices() const { return small_; }
  [[nodiscard]] const std::vector<std::uint32_t>& large_indices() const { return large_; }

 private:
  std::vector<SkinVertex> vertices_;
  std::vector<std::uint16_t> small_;  // (n x 3)
  std::vector<std::uint32_t> large_;  // (n x 3)
};

}  // namespace burr::render
