// surface/shells.h - the separate parts of a mesh, and its hollows: closed shells.
//
// A shell is what triangles join that share a vertex. Shells that face outward (their volume is
// above 0) are parts; those that face inward are the walls of cavities.
// Thread: any. Memory: 4 bytes a vertex, and 12 a triangle in largest_part().
#pragma once

#include <cstddef>

#include "burr/surface/patch.h"

namespace burr::surface {

inline constexpr double kIsland = 1e-10;  // parts below this volume are called islands, 0.1 mm^3

struct Shells {
  std::size_t parts = 0, cavities = 0;
  std::size_t islands = 0;  // parts below kIsland
  double volume = 0;        // enclosed by the mesh: parts less cavities  [m^3]
  double largest = 0;       // of the largest part, its cavities not subtracted  [m^3]
};
// mesh: closed.
[[nodiscard]] Shells shells_of(const Mesh& mesh);

// The mesh without the shells that enclose less than `least`, cavities too. left_out: how many parts
// that were, and what they enclose.
struct LeftOut {
  std::size_t parts = 0;
  double volume = 0;  // [m^3]
};
[[nodiscard]] Mesh without_crumbs(const Mesh& mesh, double least, LeftOut& left_out);

// The part of the largest volume with the cavities inside it, but not the parts inside these.
[[nodiscard]] Mesh largest_part(const Mesh& mesh);

}  // namespace burr::surface
