// tests/support/body.h - a scan of a body as a scanner would give it: a ball of bone in a cylinder of
// soft tissue in air, blurred and with noise, in HU or in any other values.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "burr/io/scan.h"

namespace burr::test {

struct Body {
  double noise = 20;   // [HU]
  double ball_mm = 7;  // radius of the bone
  double bone = 1200, soft = 40, air = -1000;
  math::Ijk size = {56, 56, 44};    // voxels of 0.5 mm
  double cylinder_mm = 11;          // radius of the soft tissue; large: no air in the region
  double slope = 1, intercept = 0;  // stored value = HU * slope + intercept
  bool whole = true;                // round the stored values
};

// Share of a ball or cylinder in a blurred edge at this depth.
inline double edge(double depth_mm) { return 0.5 * (1 + std::erf(depth_mm / (0.5 * M_SQRT2))); }

// In HU, without noise.
inline double hu_at(const Body& body, const math::Vec3& p) {
  const double in_soft = edge(body.cylinder_mm - std::hypot(p.x(), p.y()));
  const double in_bone = edge(body.ball_mm - p.norm());
  return body.air + in_soft * (body.soft - body.air) + in_bone * (body.bone - body.soft);
}

inline io::Scan scan_of(const Body& body) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, body.noise);
  io::Scan scan;
  scan.format = "test";
  scan.size = body.size;
  scan.spacing_mm = {0.5, 0.5, 0.5};
  const math::Vec3 middle = 0.25 * (body.size - math::Ijk::Ones()).cast<double>();
  scan.origin_mm = -middle;
  for (int k = 0; k < body.size.z(); ++k)
    for (int j = 0; j < body.size.y(); ++j)
      for (int i = 0; i < body.size.x(); ++i) {
        const double hu = hu_at(body, 0.5 * math::Vec3(i, j, k) - middle) + noise(random);
        const double value = hu * body.slope + body.intercept;
        scan.values.push_back(static_cast<float>(body.whole ? std::round(value) : value));
      }
  return scan;
}

// Gives all voxels outside a vertical cylinder of this radius one value.
inline void fill_outside(io::Scan& scan, double radius_mm, float value) {
  std::size_t v = 0;
  for (int k = 0; k < scan.size.z(); ++k)
    for (int j = 0; j < scan.size.y(); ++j)
      for (int i = 0; i < scan.size.x(); ++i, ++v) {
        const math::Vec3 p = scan.origin_mm + 0.5 * math::Vec3(i, j, k);
        if (std::hypot(p.x(), p.y()) > radius_mm) scan.values[v] = value;
      }
}

// The volume at or above a level, in whole voxels.
inline double mm3_above(const io::Scan& scan, double level) {
  const auto n = std::count_if(scan.values.begin(), scan.values.end(),
                               [&](float v) { return double{v} >= level && v != scan.outside; });
  return static_cast<double>(n) * scan.spacing_mm.prod();
}

}  // namespace burr::test
