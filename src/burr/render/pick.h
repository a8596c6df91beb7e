// render/pick.h - which point of the bone lies under the mouse.
//
// By ray against the scene's triangles, front faces only, nearest first; needs no GPU, and the burr
// is never in the way, nor is what a clip plane hides; its section is not hit. Thread: any. Cost: a
// box test per patch, triangles of those hit.
#pragma once

#include <optional>

#include "burr/render/scene.h"

namespace burr::render {

struct Hit {
  math::Vec3 p = math::Vec3::Zero();  // on the surface                       [m]
  math::Vec3 n = math::Vec3::Zero();  // unit, out of the bone, interpolated from the vertices
  volume::TissueId tissue = 0;
  double distance = 0;  // from the ray's origin                              [m]
};

[[nodiscard]] std::optional<Hit> pick(const Scene& scene, const Ray& ray);

}  // namespace burr::render
