// tool/grid_of_mesh.h - the distances to a closed mesh of triangles, on a lattice.
//
// Sign: crossings of rows along x, counted with their direction.
// Size: exact near the triangles; farther away, the distance to the triangle that is nearest to a
// neighbour (Bridson, Fluid Simulation for Computer Graphics, 2008, on level sets from meshes).
//
// Units: those of the mesh. Thread: any but the tick.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/tool/shape_grid.h"

namespace burr::tool {

struct Triangles {
  std::vector<math::Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

// Volume inside, by the divergence theorem; below 0 if the faces are seen clockwise from outside.
[[nodiscard]] double volume_inside(const Triangles& mesh);

struct MeshGrid {
  GridCells cells;
  double cell = 0;                         // edge of a cell
  math::Vec3 middle = math::Vec3::Zero();  // of the lattice, in the frame of the mesh
  double volume = 0;                       // inside the lattice's surface
};

// `cell`: edge of a cell; 0: a 64th of the longest side, or more where that takes too many nodes.
// `turns`: the middle of the lattice lies on the mesh's z axis, about which the tool turns.
// Error: a sentence that goes on after "the mesh ": "has 12 open edges; close it".
[[nodiscard]] Result<MeshGrid> grid_of(const Triangles& mesh, double cell, bool turns = false);

}  // namespace burr::tool
