// metrics/piece_fit.h - how a piece of bone sits against the bone beside it: gap, step and contact.
//
//     gap    along the piece's normal, from each point of its surface that faces the other bone to
//            that bone; below 0: they overlap
//     step   at the rim of the cut: how far the outer surfaces of the two lie apart, along their
//            normal. Points whose normal leans to the cut's faces (its edges, which voxels round
//            off) do not count
//
// Faces: other bone lies within kReach along the outward normal, and looks back (its normal is turned
// by more than 120 degrees). Points are the crossings of voxel edges with the surface; each stands for
// the area that makes a plane's area exact in every direction.
//
// Frame: world. Units: SI. Thread: any; both bones at rest. It takes time in proportion to the
// piece's surface and the other bone's surface near it.
#pragma once

#include "burr/volume/bone.h"

namespace burr::metrics {

struct PieceFit {
  static constexpr double kReach = 5e-3;  // no wider gap is one            [m]
  static constexpr double kRim = 1e-3;    // from a facing point: at the rim [m]

  double facing = 0;      // area of the piece that faces the other bone [m^2]
  double contact = 0;     // of it, no more than a voxel away            [m^2]
  double gap = 0;         // mean over the facing area                   [m]
  double gap_most = 0;    // exceeded by 5 % of it                       [m]
  double gap_least = 0;   // undercut by 5 % of it                       [m]
  bool has_step = false;  // the outer surfaces of the two meet
  double step = 0;        // mean, without its sign                      [m]
  double step_most = 0;   // exceeded by 5 %                             [m]
};

// other: the bone without the piece.
[[nodiscard]] PieceFit piece_fit(const volume::Bone& piece, const volume::Bone& other);

}  // namespace burr::metrics
