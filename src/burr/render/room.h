// render/room.h - where along a ray a ball has room beside the bone.
//
//     eye ------------------( o )-- x bone       the last place before x at which the ball touches
//                        no triangle
//
// Tests the ball against the scene's triangles, both faces, in full detail; needs no GPU. What a
// clip plane hides counts as bone. Thread: any. Cost: a box test per patch, and the triangles of
// the patches that the ball could touch on its way.
#pragma once

#include <optional>

#include "burr/render/scene.h"

namespace burr::render {

// The distance from the ray's origin of the centre of a ball of this radius, `farthest` or less,
// the largest at which it touches no bone. Nothing: there is no such place between the origin and
// `farthest`. Units: m.
[[nodiscard]] std::optional<double> room_before(const Scene& scene, const Ray& ray, double farthest,
                                                double radius);

}  // namespace burr::render
