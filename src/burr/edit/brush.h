// edit/brush.h - what the burr does to bone besides cutting and adding: back to the original,
// smooth.
//
//     restore   every voxel within reach goes towards what it was when the session began, at most
//               kSpeed of surface, and ends there exactly, tissue and all
//
//     smooth    the surface within the ball that deposits fill moves by its curvature less the mean
//               curvature there, so that hills go, hollows fill and the volume stays
//
// Bone that comes back keeps out of the burr but for half a voxel, by which it pushes the burr up
// and out, so that a hole fills under a burr that is held against its floor. Both ways count in the
// ledger: what grows as added, what goes as removed.
//
// Smoothing looks at the ramp alone: second differences along each axis where both neighbours are
// within it, so a plane has none, not even by the rounding of its ramp, and stays to the byte.
// Where the surface moved towards voxels that were all air or all solid, the ramp is made anew:
// they are pulled to what their inner neighbours foretell, but for a quarter of a voxel, by which a
// curved ramp may differ. Every voxel of a tick is found from the bone before it, so no order
// shows.
//
// With a mirror the same is done around the ball's image (mirror.h), to the bit on bone that is its
// own image: each side by its own surface, its own original and its own mean curvature.
//
// Thread: servo. Frame: p_grid [voxel]. Memory: 0.7 MB, at construction. Cost: kMostBricks bricks a
// tick and side; more of them take slices of time, and each then goes as far as it would have gone
// meanwhile.
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
  math::Vec3 push;      // unit, from burr into the bone, p_grid axes
  double radius = 0;    // of the burr [voxel]
  double strength = 1;  // 0..1, by the pedal
  double dt = 1e-3;     // [s]
  int slices = 1;       // at least so many; a power of two
  Mirror mirror = {};   // the same is done across it
};

class Brush {
 public:
  static constexpr double kSpeed = 2e-3;   // of the surface, at full pedal                 [m/s]
  static constexpr double kReach = 6;      // of restore beyond the burr's surface        [voxel]
  static constexpr double kInto = 0.5;     // bone may come back so far into the burr     [voxel]
  static constexpr double kSpread = 1e-6;  // of smoothing: a ripple of wavelength l fades at
                                           // kSpread (2 pi / l)^2                         [m^2/s]
  static constexpr double kShare = 0.8;    // of the ball that is smoothed, over the burr's radius
  static constexpr int kMostBricks = 48;

  explicit Brush(BoneWriter& writer)
      : writer_(writer), bone_(writer.bone()), undo_(writer.undo()), patches_(2 * kMostBricks) {}

  // Adds to `flags` (rt/flags.h bits: reserve, undo full, put off).
  void restore(const Brushing& now, std::uint32_t& flags) BURR_RT;
  void smooth(const Brushing& now, std::uint32_t& flags) BURR_RT;

  // Bricks worked on in the last tick.
  [[nodiscard]] int bricks_last() const BURR_RT { return worked_; }

 private:
  // Which bricks a ball reaches.
  struct Box {
    math::Ijk lo, hi;
  };
  [[nodiscard]] Box box_of(const math::Vec3& centre, double reach) const BURR_RT;
  // A brick to be worked on in this tick.
  struct Patch {
    volume::BrickIndex brick = volume::kNoBrick;
    unsigned layers = 0;  // of it
    int side = 0;         // 0 the hand's, 1 the image
    // what smoothing found  [field units]
    float flow[volume::kBrickVoxels];    // second difference
    float ramp[volume::kBrickVoxels];    // to make the ramp anew
    float weight[volume::kBrickVoxels];  // 0..1: how much of the brush is here
    KeptBrick content;                   // and what becomes of it
  };
  // Near the surface, in fixed point: the same in whatever order.
  struct Sums {
    std::int64_t flow = 0, weight = 0;
  };
  [[nodiscard]] bool flat_about(int bi, int bj, int bk) const BURR_RT;
  void look_at(Patch& patch, const math::Vec3& centre, double radius, const Half& half,
               Sums& sums) const BURR_RT;
  [[nodiscard]] bool move(Patch& patch, const Half& half, float share, float anew, float mean,
                          float most) const BURR_RT;
  void begin(int least_slices, std::uint32_t& flags) BURR_RT;
  // Takes down the bricks of a side that want something, as `wants` says, and have their slice.
  template <class Wants>
  void find(const Sides& sides, int side, double reach, const Wants& wants) BURR_RT;
  void end_finding(const Mirror& mirror, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] int units_a_tick(const Brushing& now) const BURR_RT;

  BoneWriter& writer_;
  const volume::Bone& bone_;
  const UndoStore& undo_;
  std::vector<Patch> patches_;
  int found_ = 0;               // bricks that wanted something in the last tick
  int worked_ = 0;              // of them worked on
  bool crowded_ = false;        // more of a side than may be
  int slices_ = 1, slice_ = 0;  // this many; the present one
};

}  // namespace burr::edit
