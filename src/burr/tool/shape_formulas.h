// tool/shape_formulas.h - the distances of shape.h, for one number at a time and for sixteen.
//
// The template argument M says with what to compute: OneNumber below, or SixteenNumbers of
// rt/lanes.h. Branches are choices between two values, so that lanes can follow both; sums have a
// written order, so every lane gives the same bits on every instruction set.
//
// Everything has internal linkage: a kernel's translation unit compiles its own copy for its own
// instruction set. Vectors go by reference, as rt/lanes.h asks.
//
// Round kinds are solved in the half plane (r, z), r = |(x, y)|, then turned back about z.
// Sources: elementary geometry; each formula is checked against dense samples of the surface in
// tests/tool/shape_test.cpp.
#pragma once

#include <cmath>

#include "burr/tool/shape_kind.h"

namespace burr::tool {
namespace {

// The sizes of a shape in the number type of the caller, and what follows from them once.
template <class Real>
struct Sizes {
  Real a = 0, b = 0, c = 0, rounding = 0;
  Real e0 = 0, e1 = 0, length = 0;  // frustum, wedge: unit along the slant side (r, z), its length
  Real offset = 0, arc = 0;         // vesica: of the arc's centre from the axis, its radius
  const ShapeGrid* grid = nullptr;
};

template <class Real>
[[maybe_unused]] Sizes<Real> sizes_of(const Shape& s) noexcept {
  Sizes<double> d;
  if (s.kind == ShapeKind::frustum || s.kind == ShapeKind::wedge) {
    const double across = s.kind == ShapeKind::frustum ? s.b - s.a : s.a;
    const double along = s.kind == ShapeKind::frustum ? 2 * s.c : s.c;
    d.length = std::sqrt(across * across + along * along);
    d.e0 = across / d.length;
    d.e1 = along / d.length;
  }
  if (s.kind == ShapeKind::vesica) {
    d.offset = (s.c * s.c - s.a * s.a) / (2 * s.a);
    d.arc = d.offset + s.a;
  }
  return {static_cast<Real>(s.a),      static_cast<Real>(s.b),
          static_cast<Real>(s.c),      static_cast<Real>(s.rounding),
          static_cast<Real>(d.e0),     static_cast<Real>(d.e1),
          static_cast<Real>(d.length), static_cast<Real>(d.offset),
          static_cast<Real>(d.arc),    s.grid};
}

// One number at a time.
struct OneNumber {
  using Number = double;
  using Real = double;
  static void square_root(double& v) noexcept { v = std::sqrt(v); }
  static double choose(bool first, double one, double other) noexcept {
    return first ? one : other;
  }
};
template <class M>
using Num = typename M::Number;
template <class M>
using Size = typename M::Real;

// Distance and gradient at a place.
template <class M>
struct Field {
  Num<M> phi = {}, x = {}, y = {}, z = {};
};

// In the half plane (r, z) or the plane (x, z) of a wedge.
template <class M>
struct Profile {
  Num<M> d = {}, r = {}, z = {};
};

// A length is never below kTiny, so nothing is divided by zero; up to kNothing it counts as zero.
template <class Real>
inline constexpr Real kTiny = static_cast<Real>(1e-18);
template <class Real>
inline constexpr Real kNothing = static_cast<Real>(4e-18);

template <class M>
[[maybe_unused]] void length_of(const Num<M>& x, const Num<M>& y, Num<M>& length) noexcept {
  length = x * x + y * y + kTiny<Size<M>> * kTiny<Size<M>>;
  M::square_root(length);
}

// ---- profiles: signed distance to the core and its gradient

template <class M>
[[maybe_unused]] void from_place(const Num<M>& r, const Num<M>& z, Profile<M>& out) noexcept {
  length_of<M>(r, z, out.d);
  const auto apart = out.d > kNothing<Size<M>>;
  out.r = M::choose(apart, r / out.d, Num<M>{} + static_cast<Size<M>>(1));
  out.z = M::choose(apart, z / out.d, Num<M>{});
}

template <class M>
[[maybe_unused]] void capsule(const Sizes<Size<M>>& s, const Num<M>& r, const Num<M>& z,
                              Profile<M>& out) noexcept {
  const Num<M> top = Num<M>{} + s.c;
  Num<M> on = M::choose(z > top, top, z);
  on = M::choose(on < -top, -top, on);
  from_place<M>(r, z - on, out);
}

// Rectangle |r| <= half_r, |z| <= half_z; r >= 0.
template <class M>
[[maybe_unused]] void rectangle(const Size<M>& half_r, const Size<M>& half_z, const Num<M>& r,
                                const Num<M>& z, Profile<M>& out) noexcept {
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  const Num<M> side = M::choose(z < zero, -one, one);
  const Num<M> dr = r - half_r, dz = z * side - half_z;
  const Num<M> over_r = M::choose(dr > zero, dr, zero), over_z = M::choose(dz > zero, dz, zero);
  Num<M> far;
  length_of<M>(over_r, over_z, far);
  const auto outside = far > kNothing<Size<M>>;
  const auto radial = dr > dz;
  const Num<M> deep = M::choose(radial, dr, dz);
  const Num<M> ir = M::choose(radial, one, zero), iz = M::choose(radial, zero, side);
  out.d = M::choose(outside, far, deep);
  out.r = M::choose(outside, over_r / far, ir);
  out.z = M::choose(outside, over_z * side / far, iz);
}

// A convex profile of a slant side from (r0, z0) on, and two flat ends: at `top` of half width
// r_top, and at `bottom` of half width r_bottom. r >= 0.
template <class M>
struct Slant {
  Size<M> r0, z0, top, r_top, bottom, r_bottom;
};
template <class M>
[[maybe_unused]] void slanted(const Sizes<Size<M>>& s, const Slant<M>& body, const Num<M>& r,
                              const Num<M>& z, Profile<M>& out) noexcept {
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  const Num<M> fr = r - body.r0, fz = z - body.z0;
  // the side's outward normal is (e1, -e0)
  const Num<M> over_side = fr * s.e1 - fz * s.e0;
  Num<M> t = fr * s.e0 + fz * s.e1;
  t = M::choose(t < zero, zero, t);
  t = M::choose(t > zero + s.length, zero + s.length, t);
  Profile<M> side, end;
  from_place<M>(fr - t * s.e0, fz - t * s.e1, side);
  const Num<M> over_top = z - body.top, over_bottom = body.bottom - z;
  const auto upper = over_top > over_bottom;
  const Num<M> over_end = M::choose(upper, over_top, over_bottom);
  const Num<M> level = M::choose(upper, zero + body.top, zero + body.bottom);
  const Num<M> width = M::choose(upper, zero + body.r_top, zero + body.r_bottom);
  from_place<M>(M::choose(r < width, zero, r - width), z - level, end);
  const Num<M> worst = M::choose(over_side > over_end, over_side, over_end);
  const auto outside = worst > kNothing<Size<M>>;
  const auto to_side = side.d < end.d;
  const auto slant_first = over_side > over_end;
  const Num<M> up = M::choose(upper, one, -one);
  const Num<M> ir = M::choose(slant_first, zero + s.e1, zero),
               iz = M::choose(slant_first, zero - s.e0, up);
  const Num<M> od = M::choose(to_side, side.d, end.d),
               outside_r = M::choose(to_side, side.r, end.r),
               outside_z = M::choose(to_side, side.z, end.z);
  out.d = M::choose(outside, od, worst);
  out.r = M::choose(outside, outside_r, ir);
  out.z = M::choose(outside, outside_z, iz);
}

template <class M>
[[maybe_unused]] void vesica(const Sizes<Size<M>>& s, const Num<M>& r, const Num<M>& z,
                             Profile<M>& out) noexcept {
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  const Num<M> side = M::choose(z < zero, -one, one);
  const Num<M> beyond = z * side - s.c;
  Profile<M> tip, arc;
  from_place<M>(r, beyond * side, tip);
  from_place<M>(r + s.offset, z, arc);
  const auto at_tip = beyond * s.offset > r * s.c;
  out.d = M::choose(at_tip, tip.d, arc.d - s.arc);
  out.r = M::choose(at_tip, tip.r, arc.r);
  out.z = M::choose(at_tip, tip.z, arc.z);
}

template <class M>
[[maybe_unused]] void half_shell(const Sizes<Size<M>>& s, const Size<M>& rim, const Num<M>& r,
                                 const Num<M>& z, Profile<M>& out) noexcept {
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  Profile<M> edge, middle;
  from_place<M>(r - rim, z - s.b, edge);
  from_place<M>(r, z, middle);
  const Num<M> off = middle.d - s.a;
  const Num<M> way = M::choose(off < zero, -one, one);
  const auto above = z * rim > r * s.b;
  out.d = M::choose(above, edge.d, off * way);
  out.r = M::choose(above, edge.r, middle.r * way);
  out.z = M::choose(above, edge.z, middle.z * way);
}

// The rectangle of a tube's wall, on one side of the axis.
template <class M>
[[maybe_unused]] void tube(const Sizes<Size<M>>& s, const Num<M>& r, const Num<M>& z,
                           Profile<M>& out) noexcept {
  const Size<M> half = static_cast<Size<M>>(0.5);
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  const Num<M> from_middle = r - half * (s.a + s.b);
  const Num<M> side = M::choose(from_middle < zero, -one, one);
  rectangle<M>(half * (s.a - s.b), s.c, from_middle * side, z, out);
  out.r = out.r * side;
}

// ---- the shapes

// A box or a wedge: a profile across y, extruded to |y| <= half.
template <class M>
[[maybe_unused]] void extrude(const Profile<M>& across, const Num<M>& side_x, const Size<M>& half,
                              const Num<M>& y, Field<M>& out) noexcept {
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  const Num<M> side = M::choose(y < zero, -one, one);
  const Num<M> dy = y * side - half;
  const Num<M> over = M::choose(across.d > zero, across.d, zero),
               over_y = M::choose(dy > zero, dy, zero);
  Num<M> far;
  length_of<M>(over, over_y, far);
  const auto outside = far > kNothing<Size<M>>;
  const auto flat = across.d > dy;
  const Num<M> in_profile = M::choose(flat, one, zero), in_y = M::choose(flat, zero, side);
  const Num<M> p = M::choose(outside, over / far, in_profile);
  const Num<M> deep = M::choose(flat, across.d, dy);
  out.phi = M::choose(outside, far, deep);
  out.x = p * across.r * side_x;
  out.y = M::choose(outside, over_y * side / far, in_y);
  out.z = p * across.z;
}

template <class M>
[[maybe_unused]] void ball_field(const Sizes<Size<M>>& s, const Num<M>& x, const Num<M>& y,
                                 const Num<M>& z, Field<M>& out) noexcept {
  Num<M> far = x * x + y * y + z * z + kTiny<Size<M>> * kTiny<Size<M>>;
  M::square_root(far);
  const auto apart = far > kNothing<Size<M>>;
  out.x = M::choose(apart, x / far, Num<M>{} + static_cast<Size<M>>(1));
  out.y = M::choose(apart, y / far, Num<M>{});
  out.z = M::choose(apart, z / far, Num<M>{});
  out.phi = far - s.rounding;
}

// One place between the nodes of a grid: linear in each cell. Outside of the lattice, with v the value
// at the nearest place p of its border and D the way from there: sqrt(v^2 + D^2), which is at most the
// true distance, because the body lies in the lattice's box, which is convex.
template <class Real>
[[maybe_unused]] void grid_at(const Sizes<Real>& s, const Real (&at)[3], Real& phi,
                              Real (&gradient)[3]) noexcept {
  const ShapeGrid& g = *s.grid;
  int first[3];
  Real part[3], beyond[3], far = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Real last = static_cast<Real>(g.size[axis] - 1);
    const Real wanted = at[axis] / s.a + static_cast<Real>(0.5) * last;
    Real inside = wanted > 0 ? wanted : 0;  // also where it is not a number
    inside = inside < last ? inside : last;
    first[axis] = static_cast<int>(inside);
    if (first[axis] > g.size[axis] - 2) first[axis] = g.size[axis] - 2;
    part[axis] = inside - static_cast<Real>(first[axis]);
    beyond[axis] = wanted - inside;
    far += beyond[axis] * beyond[axis];
  }
  const int row = g.size[0], slice = row * g.size[1];
  const float* node = g.phi + first[2] * slice + first[1] * row + first[0];
  // along x, then y, then z: values v[z][y], and how much they grow along x
  Real v[2][2], vx[2][2];
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y) {
      const Real low = static_cast<Real>(node[z * slice + y * row]),
                 high = static_cast<Real>(node[z * slice + y * row + 1]);
      vx[z][y] = high - low;
      v[z][y] = low + part[0] * vx[z][y];
    }
  const Real y0 = v[0][1] - v[0][0], y1 = v[1][1] - v[1][0];
  const Real low = v[0][0] + part[1] * y0, high = v[1][0] + part[1] * y1;
  const Real x0 = vx[0][0] + part[1] * (vx[0][1] - vx[0][0]),
             x1 = vx[1][0] + part[1] * (vx[1][1] - vx[1][0]);
  Real value = low + part[2] * (high - low);
  Real grown[3] = {x0 + part[2] * (x1 - x0), y0 + part[2] * (y1 - y0), high - low};
  if (far > 0) {
    Real all = value * value + far;
    all = std::sqrt(all);
    for (int axis = 0; axis < 3; ++axis)
      grown[axis] = beyond[axis] > 0 || beyond[axis] < 0 ? beyond[axis] : value * grown[axis];
    value = all;
  }
  Real length = grown[0] * grown[0] + grown[1] * grown[1] + grown[2] * grown[2];
  length = std::sqrt(length);
  const bool known = length > static_cast<Real>(1e-6);
  for (int axis = 0; axis < 3; ++axis) gradient[axis] = known ? grown[axis] / length : Real{};
  if (!known) gradient[0] = 1;
  phi = value * s.a;
}

// Many places at once: the operations of grid_at(), in the same order, so that the results are the same bits.
template <class M>
[[maybe_unused]] void grid_lanes(const Sizes<Size<M>>& s, const Num<M>& x, const Num<M>& y,
                                 const Num<M>& z, Field<M>& out) noexcept {
  constexpr int kLanes = static_cast<int>(sizeof(Num<M>) / sizeof(Size<M>));
  using Whole = typename M::Whole;
  const ShapeGrid& g = *s.grid;
  const int row = g.size[0], slice = row * g.size[1];
  const int stride[3] = {1, row, slice};
  const Num<M> at[3] = {x, y, z}, zero{};
  Num<M> part[3], beyond[3], far{};
  Whole index{};
  for (int axis = 0; axis < 3; ++axis) {
    const Num<M> last = zero + static_cast<Size<M>>(g.size[axis] - 1);
    const Num<M> wanted = at[axis] / s.a + static_cast<Size<M>>(0.5) * last;
    Num<M> inside = M::choose(wanted > zero, wanted, zero);  // also where it is not a number
    inside = M::choose(inside < last, inside, last);
    const Whole most = Whole{} + (g.size[axis] - 2);
    Whole first = M::whole(inside);
    first = M::choose(first > most, most, first);
    part[axis] = inside - M::number(first);
    beyond[axis] = wanted - inside;
    far += beyond[axis] * beyond[axis];
    index += first * stride[axis];
  }
  Num<M> v[2][2], vx[2][2];
  for (int nz = 0; nz < 2; ++nz)
    for (int ny = 0; ny < 2; ++ny) {
      Num<M> low{}, high{};
      const float* const node = g.phi + nz * slice + ny * row;
      for (int lane = 0; lane < kLanes; ++lane) {
        low[lane] = static_cast<Size<M>>(node[index[lane]]);
        high[lane] = static_cast<Size<M>>(node[index[lane] + 1]);
      }
      vx[nz][ny] = high - low;
      v[nz][ny] = low + part[0] * vx[nz][ny];
    }
  const Num<M> y0 = v[0][1] - v[0][0], y1 = v[1][1] - v[1][0];
  const Num<M> low = v[0][0] + part[1] * y0, high = v[1][0] + part[1] * y1;
  const Num<M> x0 = vx[0][0] + part[1] * (vx[0][1] - vx[0][0]),
               x1 = vx[1][0] + part[1] * (vx[1][1] - vx[1][0]);
  Num<M> value = low + part[2] * (high - low);
  Num<M> grown[3] = {x0 + part[2] * (x1 - x0), y0 + part[2] * (y1 - y0), high - low};
  const Whole outside = far > zero;
  Num<M> all = value * value + far;
  M::square_root(all);
  for (int axis = 0; axis < 3; ++axis) {
    const Num<M> away = M::choose(beyond[axis] != zero, beyond[axis], value * grown[axis]);
    grown[axis] = M::choose(outside, away, grown[axis]);
  }
  value = M::choose(outside, all, value);
  Num<M> length = grown[0] * grown[0] + grown[1] * grown[1] + grown[2] * grown[2];
  M::square_root(length);
  const Whole known = length > static_cast<Size<M>>(1e-6);
  out.x = M::choose(known, grown[0] / length, zero + static_cast<Size<M>>(1));
  out.y = M::choose(known, grown[1] / length, zero);
  out.z = M::choose(known, grown[2] / length, zero);
  out.phi = value * s.a;
}

template <class M>
[[maybe_unused]] void grid_field(const Sizes<Size<M>>& s, const Num<M>& x, const Num<M>& y,
                                 const Num<M>& z, Field<M>& out) noexcept {
  if constexpr (sizeof(Num<M>) == sizeof(Size<M>)) {
    const Size<M> at[3] = {x, y, z};
    Size<M> phi, gradient[3];
    grid_at(s, at, phi, gradient);
    out.phi = phi;
    out.x = gradient[0];
    out.y = gradient[1];
    out.z = gradient[2];
  } else {
    grid_lanes<M>(s, x, y, z, out);
  }
}

template <class M>
[[maybe_unused]] void field_of(ShapeKind kind, const Sizes<Size<M>>& s, const Num<M>& x,
                               const Num<M>& y, const Num<M>& z, Field<M>& out) noexcept {
  if (kind == ShapeKind::ball) {
    ball_field<M>(s, x, y, z, out);
    return;
  }
  if (kind == ShapeKind::grid) {
    grid_field<M>(s, x, y, z, out);
    return;
  }
  const Num<M> zero{}, one = zero + static_cast<Size<M>>(1);
  Profile<M> profile;
  if (kind == ShapeKind::box || kind == ShapeKind::wedge) {
    const Num<M> side = M::choose(x < zero, -one, one);
    if (kind == ShapeKind::box)
      rectangle<M>(s.a, s.c, x * side, z, profile);
    else
      slanted<M>(s, {0, 0, s.c, s.a, 0, 0}, x * side, z, profile);
    extrude<M>(profile, side, s.b, y, out);
    out.phi -= s.rounding;
    return;
  }
  Num<M> r;
  length_of<M>(x, y, r);
  if (kind == ShapeKind::capsule) capsule<M>(s, r, z, profile);
  if (kind == ShapeKind::cylinder) rectangle<M>(s.a, s.c, r, z, profile);
  if (kind == ShapeKind::frustum) slanted<M>(s, {s.a, -s.c, s.c, s.b, -s.c, s.a}, r, z, profile);
  if (kind == ShapeKind::vesica) vesica<M>(s, r, z, profile);
  if (kind == ShapeKind::half_shell)
    half_shell<M>(s, std::sqrt((s.a - s.b) * (s.a + s.b)), r, z, profile);
  if (kind == ShapeKind::tube) tube<M>(s, r, z, profile);
  const auto off_axis = r > kNothing<Size<M>>;
  const Num<M> cosine = M::choose(off_axis, x / r, one), sine = M::choose(off_axis, y / r, zero);
  out.phi = profile.d - s.rounding;
  out.x = profile.r * cosine;
  out.y = profile.r * sine;
  out.z = profile.z;
}

}  // namespace
}  // namespace burr::tool
