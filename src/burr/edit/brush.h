// edit/brush.h - what the burr does to bone besides cutting and adding: back to the original.
//
//     restore   every voxel within reach goes towards what it was when the session began, at most
//               kSpeed of surface, and ends there exactly, tissue and all
//
// Bone that comes back keeps out of the burr but for half a voxel, by which it pushes the burr up
// and out, so that a hole fills under a burr that is held against its floor. Both ways count in the
// ledger: what grows as added, what goes as removed.
//
// Thread: servo. Frame: p_grid [voxel]. Memory: none after construction. Cost: kMostBricks bricks a
// tick; more of them take turns, and each then goes as far as it would have gone meanwhile.
#pragma once

#include <cstdint>

#include "burr/edit/carve.h"
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
  int turns = 1;        // at least so many; a power of two
};

class Brush {
 public:
  static constexpr double kSpeed = 2e-3;  // of the surface, at full pedal                 [m/s]
  static constexpr double kReach = 6;     // of restore beyond the burr's surface        [voxel]
  static constexpr double kInto = 0.5;    // bone may come back so far into the burr     [voxel]
  static constexpr int kMostBricks = 48;

  Brush(volume::Bone& bone, const UndoStore& undo, Carver& carver)
      : bone_(bone), undo_(undo), carver_(carver) {}

  // Adds to `flags` (haptics/contact.h bits: reserve, undo full, put off).
  void restore(const Brushing& now, std::uint32_t& flags) BURR_RT;

  // Bricks worked on in the last tick.
  [[nodiscard]] int bricks_last() const BURR_RT { return worked_; }

 private:
  // Which bricks a ball reaches.
  struct Box {
    math::Ijk lo, hi;
  };
  [[nodiscard]] Box box_of(const math::Vec3& centre, double reach) const BURR_RT;
  void begin(int least_turns, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] bool is_turn_of(int bi, int bj, int bk) const BURR_RT;
  [[nodiscard]] int units_a_tick(const Brushing& now) const BURR_RT;

  volume::Bone& bone_;
  const UndoStore& undo_;
  Carver& carver_;
  int found_ = 0;             // bricks that wanted something in the last tick
  int worked_ = 0;            // of them worked on
  int turns_ = 1, turn_ = 0;  // this many; the present one
};

}  // namespace burr::edit
