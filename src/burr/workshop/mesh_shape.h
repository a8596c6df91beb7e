// workshop/mesh_shape.h - the meshes of a tool's parts, read for scenario/rack.h.
//
//     scenario::read_rack("mine.toml", workshop::mesh_shape)
//
// Thread: any but the tick.
#pragma once

#include "burr/scenario/rack.h"

namespace burr::workshop {

// The volume of the mesh and that of the shape differ by at most this share.
inline constexpr double kMostVolumeOff = 0.03;

// A mesh file as a shape. Errors: one sentence with the mesh's file.
[[nodiscard]] Result<scenario::MeshShape> mesh_shape(const scenario::MeshWish& wish);

}  // namespace burr::workshop
