// surface/patch.h - the surface of one block of bone, as triangles. Plain struct.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/volume/tissue.h"

namespace burr::surface {

inline constexpr int kPatchEdge = 16;  // cells along each edge of a patch: 2 x 2 x 2 bricks

struct Vertex {
  math::Vec3f p;  // world, LPS                                   [m]
  math::Vec3f n;  // unit, out of the bone, from the field's gradient
  volume::TissueId tissue = 1;
  // Soft tissue under thin bone here, or filling the hollow that this wall belongs to; otherwise
  // another solid tissue whose border is near; 0: none.
  volume::TissueId beneath = 0;
  std::uint8_t through = 0;  // how much of it shows through, 0..255
  std::uint8_t wall = 0;     // how much of the hollow at this wall it fills, 0..255
};

// Counter-clockwise seen from the air. Vertices are shared inside the patch; at its seams they are
// repeated bit for bit.
struct Patch {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  // (n x 3)
};

// The same for a whole bone, seams welded.
using Mesh = Patch;

}  // namespace burr::surface
