// metrics/opened.h - is there a way from the cavity to a place, and how wide is it: the largest ball
// that goes through.
//
//     clearance(p) = distance from p to the nearest bone or opaque soft tissue, also outside the box
//     Old(rho)     = voxels that the centre of a ball of rho reached from outside before the cut
//
// A flood starts at the removed voxels that a look of the cone reaches, and goes on through removed
// voxels and air that are not in Old(rho), where clearance >= rho. Opened: a ball around a flooded
// voxel touches the target. Old(rho) is needed because in a real bone a ball of 1 mm reaches the
// incus through the ear canal before the first cut.
//
// met: a ball of rho passes (1.0 mm for an antrum, 0.75 mm for a recess: not calibrated). value: the
// largest radius found to pass, by bisection above rho if that passes, below it otherwise. Its error
// is three quarters of a voxel, since the ball's centre is a voxel's.
//
// Old(rho) is found once for all radii: for each voxel the width of the widest way from outside to
// it, by the method of the shortest path (Dijkstra 1959) with the narrowest place in the place of a
// sum (Pollack 1960).
// Frame: world. Thread: uses `threads` of its own for the distances; the result does not depend on
// their number. Memory: some 12 bytes per voxel of the box.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

// A label, or a landmark that a case names with a radius.
struct Target {
  const VoxelSet* label = nullptr;
  math::Vec3 centre = math::Vec3::Zero();  // if there is no label [m]
  double radius = 0;                       // [m]
};

struct OpenedSettings {
  std::vector<math::Vec3> towards = {};      // from the bone to the surgeon, at least one
  std::vector<volume::TissueId> glass = {};  // soft tissues through which a ball may pass
  double rho = 1.0e-3;                       // radius that must pass [m]
  double most = 5e-3;                        // larger radii count as this [m]
  std::optional<math::Aabb> box = {};  // world; what lies outside of it is "outside"; none: all
  int threads = 2;
};

struct Opened {
  Mark mark;  // radius [m]
  math::Vec3 touch =
      math::Vec3::Zero();  // where the ball of that radius touches; only if value > 0
};

// Not assessable: the target is not in the box, or voxels coarser than rho / 2.
[[nodiscard]] Assessed<Opened> opened(const volume::Bone& before, const volume::Bone& after,
                                      const Target& target, const OpenedSettings& settings);

}  // namespace burr::metrics
