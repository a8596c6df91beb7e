// scenes/sculpt.h - what formula-made bones are modelled with: soft unions, tubes along curves, and
// noise that is the same on every machine.
//
// Depth is positive inside, as in shapes.h; everything here changes by no more than the distance
// (Lipschitz 1) unless it says otherwise. Units: metres.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::scenes {

using math::Vec3;

inline constexpr double kMm = 1e-3;  // [m]

// a point given in millimetres
[[nodiscard]] inline Vec3 at_mm(double x, double y, double z) { return Vec3(x, y, z) * kMm; }

// The larger of two depths, rounded over a width: bone flows into bone. Never less than either.
[[nodiscard]] double blend(double a, double b, double width);
// The smaller of two depths, rounded over a width: cuts with broken edges. Never more than either.
[[nodiscard]] double carve_soft(double a, double b, double width);

// Depth in an ellipsoid about `centre`; first-order away from the surface, Lipschitz
// max(radius)/min(radius).
[[nodiscard]] double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radius);

// Depth in the hull of two balls: a bone that tapers. Exact.
struct RoundCone {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius_a = 0, radius_b = 0;
  [[nodiscard]] double depth(const Vec3& p) const;
};

// A smooth curve through points (Catmull-Rom): nerves, vessels, canals.
class Curve {
 public:
  // exact_within: how near the exact distance is needed [m]
  Curve(const std::vector<Vec3>& through, double exact_within, int steps = 6);

  // Distance to the curve; from farther than exact_within a lower bound.
  [[nodiscard]] double distance(const Vec3& p) const;

 private:
  // a few pieces in a row and the ball that holds them, to skip them when they are far
  struct Stretch {
    std::size_t first = 0, last = 0;  // points
    Vec3 centre = Vec3::Zero();
    double reach = 0;
  };
  std::vector<Vec3> points_;
  std::vector<Stretch> stretches_;
  double exact_within_ = 0;
};

// Distance to a circle (a semicircular canal). Exact.
struct Circle {
  Vec3 centre = Vec3::Zero(), axis = Vec3::UnitZ();
  double radius = 0;
  [[nodiscard]] double distance(const Vec3& p) const;
};

// Smooth noise, -1 .. 1, one bump every `wavelength`; slope at most 4 / wavelength.
[[nodiscard]] double noise(const Vec3& p, double wavelength, std::uint32_t seed);

// Foam: space parted into cells of about `spacing`, as mastoid air cells or coarse trabeculae are.
// Depth towards the middle of the cell, zero on the walls' mid-surfaces; `open` 0..1 is the share
// of walls that are missing, so that cells communicate.
[[nodiscard]] double foam(const Vec3& p, double spacing, double open, std::uint32_t seed);

}  // namespace burr::scenes
