// phantom/sculpt.h - tools for modelling bones by formula: soft unions, tubes along curves, and
// noise that is the same on every machine.
//
// Depth is positive inside, as in shapes.h. All functions here have Lipschitz constant 1 (they
// change by no more than the distance) unless their comment says otherwise. Units: metres.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::phantom {

using math::Vec3;

inline constexpr double kMm = 1e-3;  // [m]

// A point given in millimetres.
[[nodiscard]] inline Vec3 at_mm(double x, double y, double z) { return Vec3(x, y, z) * kMm; }

// The larger of two depths, with a transition of `width`: bone flows into bone. Never less than
// either.
[[nodiscard]] inline double blend(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::max(a, b) + overlap * overlap * width / 4;
}
// The smaller of two depths, with a transition of `width`: a cut with rounded edges. Never more
// than either.
[[nodiscard]] inline double carve_soft(double a, double b, double width) {
  return -blend(-a, -b, width);
}

// Depth in an ellipsoid around `centre`; first-order away from the surface, Lipschitz
// max(radius)/min(radius).
[[nodiscard]] double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radius);

// Depth in the convex hull of two balls: a bone that tapers. Exact.
class RoundCone {
 public:
  RoundCone(const Vec3& a, const Vec3& b, double radius_a, double radius_b);
  [[nodiscard]] double depth(const Vec3& p) const;

  // False: depth(p) is certainly less than `level`. Cheaper than depth(p).
  [[nodiscard]] bool may_reach(const Vec3& p, double level) const {
    const double from_middle = reach_ - level;
    return from_middle > 0 && (p - middle_).squaredNorm() < from_middle * from_middle;
  }

 private:
  Vec3 a_, b_, u_ = Vec3::Zero();
  double radius_a_, radius_b_, length_, sin_t_ = 0, cos_t_ = 1;
  Vec3 middle_;
  double reach_;  // radius of a ball around middle_ that holds it, slightly enlarged
};

// The same as blend(depth, cone.depth(p), width) and carve_soft(depth, -cone.depth(p), width), to
// the bit; almost free for a cone that is too far away to matter.
[[nodiscard]] inline double blend(double depth, const RoundCone& cone, const Vec3& p,
                                  double width) {
  return cone.may_reach(p, depth - width) ? blend(depth, cone.depth(p), width) : depth;
}
[[nodiscard]] inline double carve_soft(double depth, const RoundCone& cone, const Vec3& p,
                                       double width) {
  return cone.may_reach(p, -depth - width) ? carve_soft(depth, -cone.depth(p), width) : depth;
}

// A smooth curve through points (Catmull-Rom): nerves, vessels, canals.
class Curve {
 public:
  // exact_within: up to this distance the result is exact [m]
  Curve(const std::vector<Vec3>& through, double exact_within, int steps = 6);

  // Distance to the curve; beyond exact_within a lower bound.
  [[nodiscard]] double distance(const Vec3& p) const;
  // The corners of the line that distance() measures to.
  [[nodiscard]] std::vector<Vec3> points() const;

 private:
  // A few pieces in a row and a ball around them, to skip them when they are far away.
  struct Stretch {
    std::size_t first = 0, end = 0;  // pieces
    Vec3 centre = Vec3::Zero();
    double reach = 0;
  };
  struct Piece {
    Vec3 from = Vec3::Zero(), along = Vec3::Zero();
    double length2 = 0;
  };
  std::vector<Piece> pieces_;
  std::vector<Stretch> stretches_;
  double exact_within_ = 0;
};

// Distance to a circle (a semicircular canal). Exact.
struct Circle {
  Vec3 centre = Vec3::Zero(), axis = Vec3::UnitZ();
  double radius = 0;
  [[nodiscard]] double distance(const Vec3& p) const;
};

// Smooth noise, -1 .. 1, with one bump per `wavelength`; slope at most 4 / wavelength.
[[nodiscard]] double noise(const Vec3& p, double wavelength, std::uint32_t seed);

// Foam: space divided into cells of about `spacing`, like mastoid air cells or coarse trabeculae.
// Returns the depth towards the middle of the cell, zero on the mid-surfaces of the walls. `open`,
// 0..1: share of walls that are missing, so that cells are connected.
[[nodiscard]] double foam(const Vec3& p, double spacing, double open, std::uint32_t seed);

}  // namespace burr::phantom
