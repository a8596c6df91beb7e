#include "burr/haptics/six/part_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Vec3;
using tool::ShapeKind;

constexpr int kLooks = 48;  // along a core: the last two are 1e-10 of it apart
constexpr double kParallel =
    0.02;  // sine squared of the angle below which two cores meet in a line

// A ball is a capsule of no length.
struct Capsule {
  Vec3 from, to;
  double radius = 0;
};

bool is_capsule(const tool::Shape& shape) BURR_RT {
  return shape.kind == ShapeKind::ball || shape.kind == ShapeKind::capsule;
}

// A shape's own capsule, or one around it.
Capsule capsule_of(const PartPlace& part) BURR_RT {
  const tool::Shape& shape = part.shape;
  Vec3 middle = Vec3::Zero(), half = Vec3::Zero();
  double radius = shape.rounding;
  switch (shape.kind) {
    case ShapeKind::ball:
      break;
    case ShapeKind::capsule:
      half.z() = shape.c;
      break;
    case ShapeKind::half_shell:
      radius += shape.a;
      break;
    case ShapeKind::cylinder:
    case ShapeKind::tube:
    case ShapeKind::frustum:
    case ShapeKind::vesica:
      half.z() = shape.c;
      radius += shape.kind == ShapeKind::frustum ? std::max(shape.a, shape.b) : shape.a;
      break;
    case ShapeKind::box:
    case ShapeKind::wedge:
    case ShapeKind::grid: {
      const math::Aabb box = tool::bounds(shape);
      middle = 0.5 * (box.lo + box.hi);
      const Vec3 size = 0.5 * (box.hi - box.lo);
      int along = 0;
      for (int axis = 1; axis < 3; ++axis)
        if (size[axis] > size[along]) along = axis;
      half[along] = size[along];
      const double u = size[(along + 1) % 3], v = size[(along + 2) % 3];
      radius = std::sqrt(u * u + v * v);
      break;
    }
  }
  return {part.middle + part.turn * Vec3(middle - half),
          part.middle + part.turn * Vec3(middle + half), radius};
}

double radius_around(const PartPlace& part) BURR_RT { return capsule_of(part).radius; }

Vec3 on(const Capsule& capsule, double t) BURR_RT {
  return capsule.from + t * Vec3(capsule.to - capsule.from);
}

// Any unit vector square to both; where there is none, any square to the first.
Vec3 aside(const Vec3& u, const Vec3& v) BURR_RT {
  Vec3 n = u.cross(v);
  if (math::squared_norm(n) < 1e-20)
    n = std::abs(u.x()) < 0.6 * math::norm(u) ? u.cross(Vec3(Vec3::UnitX()))
                                              : u.cross(Vec3(Vec3::UnitY()));
  return math::squared_norm(n) > 0 ? math::normalized(n) : Vec3(Vec3::UnitX());
}

PartGap between(const Vec3& p, double radius_p, const Vec3& q, double radius_q, const Vec3& u,
                const Vec3& v) BURR_RT {
  PartGap gap;
  const Vec3 way = p - q;
  const double far = math::norm(way);
  gap.normal = far > 1e-9 ? Vec3(way / far) : aside(u, v);
  gap.gap = far - radius_p - radius_q;
  gap.a = p - radius_p * gap.normal;
  gap.b = q + radius_q * gap.normal;
  return gap;
}

// Where the core comes nearest to the point, 0..1.
double nearest_on(const Capsule& capsule, const Vec3& p) BURR_RT {
  const Vec3 u = capsule.to - capsule.from;
  const double square = math::squared_norm(u);
  return square > 0 ? std::clamp(math::dot(p - capsule.from, u) / square, 0.0, 1.0) : 0.5;
}

// The nearest points of two segments. Side by side, the middle of what they share.
PartGap capsules(const Capsule& a, const Capsule& b) BURR_RT {
  const Vec3 u = a.to - a.from, v = b.to - b.from, w = a.from - b.from;
  const double uu = math::squared_norm(u), vv = math::squared_norm(v), uv = math::dot(u, v),
               uw = math::dot(u, w), vw = math::dot(v, w);
  const double square = uu * vv - uv * uv;
  double s = 0.5;
  if (square > 1e-12 * uu * vv && square > 0) {
    s = std::clamp((uv * vw - vv * uw) / square, 0.0, 1.0);
  } else if (uu > 0 && vv > 0) {
    const double s0 = -uw / uu, s1 = s0 + uv / uu;  // where b begins and ends, along a
    s = 0.5 * (std::clamp(std::min(s0, s1), 0.0, 1.0) + std::clamp(std::max(s0, s1), 0.0, 1.0));
  }
  const double t = nearest_on(b, on(a, s));
  s = nearest_on(a, on(b, t));
  return between(on(a, s), a.radius, on(b, t), b.radius, u, v);
}

// A capsule and any convex shape: the distance is convex along the core.
PartGap capsule_and(const Capsule& capsule, const PartPlace& other) BURR_RT {
  const auto at = [&](double t) BURR_RT {
    return tool::distance(other.shape,
                          other.turn.conjugate() * Vec3(on(capsule, t) - other.middle));
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 1, left = 1 - kGolden, right = kGolden;
  double at_left = at(left).phi, at_right = at(right).phi;
  for (int look = 0; look < kLooks; ++look) {
    if (at_left <= at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = at(left).phi;
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = at(right).phi;
    }
  }
  const double t = 0.5 * (low + high);
  const tool::Distance there = at(t);
  PartGap gap;
  gap.normal = other.turn * there.gradient;
  gap.gap = there.phi - capsule.radius;
  gap.a = on(capsule, t) - capsule.radius * gap.normal;
  gap.b = on(capsule, t) - there.phi * gap.normal;
  return gap;
}

PartGap turned_round(PartGap gap) BURR_RT {
  std::swap(gap.a, gap.b);
  gap.normal = -gap.normal;
  return gap;
}

}  // namespace

PartGap part_gap(const PartPlace& a, const PartPlace& b) BURR_RT {
  const bool round_a = is_capsule(a.shape) || !tool::convex(a.shape.kind),
             round_b = is_capsule(b.shape) || !tool::convex(b.shape.kind);
  if (round_a && round_b) return capsules(capsule_of(a), capsule_of(b));
  const bool by_a = round_a || (!round_b && radius_around(a) <= radius_around(b));
  return by_a ? capsule_and(capsule_of(a), b) : turned_round(capsule_and(capsule_of(b), a));
}

int gaps_at_ends(const PartPlace& a, const PartPlace& b, PartGap* ends) BURR_RT {
  if (a.shape.kind != ShapeKind::capsule || b.shape.kind != ShapeKind::capsule) return 0;
  const Capsule one = capsule_of(a), other = capsule_of(b);
  const Vec3 u = one.to - one.from, v = other.to - other.from;
  const double uu = math::squared_norm(u), vv = math::squared_norm(v), uv = math::dot(u, v);
  if (uu * vv - uv * uv > kParallel * uu * vv) return 0;
  int count = 0;
  for (const Vec3& p : {one.from, one.to})
    ends[count++] = between(p, one.radius, on(other, nearest_on(other, p)), other.radius, u, v);
  for (const Vec3& q : {other.from, other.to})
    ends[count++] = between(on(one, nearest_on(one, q)), one.radius, q, other.radius, u, v);
  return count;
}

}  // namespace burr::haptics
