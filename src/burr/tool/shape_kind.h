// tool/shape_kind.h - the sizes of a shape (shape.h), without any other header: kernels that are
// compiled once per instruction set include it (rt/lanes.h says why).
#pragma once

namespace burr::tool {

enum class ShapeKind {
  ball,        // core: the origin
  capsule,     // core: the segment |z| <= c
  cylinder,    // core: radius a, |z| <= c; flat: a disc or a wheel
  frustum,     // core: radius a at z = -c, b at z = +c
  vesica,      // core: the arc through (a, 0) and the tips (0, +-c), turned about z; 0 < a < c
  box,         // core: half sizes a, b, c
  wedge,       // core: edge at z = 0 along y, faces to half thickness a at z = c; |y| <= b
  half_shell,  // core: the sphere of radius a up to the height z = b, |b| < a; not convex
  tube,        // core: the ring between the radii b and a, b <= a, |z| <= c; not convex
  grid,  // any body: distances on a lattice, whose cells have the edge a; b and c are not used
};
inline constexpr int kShapeKinds = 10;

// Distances to a body's surface at the nodes of a lattice, linear between. The lattice's middle is the
// origin. Made and kept by tool/shape_grid.h; never changed and never freed, so the tick may hold it.
struct ShapeGrid {
  int size[3] = {0, 0, 0};  // number of nodes along x, y, z
  const float* phi =
      nullptr;  // [cell], below 0 inside; node (x, y, z): [(z size[1] + y) size[0] + x]
  double lo[3] = {0, 0, 0};  // the box around the body  [cell]
  double hi[3] = {0, 0, 0};
  double deepest = 0;  // greatest distance to the surface inside the body  [cell]
};

struct Shape {
  ShapeKind kind = ShapeKind::ball;
  double a = 0, b = 0, c = 0;  // as each kind says
  double rounding = 0;         // >= 0; a grid has none
  const ShapeGrid* grid = nullptr;
};

}  // namespace burr::tool
