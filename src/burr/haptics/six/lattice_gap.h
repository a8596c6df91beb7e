// haptics/six/lattice_gap.h - how far a part of a tool is from a body that is a lattice of distances: a
// piece of bone in a hand, or a mesh.
//
// Points of the body's surface, some in each cell of its lattice (tool/shape_grid.h), are looked at
// against the part's own distance, as a tool meets the points of bone. So a flat face rests on many
// points, and a convex part is never closer to a point than the row of that point says. Two lattices:
// the points of each against the distance of the other.
//
// Thread: servo. Frame and unit: any, the same for both. Memory: none.
#pragma once

#include <span>

#include "burr/haptics/six/part_gap.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

[[nodiscard]] inline bool has_lattice(const PartPlace& a, const PartPlace& b) BURR_RT {
  return a.shape.kind == tool::ShapeKind::grid || b.shape.kind == tool::ShapeKind::grid;
}

// One of the two is a lattice. All points nearer than `within`, into `out`; PartGap as part_gap() has
// it. Returns how many there are, which may be more than `out` holds.
[[nodiscard]] int lattice_gaps(const PartPlace& a, const PartPlace& b, double within,
                               std::span<PartGap> out) BURR_RT;

// The least of them; exact where it is below `below`, otherwise anything above. Below 0 also where the
// middle of the one is inside the lattice of the other.
[[nodiscard]] double lattice_gap(const PartPlace& a, const PartPlace& b, double below) BURR_RT;

}  // namespace burr::haptics
