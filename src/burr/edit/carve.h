// edit/carve.h - removes bone with the burr, or adds material: exactly the volume that the ledger
// owes.
//
//     debt += asked;             share = debt / everything the ball stands in
//     field -= share * excess;   debt -= really removed
//
// Anti-aliased (with the ball's own ramp, not whole voxels), exact in volume (integers),
// independent of order, of tick rate and, to second order, of the voxel size (docs/cutting.md,
// "Carving"; volume by volume_of.h). The ball is moved forward a little along the push and is
// larger than the burr by a small, adaptive margin; without it a burr gets stuck in its own hole.
// Both are lengths of the tool: as a share of a voxel they would cut a coarse bone deeper than a
// fine one (an error of first order in h). Debt that is older than a few ticks is written off as
// "not cut"; otherwise a stalled burr would save it up.
//
// With a mirror the image of the ball takes, in every tick, the same share of the material it
// stands in. On symmetric bone both sides are then equal to the bit; on other bone the image
// approaches the same shape at the same pace. The debt counts the hand's side alone; what the image
// removes is added to both `asked` and `removed`.
//
// Thread: servo, the one writer of the bone. Frame: p_grid [voxel]. Memory: none after
// construction.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/edit/carve_kernel.h"
#include "burr/edit/changed_queue.h"
#include "burr/edit/ledger.h"
#include "burr/edit/mirror.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::edit {

struct CarveSettings {
  // How far the cutting ball reaches ahead along the push, and by how much it is larger than the
  // burr: the effect of its teeth. Lengths of the tool, so that a hole does not depend on the
  // voxel; but never less than a share of a voxel, or the burr gets stuck.
  double advance_m = 50e-6;     // [m]
  double advance_least = 0.25;  // [voxel]
  double margin_m = 10e-6;      // [m]
  double margin_least = 0.05;   // [voxel]
  double margin_most = 0.5;     // while the burr is blocked [voxel]
  double margin_rise = 20;      // while blocked [voxel/s]
  double margin_fall = 2;       // while cutting freely [voxel/s]
  double patience = 5e-3;       // how long a debt may wait, at the present rate of asking [s]
  double deposit_share = 0.8;   // radius of the deposited ball over the burr's [-]
  double deposit_gap = 0.5;     // kept between burr and deposited material [voxel]
};

// One tick of cutting.
struct Cut {
  math::Vec3 centre;              // of the burr, p_grid
  math::Vec3 push;                // unit, from burr into the bone, p_grid axes
  double radius = 0;              // of the burr [voxel]
  double energy = 0;              // to be spent this tick [J] (carve)
  double volume = 0;              // to be put on this tick [m^3] (deposit)
  volume::TissueId material = 1;  // deposit: its tissue
  double dt = 1e-3;               // [s]
  int slices = 1;                 // the bricks are cut in this many ticks, in turn; a power of two
  Mirror mirror = {};             // the same is done across it
};

class Carver {
 public:
  static constexpr int kMostSlices = 64;  // more than the largest burr on the finest voxel needs
  // changed: receives the number of every brick that is written; may be nullptr
  Carver(volume::Bone& bone, volume::IsoVertices& surface, UndoStore& undo, ChangedQueue* changed,
         const CarveSettings& settings);

  // Adds to `flags` (bits of haptics/contact.h: not cut, reserve, undo full, put off).
  void carve(const Cut& cut, std::uint32_t& flags) BURR_RT;
  void deposit(const Cut& cut, std::uint32_t& flags) BURR_RT;
  // The removal of the thesis: every voxel in the ball loses `amount` [field units], whatever
  // volume that is. The volume removed is also counted as asked for.
  void lower(const Cut& cut, double amount, std::uint32_t& flags) BURR_RT;
  // Nothing was touched in this tick: old debt is written off as patience runs out.
  void idle(double dt) BURR_RT;

  // Swaps a brick of the bone with a kept one (undo, redo).
  void swap(KeptBrick& kept) BURR_RT;
  // Puts a kept brick back (reset).
  void restore(const KeptBrick& kept) BURR_RT;
  // Replaces the content of a brick (for brush.h): keeps the old content for undo, marks the brick
  // as changed and counts the volume. flags: as above.
  void rewrite(const KeptBrick& now, std::uint32_t& flags) BURR_RT;
  // True if a ball here would not touch the kept brick's material.
  [[nodiscard]] bool clear_of(const KeptBrick& kept, const math::Vec3& centre,
                              double radius) const BURR_RT;

  [[nodiscard]] Ledger ledger() const BURR_RT;
  [[nodiscard]] double margin() const BURR_RT { return margin_; }  // [voxel]
  // The image's part of the removed and added volume in the ledger.  [m^3]
  [[nodiscard]] double removed_by_image() const BURR_RT {
    return static_cast<double>(image_removed_) * unit_m3_;
  }
  [[nodiscard]] double added_by_image() const BURR_RT {
    return static_cast<double>(image_added_) * unit_m3_;
  }
  // Number of bricks that the burr and its image stood in during the last tick; 0 while idle.
  [[nodiscard]] int bricks_last() const BURR_RT { return static_cast<int>(work_count_); }

 private:
  struct Work {
    volume::BrickIndex brick = volume::kNoBrick;
    Excess excess;
  };
  // Volume that each side removed or added.  [units]
  struct Done {
    std::int64_t hand = 0, image = 0;
  };
  void begin_gathering() BURR_RT;
  void gather(const math::Vec3& centre, double radius, const float keep_out[4], bool deposit,
              int slices, const Half& half, std::uint32_t& flags) BURR_RT;
  void gather_inside(const math::Vec3& centre, double radius, int amount, const Half& half,
                     std::uint32_t& flags) BURR_RT;
  void end_gathering(const Mirror& mirror) BURR_RT;
  [[nodiscard]] int choose_turns(int wanted, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] double excess_of_all_slices() BURR_RT;
  [[nodiscard]] Done apply(double share, bool deposit, volume::TissueId material,
                           std::uint32_t& flags) BURR_RT;
  [[nodiscard]] double mean_energy() const BURR_RT;
  void take_account_of(const Done& removed) BURR_RT;
  void write_off(double asked_units, double dt, int slices) BURR_RT;
  void note_whole(volume::BrickIndex brick, const volume::BrickField& before,
                  const volume::BrickField& now) BURR_RT;

  volume::Bone& bone_;
  volume::IsoVertices& surface_;
  UndoStore& undo_;
  ChangedQueue* changed_;
  CarveSettings settings_;
  CarveKernel kernel_;
  double unit_m3_ = 0;                       // volume of one unit [m^3]
  std::vector<std::uint16_t> highest_;       // (brick_count) largest field value of the brick
  std::vector<std::uint8_t> uniform_;        // (brick_count) its one solid tissue, or 255: mixed
  std::vector<double> energy_of_;            // (256) specific cutting energy by tissue [J/m^3]
  std::vector<volume::BrickField> scratch_;  // excess of the bricks in work_
  std::vector<Work> work_;
  std::size_t work_count_ = 0, hand_count_ = 0;  // the hand's bricks come first
  bool crowded_ = false;                         // more bricks than work_ holds
  int crowd_slices_ = 1;                         // number of slices in which they fit
  int usual_turns_ = 1;                          // number of slices that is worth while
  struct Part {
    std::int64_t units = 0;  // excess of the slice's bricks
    int bricks = 0;
    bool known = false;
  };
  Part parts_[kMostSlices] = {};  // of each slice, from its last turn
  int slices_ = 1, slice_ = 0;    // number of slices; the next one
  std::int64_t total_units_ = 0;

  double asked_ = 0, debt_ = 0, not_cut_ = 0;           // [units]
  std::int64_t removed_ = 0, added_ = 0;                // [units]
  std::int64_t image_removed_ = 0, image_added_ = 0;    // the image's part of these
  double added_debt_ = 0;                               // [units]
  double energy_ = 0;                                   // [J]
  double rate_ = 0;                                     // smoothed rate of asking [units/s]
  double last_energy_density_ = 1e9;                    // [J/m^3]
  double advance_ = 0, least_margin_ = 0, margin_ = 0;  // [voxel]
};

}  // namespace burr::edit
