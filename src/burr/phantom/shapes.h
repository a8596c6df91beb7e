// phantom/shapes.h - simple shapes with known answers; for tests, benchmarks and samples.
//
// A shape is a function of a world point: its depth below the surface [m], positive inside the
// bone, negative in air - the sign of the field. Distances are exact unless the comment says
// otherwise, because the ground truths of touch depend on them. A shape lies where its comment
// says; placed() moves it anywhere. Thread: any number at once. Memory: none per call.
#pragma once

#include <functional>

#include "burr/math/pose.h"

namespace burr::phantom {

using math::Pose;
using math::Vec3;

using Depth = std::function<double(const Vec3& p)>;  // [m], positive inside

// Bone below a plane: outward . (p - point) <= 0. outward need not be unit.
[[nodiscard]] Depth slab(const Vec3& outward = {0, 0, 1}, const Vec3& point = {0, 0, 0});

[[nodiscard]] Depth ball(double radius, const Vec3& centre = {0, 0, 0});

// Bone everywhere except inside a ball: a cavity.
[[nodiscard]] Depth bowl(double radius, const Vec3& centre = {0, 0, 0});

// Box about the origin; edges and corners sharp.
[[nodiscard]] Depth box(const Vec3& half_extent);

// Cylinder about z, closed by flat ends at +-half_height.
[[nodiscard]] Depth cylinder(double radius, double half_height);

// All points nearer than `radius` to the segment from a to b.
[[nodiscard]] Depth capsule(const Vec3& a, const Vec3& b, double radius);

// Bone with a V cut into it along y: the tip of the V is the origin, it opens towards +z, each wall
// leans half_angle [rad] away from the z axis. 45 degrees gives the 90-degree groove.
[[nodiscard]] Depth groove(double half_angle);

// The bone that would fill that groove: a ridge pointing to -z with its tip at the origin.
[[nodiscard]] Depth wedge(double half_angle);

// Ring about z: circle of radius `ring`, tube of radius `tube`.
[[nodiscard]] Depth torus(double ring, double tube);

// Infinite plate through `point`; `thickness` is measured along its normal.
[[nodiscard]] Depth plate(double thickness, const Vec3& normal = {0, 0, 1},
                          const Vec3& point = {0, 0, 0});

// Two balls at x = +-half_distance. Exact in air and on the surface; where they overlap, inside,
// it is a lower bound.
[[nodiscard]] Depth two_balls(double radius, double half_distance);

// Open porous bone, a gyroid of the given period; fill: 0.2..0.8, the share of bone. The surface is
// exact (the zero of the gyroid), the depth a first-order estimate: Lipschitz kGyroidSteepness.
[[nodiscard]] Depth gyroid(double period, double fill = 0.5);
inline constexpr double kGyroidSteepness = 8;

// ---- combining shapes: surfaces stay exact; depths become lower bounds inside a union and upper
// bounds (in size) in the air of a cut
[[nodiscard]] Depth either(Depth a, Depth b);   // bone of both
[[nodiscard]] Depth common(Depth a, Depth b);   // only where both are bone
[[nodiscard]] Depth without(Depth a, Depth b);  // a with b cut out
[[nodiscard]] Depth placed(Depth shape, const Pose& world_from_shape);

}  // namespace burr::phantom
