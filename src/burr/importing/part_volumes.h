// importing/part_volumes.h - how much the surface of each part of a bone encloses. Internal to
// importing.
//
// The parts were found in the values that the bone was made of; its field has the same ones
// (settle.h), although a voxel beside the surface may have changed sides.
// Thread: any, before the session.
#pragma once

#include "burr/importing/parts.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// Sets parts.volumes. margin: layers of air that the bone's grid has before the first voxel of parts.
void measure_parts(const volume::Bone& bone, const math::Ijk& margin, Parts& parts);

}  // namespace burr::importing
