// surface/enclosed.h - the volume that the mesh of a bone encloses, without making the mesh.
//
// The triangles of mesher.h, cell by cell. Each adds the volume of the tetrahedron over it, seen from
// one point for all (divergence theorem); over a closed shell these sum to what it encloses. Beside
// each triangle lies a voxel that is inside; all triangles of a part, and of the walls of its
// cavities, lie beside voxels of this part. So the volumes of separate parts come from one pass.
//
// Unlike volume/volume_of.h this is no functional of the field's ramp: it is right for walls thinner
// than two voxels too, and it changes with the surface alone.
// Thread: any, while nothing writes. Units: voxels where the name says so, else m^3.
#pragma once

#include <functional>

#include "burr/volume/bone.h"

namespace burr::surface {

// solid: the voxel inside, beside the triangle. voxels: what the triangle adds; may be negative.
using UseTriangle = std::function<void(const math::Ijk& solid, double voxels)>;
void each_triangle_volume(const volume::Bone& bone, const UseTriangle& use);

[[nodiscard]] double enclosed_volume(const volume::Bone& bone);  // [m^3]

}  // namespace burr::surface
