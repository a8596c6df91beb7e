#include "burr/tool/shaped_tool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace burr::tool {
namespace {

double thickness(const Shape& shape) {
  const double round = 2 * shape.rounding;
  switch (shape.kind) {
    case ShapeKind::ball:
    case ShapeKind::capsule:
    case ShapeKind::half_shell:
      return round;
    case ShapeKind::cylinder:
      return 2 * std::min(shape.a, shape.c) + round;
    case ShapeKind::frustum:
      return 2 * std::max(shape.a, shape.b) + round;
    case ShapeKind::vesica:
      return 2 * shape.a + round;
    case ShapeKind::box:
      return 2 * std::min({shape.a, shape.b, shape.c}) + round;
    case ShapeKind::tube:
      return std::min(shape.a - shape.b, 2 * shape.c) + round;
    case ShapeKind::wedge:
      return 2 * shape.a + round;
    case ShapeKind::grid:
      return 2 * shape.grid->deepest * shape.a;
  }
  return round;
}

}  // namespace

double full_speed(const Cutter& cutter) {
  switch (cutter.drive) {
    case Drive::turning:
      return cutter.speed_rad_s;
    case Drive::oscillating:
    case Drive::reciprocating:
      return 2 * std::numbers::pi * cutter.cycles_hz;
    case Drive::pushed:
    case Drive::struck:
      break;
  }
  return 0;
}

double thinnest(const Tool& tool) {
  double least = std::numeric_limits<double>::infinity();
  for (int p = 0; p < tool.count; ++p) {
    const Part& part = tool.parts[static_cast<std::size_t>(p)];
    if (part.role != Role::seen) least = std::min(least, thickness(part.shape));
  }
  return least;
}

}  // namespace burr::tool
