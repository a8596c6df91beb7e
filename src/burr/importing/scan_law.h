// importing/scan_law.h - compares a bone with the grey scan that it was made of, by the law that an
// import keeps (docs/understand/bone_of_a_scan.md):
//
//   1. no bone and no ramp where no voxel of the scan reaches the level;
//   2. no bone of the scan lost;
//   3. the parts that an import counts are the parts of the mesh;
//   4. the mesh encloses what marching cubes of the scan at that level encloses.
//
// It looks at every voxel and shares nothing with the making of the bone but the table of cells.
// Units: mm, voxels of the bone. Thread: any. Cost: a few seconds for ten million voxels.
#pragma once

#include <cstdint>

#include "burr/importing/import_summary.h"
#include "burr/io/scan.h"
#include "burr/volume/bone.h"

namespace burr::importing {

struct ScanLaw {
  std::int64_t ghosts = 0;  // voxels of bone with no voxel of the scan at the level within kNear
  std::int64_t ramps = 0;   // voxels with a field and no voxel of the scan at the level within kFar
  std::int64_t lost = 0;  // voxels of the scan at the level with no bone within one along each axis
  double scan_mm3 = 0;    // enclosed by marching cubes of the scan's own values
  double mesh_mm3 = 0;    // enclosed by the bone's mesh
  std::size_t parts = 0;  // of the bone: voxels that are inside and share a face
};

// Distances count in the larger of the scan's and the bone's voxels, along each axis.
inline constexpr double kNear = 2;
// The ramp reaches two voxels from the surface, which lies less than a cell's diagonal from a voxel at
// the level.
inline constexpr double kFar = 4;

// scan: grey, its whole region imported. level: ImportSummary::iso.
[[nodiscard]] ScanLaw scan_law(const io::Scan& scan, const volume::Bone& bone, double level);

}  // namespace burr::importing
