// volume/cut_by_depth.h - takes away of a bone what lies in a shape, or adds material there: the field of a voxel is what its
// depth in the shape leaves, as where a phantom is made from its formula.
//
//     cut_by_depth(bone, [](const Vec3& p) { return radius - (p - middle).norm(); }, progress);
//
// depth: below the shape's border, positive inside [m]; outside never farther than the border is. World (LPS). Thread: the
// writer's. Cost: the bricks that the shape reaches.
#pragma once

#include <functional>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::volume {

using DepthAt = std::function<double(const math::Vec3& p)>;

// Error: interrupted.
[[nodiscard]] Status cut_by_depth(Bone& bone, const DepthAt& depth, Progress& progress);

// What grows from air is of the tissue of added material, as in a session. Error: Trouble::data if the bone has no room for it.
[[nodiscard]] Status fill_by_depth(Bone& bone, const DepthAt& depth);

}  // namespace burr::volume
