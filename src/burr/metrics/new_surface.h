// metrics/new_surface.h - the surface that cutting made, as points with normals and areas.
//
// A point for each edge between two neighbouring voxels that the surface of `after` crosses, where
// the field changed and the point lay at least half a voxel below the surface of `before`. A
// crossing on an edge along axis i stands for the area h^2 |n_i|; the sum over all is the area of
// the surface.
// Frame: world. Units: m. Thread: any; uses one. Memory: the points, 56 bytes each.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct SurfacePoint {
  math::Vec3 place = math::Vec3::Zero();
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone
  double area = 0;                         // [m^2]
};

// In the order of bricks; every edge in the region counts.
[[nodiscard]] std::vector<SurfacePoint> new_surface(const volume::Bone& before,
                                                    const volume::Bone& after,
                                                    const Region& region);

// Fewer points than this do not make a surface.
inline constexpr std::size_t kFewestPoints = 200;

}  // namespace burr::metrics
