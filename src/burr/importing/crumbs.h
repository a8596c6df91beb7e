// importing/crumbs.h - joins crumbs to the part that they touch over an edge or a corner. Internal to
// importing.
//
// A thin wall or rod that lies across the grid comes apart where its voxels at the level meet over an
// edge or a corner only: bone is joined over faces (parts.h). Its tips and rims are then parts of their
// own. So the voxel between is raised to the level: of those that could join the two, the one with the
// highest value. Two parts that are no crumbs stay apart: two bones that touch are two.
// Thread: any. Units: voxels. The result depends on the order of the voxels alone.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/importing/parts.h"

namespace burr::importing {

inline constexpr std::int64_t kCrumb = 27;  // fewer voxels are a crumb

// level: the lowest stored value that is inside. voxels: of the size of parts, which were found in them.
// Returns how many voxels were raised; then the parts are others.
std::size_t join_crumbs(const Parts& parts, std::int16_t level, std::vector<std::int16_t>& voxels);

}  // namespace burr::importing
