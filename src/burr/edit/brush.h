// edit/brush.h - two ways of changing bone besides cutting and adding: restore the original, and
// smooth.
//
//     restore   every voxel within reach moves towards its value at the start of the session; the
//               surface moves at kSpeed at most; it ends there exactly, tissue included
//
//     smooth    the surface within the ball that deposits fill moves by its curvature minus the
//               mean curvature there: hills shrink, hollows fill, the volume stays the same
//
// Restored bone may reach half a voxel into the burr and no further; by that it pushes the burr up
// and out, so that a hole fills under a burr that is held against its floor. Both methods count in
// the ledger: growth as added, loss as removed.
//
// Smoothing uses the ramp alone: second differences along each axis where both neighbours lie
// within the ramp. A plane has none, not even from the rounding of its ramp, so it stays the same
// to the byte. Where the surface moved towards voxels that were all air or all solid, the ramp is
// rebuilt: such voxels are pulled to the value that their inner neighbours predict, except for a
// quarter of a voxel, by which a curved ramp may differ. All voxels of a tick are computed from the
// bone before the tick, so their order has no effect.
//
// With a mirror the same is done around the ball's image (mirror.h), each side with its own
// surface, its own original and its own mean curvature. On symmetric bone both sides are equal to
// the bit.
//
// Thread: servo. Frame: p_grid [voxel]. Memory: 0.7 MB, at construction. Cost: at most kMostBricks
// bricks per tick and side; if there are more, they take slices of time, and each then moves as far
// as it would have moved meanwhile.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/edit/bone_writer.h"
#include "burr/edit/mirror.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

// One tick of brushing.
struct Brushing {
  math::Vec3 centre;    // of the burr, p_grid
  math::Vec3 push;      // unit, from the burr into the bone, p_grid axes
  double radius = 0;    // of the burr [voxel]
  double strength = 1;  // 0..1, set by the pedal
  double dt = 1e-3;     // [s]
  int slices = 1;       // at least this many; a power of two
  Mirror mirror = {};   // the same is done across it
};

class Brush {
 public:
  static constexpr double kSpeed = 2e-3;   // of the surface, at full pedal                 [m/s]
  static constexpr double kReach = 6;      // of restore beyond the burr's surface        [voxel]
  static constexpr double kOverlap = 0.5;  // bone may come back this far into the burr  [voxel]
  static constexpr double kSpread = 1e-6;  // of smoothing: a ripple of wavelength l fades at
                                           // kSpread (2 pi / l)^2                         [m^2/s]
  static constexpr double kShare = 0.8;    // of the ball that is smoothed, over the burr's radius
  static constexpr int kMostBricks = 48;

  explicit Brush(BoneWriter& writer)
      : writer_(writer), bone_(writer.bone()), undo_(writer.undo()), patches_(2 * kMostBricks) {}

  // Adds to `flags` (bits of rt/flags.h: reserve, undo full, put off).
  void restore(const Brushing& now, std::uint32_t& flags) BURR_RT;
  void smooth(const Brushing& now, std::uint32_t& flags) BURR_RT;

  // Bricks worked on in the last tick.
  [[nodiscard]] int bricks_last() const BURR_RT { return worked_; }

 private:
  // The bricks that a ball reaches.
  struct Box {
    math::Ijk lo, hi;
  };
  [[nodiscard]] Box box_of(const math::Vec3& centre, double reach) const BURR_RT;
  // A brick that is worked on in this tick.
  struct Patch {
    volume::BrickIndex brick = volume::kNoBrick;
    unsigned layers = 0;  // of it, across the mirror's axis
    int side = 0;         // 0 the hand's, 1 the image
    // result of smoothing  [field units]
    float flow[volume::kBrickVoxels];    // second difference
    float ramp[volume::kBrickVoxels];    // for rebuilding the ramp
    float weight[volume::kBrickVoxels];  // 0..1: how much of the brush is here
    KeptBrick content;                   // the new content
  };
  // Sums near the surface, in fixed point: the same in any order.
  struct Sums {
    std::int64_t flow = 0, weight = 0;
  };
  [[nodiscard]] bool is_flat_around(int bi, int bj, int bk) const BURR_RT;
  void look_at(Patch& patch, const math::Vec3& centre, double radius, const Half& half,
               Sums& sums) const BURR_RT;
  [[nodiscard]] bool move(Patch& patch, const Half& half, float share, float anew, float mean,
                          float most) const BURR_RT;
  void begin(int least_slices, std::uint32_t& flags) BURR_RT;
  // Collects the bricks of a side that need work (`wants` decides) and whose slice it is.
  template <class Wants>
  void find(const Sides& sides, int side, double reach, const Wants& wants) BURR_RT;
  void end_finding(const Mirror& mirror, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] int units_a_tick(const Brushing& now) const BURR_RT;

  BoneWriter& writer_;
  const volume::Bone& bone_;
  const UndoStore& undo_;
  std::vector<Patch> patches_;
  int found_ = 0;               // bricks that needed work in the last tick
  int worked_ = 0;              // of them worked on
  bool crowded_ = false;        // more bricks on a side than allowed
  int slices_ = 1, slice_ = 0;  // number of slices; the current one
};

}  // namespace burr::edit
