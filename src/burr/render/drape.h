// render/drape.h - what surrounds the opening of an operation: the edges of skin, fat and muscle, the
// cloth beyond them, and two steel blades that hold them apart. For the eye only: it is not cut, not
// felt, and no measure knows it.
//
//     section through the rim            skin  ________ cloth
//                                        ____/|
//                               blade  _|     |   fat
//                      bone ___________||_____|___ muscle
//
// Frame: world (LPS). Units: m. Thread: any; a drape that was made does not change.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/render/camera.h"
#include "burr/render/look.h"

namespace burr::render {

// Where the opening is: a circle of bone, seen from outside.
struct Opening {
  math::Vec3 centre = math::Vec3::Zero();    // near the surface of the bone [m]
  math::Vec3 outward = math::Vec3::UnitZ();  // unit, from the bone to the surgeon
  double radius = 20e-3;                     // nothing of the drape is nearer to the axis [m]
};

struct Drape {
  Opening opening;
  std::vector<math::Vec3f> points, normals;
  std::vector<Colour> colours;  // one for each point
  // soft tissue and cloth first, from `first_steel` on the blades; three to a triangle,
  // counter-clockwise from outside
  std::vector<std::uint16_t> triangles;
  std::size_t first_steel = 0;
  math::Aabb box;
};

// height_at: of the bone's surface over the plane through the centre, towards `outward`, at a point
// given as seen from outside: to the right, up [m]. Nothing: there is no bone. It is called some
// hundred times.
using HeightOfBone = std::function<std::optional<double>(double right, double up)>;
[[nodiscard]] Drape make_drape(const Opening& opening, const HeightOfBone& height_at);

// The directions that make_drape() calls right and up: those of a camera that looks along the axis.
struct DrapeAxes {
  math::Vec3 right, up;
};
[[nodiscard]] DrapeAxes axes_of(const Opening& opening);

// The distance along the ray at which it meets the drape; nothing: it passes.
[[nodiscard]] std::optional<double> hit(const Drape& drape, const Ray& ray);

}  // namespace burr::render
