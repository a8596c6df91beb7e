// edit/reached.h - the bricks that a tool stands in during one tick, and how much of each voxel it
// would take (or put).
//
//     reached.begin();
//     for each side:  reached.begin_side();
//                     for each brick:  out = reached.next();  find(..., out);
//                                      reached.add(brick, excess, half);
//     reached.end(mirror);
//     done = reached.take(share, flags)      or put(share, material, flags)
//
// A law of cutting fills the list and decides the share; the bricks are written by bone_writer.h.
//
// Thread: servo. Frame: p_grid [voxel]. Memory: 2 MiB, at construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/edit/bone_writer.h"
#include "burr/edit/carve_kernel.h"
#include "burr/edit/mirror.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

class Reached {
 public:
  static constexpr std::size_t kMostBricksPerSide = 1024;  // bricks: 7 mm at 0.1 mm takes 400

  // What both sides took or put.  [units]
  struct Done {
    std::int64_t hand = 0, image = 0;
  };

  explicit Reached(BoneWriter& writer);

  // ---- filling the list; the hand's side first
  void begin() BURR_RT {
    count_ = hand_count_ = 0;
    crowded_ = false;
    total_units_ = 0;
  }
  void begin_side() BURR_RT { most_ = count_ + kMostBricksPerSide; }
  // Where the excess of the next brick goes (8 x 8 x 8); nullptr: the side's list is full.
  [[nodiscard]] std::uint16_t* next() BURR_RT {
    if (count_ < most_) return excess_[count_].voxel;
    crowded_ = true;
    return nullptr;
  }
  // Keeps the brick whose excess was written to next().
  void add(volume::BrickIndex brick, const Excess& excess, const Half& half) BURR_RT {
    bricks_[count_++] = {brick, excess};
    if (half.is_image) return;
    total_units_ += excess.units;
    ++hand_count_;
  }
  // Half of what the one side gave and all of the other's would be no mirror image: if a side's
  // list was too short, the list is empty, until there are more slices.
  void end(const Mirror& mirror) BURR_RT {
    if (!mirror.on() || !crowded_) return;
    count_ = hand_count_ = 0;
    total_units_ = 0;
  }

  // ---- the list
  [[nodiscard]] std::size_t count() const BURR_RT { return count_; }
  [[nodiscard]] std::size_t hand_count() const BURR_RT { return hand_count_; }
  [[nodiscard]] bool crowded() const BURR_RT { return crowded_; }
  [[nodiscard]] std::int64_t hand_units() const BURR_RT { return total_units_; }
  // Specific cutting energy of the hand's side, weighted by volume; the last one while nothing is
  // reached.  [J/m^3]
  [[nodiscard]] double mean_energy() BURR_RT;

  // ---- writing: takes (puts) `share` of the excess, 0..1; returns how much that really was
  [[nodiscard]] Done take(double share, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] Done put(double share, volume::TissueId material, std::uint32_t& flags) BURR_RT;

 private:
  struct Brick {
    volume::BrickIndex brick = volume::kNoBrick;
    Excess excess;
  };
  template <class Write>
  Done apply(double share, bool deposit, const Write& write) BURR_RT;

  BoneWriter& writer_;
  CarveKernel kernel_;
  std::vector<double> energy_of_;           // (256) specific cutting energy by tissue [J/m^3]
  std::vector<volume::BrickField> excess_;  // of the bricks in bricks_
  std::vector<Brick> bricks_;
  std::size_t count_ = 0, hand_count_ = 0;  // the hand's come first
  std::size_t most_ = 0;                    // of count_, for this side
  bool crowded_ = false;                    // a side has more bricks than its list holds
  std::int64_t total_units_ = 0;
  double last_energy_ = 1e9;  // [J/m^3]
};

}  // namespace burr::edit
