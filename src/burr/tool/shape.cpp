#include "burr/tool/shape.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/tool/shape_formulas.h"

namespace burr::tool {

using math::Vec3;

Distance distance(const Shape& shape, const Vec3& p) BURR_RT {
  Field<OneNumber> out;
  field_of<OneNumber>(shape.kind, sizes_of<double>(shape), p.x(), p.y(), p.z(), out);
  return {out.phi, {out.x, out.y, out.z}};
}

namespace {

// Of the vesica's profile in direction (ar, az), ar >= 0: the tip, or the arc.
double vesica_support(const Shape& s, double ar, double az, double length) BURR_RT {
  const double offset = (s.c * s.c - s.a * s.a) / (2 * s.a), arc = offset + s.a;
  if (std::abs(az) * arc > s.c * length) return std::abs(az) * s.c;
  return arc * length - offset * ar;
}

double core_support(const Shape& s, const Vec3& way) BURR_RT {
  const double ar = std::sqrt(way.x() * way.x() + way.y() * way.y()), az = way.z();
  const double length = math::norm(way);
  switch (s.kind) {
    case ShapeKind::ball:
      break;
    case ShapeKind::capsule:
      return s.c * std::abs(az);
    case ShapeKind::cylinder:
    case ShapeKind::tube:
      return s.a * ar + s.c * std::abs(az);
    case ShapeKind::frustum:
      return std::max(s.a * ar - s.c * az, s.b * ar + s.c * az);
    case ShapeKind::vesica:
      return vesica_support(s, ar, az, length);
    case ShapeKind::box:
      return s.a * std::abs(way.x()) + s.b * std::abs(way.y()) + s.c * std::abs(az);
    case ShapeKind::wedge:
      return s.b * std::abs(way.y()) + std::max(0.0, s.a * std::abs(way.x()) + s.c * az);
    case ShapeKind::half_shell: {
      const double rim = std::sqrt((s.a - s.b) * (s.a + s.b));
      return az * rim > ar * s.b ? rim * ar + s.b * az : s.a * length;
    }
    case ShapeKind::grid: {  // of the box around it
      double all = 0;
      for (int axis = 0; axis < 3; ++axis)
        all += way[axis] * (way[axis] > 0 ? s.grid->hi[axis] : s.grid->lo[axis]);
      return s.a * all;
    }
  }
  return 0;
}

}  // namespace

double support(const Shape& shape, const Vec3& direction) BURR_RT {
  return core_support(shape, direction) + shape.rounding * math::norm(direction);
}

math::Aabb bounds(const Shape& shape) BURR_RT {
  math::Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = Vec3::Unit(axis);
    box.hi[axis] = support(shape, way);
    box.lo[axis] = -support(shape, -way);
  }
  return box;
}

BoundingBall bounding_ball(const Shape& shape) BURR_RT {
  if (shape.kind == ShapeKind::ball || shape.kind == ShapeKind::capsule)
    return {Vec3::Zero(), shape.c * (shape.kind == ShapeKind::capsule ? 1 : 0) + shape.rounding};
  const math::Aabb box = bounds(shape);
  // the corner of the box without the rounding, plus the rounding
  const Vec3 half = 0.5 * (box.hi - box.lo) - Vec3::Constant(shape.rounding);
  return {0.5 * (box.hi + box.lo), math::norm(half) + shape.rounding};
}

bool convex(ShapeKind kind) BURR_RT {
  return kind != ShapeKind::half_shell && kind != ShapeKind::tube && kind != ShapeKind::grid;
}

Shape scaled(const Shape& s, double factor) BURR_RT {
  return {s.kind, s.a * factor, s.b * factor, s.c * factor, s.rounding * factor, s.grid};
}

bool is_body(const Shape& s) BURR_RT {
  for (const double size : {s.a, s.b, s.c, s.rounding})
    if (!std::isfinite(size)) return false;
  if (s.rounding < 0 || s.a < 0 || s.c < 0) return false;
  switch (s.kind) {
    case ShapeKind::ball:
    case ShapeKind::capsule:
      return s.rounding > 0;
    case ShapeKind::cylinder:
      return s.a + s.rounding > 0 && s.c + s.rounding > 0;
    case ShapeKind::frustum:
      return s.b >= 0 && s.c > 0 && std::max(s.a, s.b) + s.rounding > 0;
    case ShapeKind::vesica:
      return s.a > 0 && s.a < s.c;
    case ShapeKind::box:
      return s.b >= 0 && std::min({s.a, s.b, s.c}) + s.rounding > 0;
    case ShapeKind::wedge:
      return s.a > 0 && s.b >= 0 && s.c > 0;
    case ShapeKind::half_shell:
      return std::abs(s.b) < s.a && s.rounding > 0;
    case ShapeKind::tube:
      return s.b > s.rounding && s.b <= s.a && s.c + s.rounding > 0 && s.a - s.b + s.rounding > 0;
    case ShapeKind::grid:
      return s.a > 0 && s.grid != nullptr && s.rounding <= 0;
  }
  return false;
}

}  // namespace burr::tool
