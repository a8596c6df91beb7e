// scoring/plane_outline.h - where the planes of a planned cut meet the surface of a bone. For use of this room only.
//
// Thread: any, one at a time; the bone at rest. Frame: world. Units: m.
#pragma once

#include <array>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/region.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::scoring {

// Lines a voxel long, of all planes of the region, as far as they border it (where: the same region).
[[nodiscard]] std::vector<std::array<math::Vec3, 2>> outline_of(const scenario::CaseRegion& region,
                                                                const metrics::Region& where,
                                                                const volume::Bone& bone);

}  // namespace burr::scoring
