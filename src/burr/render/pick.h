// render/pick.h - the point of the bone under the mouse.
//
// Tests a ray against the scene's triangles, front faces only, nearest first; needs no GPU. The
// burr and what a clip plane hides are not hit, and neither is the flat face of the section.
// Thread: any. Cost: a box test per patch, and the triangles of the patches that are hit.
#pragma once

#include <optional>

#include "burr/render/scene.h"

namespace burr::render {

struct Hit {
  math::Vec3 p = math::Vec3::Zero();  // on the surface [m]
  math::Vec3 n = math::Vec3::Zero();  // unit, out of the bone, interpolated from the vertices
  volume::TissueId tissue = 0;
  double distance = 0;  // from the ray's origin [m]
};

[[nodiscard]] std::optional<Hit> pick(const Scene& scene, const Ray& ray);

}  // namespace burr::render
