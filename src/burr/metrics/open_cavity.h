// metrics/open_cavity.h - the air that was opened: what a ball of rho reaches from the place that was cut, through
// air. Cells behind walls, cells with narrow mouths and drill holes narrower than the ball are not in it.
//
// What a surgeon calls exposed is seen from the approach as an area, so lines that find their way through cells or
// along a needle's hole do not count. rho = 0.75 mm: an area of 1.8 mm^2, which the smallest burr of a recess makes (not calibrated).
//
//     C     = voxels whose centre is farther than rho from bone and opaque soft tissue, after the cut
//     O     = the part of C that is connected to removed voxels in C
//     cells = air that was there before the cut, neither near (0.5 mm) to what was removed about O nor wide (a ball of 2 mm)
//     open  = all within rho + h of O without the cells, without the cells
//
// A cell whose mouth was cut open is part of the layer: it is not taken away, and what lies behind it is not exposed. An
// antrum is wide.
//
// h is added because the surface lies between voxels; bone in that rim counts as bone by its solidity.
// Thread: uses `threads` of its own to be made; any number read it. The result does not depend on them. Memory: 20 bytes per voxel of
// the box about what was cut while it is made, one afterwards.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/distance_map.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct OpenCavitySettings {
  double rho = 0.75e-3;                      // radius of the ball                          [m]
  double cells = 0.5e-3;                     // how deep an opened cell counts as open      [m]
  double wide = 2e-3;                        // radius of a ball that fits into no cell     [m]
  double around = 6e-3;                      // of what was cut: farther air is not looked at [m]
  std::vector<volume::TissueId> glass = {};  // soft tissues through which a ball may pass
  int threads = 2;
};

class OpenCavity {
 public:
  // before, after: the same grid.
  OpenCavity(const volume::Bone& before, const volume::Bone& after,
             const OpenCavitySettings& settings);

  // The voxel that is nearest to p_grid is open. Outside of the grid: yes.
  [[nodiscard]] bool has(const math::Vec3& p_grid) const;
  [[nodiscard]] bool empty() const { return open_.empty(); }  // no ball fits into what was cut

 private:
  math::Ijk size_;  // of the grid
  VoxelBox box_;
  std::vector<std::uint8_t> open_;  // (box_)
};

}  // namespace burr::metrics
