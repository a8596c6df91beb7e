// render/focus.h - depth of field: what lies nearer or farther than the plane in focus is drawn
// unsharp, as a lens draws it.
//
// A point at depth z is drawn as a disc. In the plane in focus, at depth z_f, its diameter is
//
//     d = aperture |z - z_f| / z
//
// (a thin lens: Potmesil and Chakravarty, "A lens and aperture camera model", 1981, eq. 1 to 4, seen
// in the space of the object). Units: m. Thread: any.
#pragma once

#include <cmath>

namespace burr::render {

struct Focus {
  double distance = 0.25;  // from the eye to the plane in focus, along the view [m]
  double aperture = 4e-3;  // diameter of the lens [m]
  [[nodiscard]] bool operator==(const Focus&) const = default;
};

// Diameter of the disc, in the plane in focus [m]. depth: of the point, above 0 [m].
[[nodiscard]] inline double unsharp(const Focus& focus, double depth) {
  return focus.aperture * std::abs(depth - focus.distance) / depth;
}

}  // namespace burr::render
