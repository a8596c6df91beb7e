// edit/carve.h - removes bone with the burr, or adds material: exactly the volume that the ledger
// owes.
//
//     debt += asked;             share = debt / everything the ball stands in
//     field -= share * excess;   debt -= really removed
//
// Anti-aliased (with the ball's own ramp, not whole voxels), exact in volume (integers),
// independent of order, of tick rate and, to second order, of the voxel size
// (docs/understand/cutting.md, "Carving"; volume by volume_of.h). The ball is moved forward a
// little along the push and is larger than the burr by a small, adaptive margin; without it a burr
// gets stuck in its own hole. Both are lengths of the tool: as a share of a voxel they would cut a
// coarse bone deeper than a fine one (an error of first order in h). Debt that is older than a few
// ticks is written off as "not cut"; otherwise a stalled burr would save it up.
//
// With a mirror the image of the ball takes, in every tick, the same share of the material it
// stands in. On symmetric bone both sides are then equal to the bit; on other bone the image
// approaches the same shape at the same pace. The debt counts the hand's side alone; what the image
// removes is added to both `asked` and `removed`.
//
// Thread: servo, the one writer of the bone. Frame: p_grid [voxel]. Memory: none after
// construction.
#pragma once

#include <cstddef>
#include <cstdint>

#include "burr/edit/bone_writer.h"
#include "burr/edit/carve_kernel.h"
#include "burr/edit/carve_settings.h"
#include "burr/edit/ledger.h"
#include "burr/edit/mirror.h"
#include "burr/edit/reached.h"
#include "burr/edit/tool_body.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

// One tick of cutting.
struct Cut {
  math::Vec3 centre;               // of the burr, p_grid
  math::Vec3 push;                 // unit, from burr into the bone, p_grid axes
  double radius = 0;               // of the burr [voxel]
  const ToolBody* body = nullptr;  // carve: cuts in place of the ball, if there is one
  double energy = 0;               // to be spent this tick [J] (carve)
  double volume = 0;               // to be put on this tick [m^3] (deposit)
  volume::TissueId material = 1;   // deposit: its tissue
  double dt = 1e-3;                // [s]
  int slices = 1;                  // the bricks are cut in this many ticks, in turn; a power of two
  Mirror mirror = {};              // the same is done across it
};

class Carver {
 public:
  static constexpr int kMostSlices = 64;  // more than the largest burr on the finest voxel needs
  // which: of the two hands; each owes for itself, and the account has the sum
  Carver(BoneWriter& writer, const CarveSettings& settings, std::size_t which = 0);

  // Adds to `flags` (bits of rt/flags.h: not cut, reserve, undo full, put off).
  void carve(const Cut& cut, std::uint32_t& flags) BURR_RT;
  void deposit(const Cut& cut, std::uint32_t& flags) BURR_RT;
  // Nothing touched this tick: what is still owed is written off as the debt timeout passes.
  void idle(double dt) BURR_RT;

  [[nodiscard]] Ledger ledger() const BURR_RT { return writer_.ledger(); }
  // Units removed since the start.
  [[nodiscard]] std::int64_t removed_units() const BURR_RT { return writer_.account().removed; }
  [[nodiscard]] double margin() const BURR_RT { return margin_; }  // [voxel]
  // The image's part of the removed and added volume in the ledger.  [m^3]
  [[nodiscard]] double removed_by_image() const BURR_RT {
    return static_cast<double>(account_.image_removed) * writer_.unit_m3();
  }
  [[nodiscard]] double added_by_image() const BURR_RT {
    return static_cast<double>(account_.image_added) * writer_.unit_m3();
  }
  // Number of bricks that the burr and its image stood in during the last tick; 0 while idle.
  [[nodiscard]] int bricks_last() const BURR_RT { return static_cast<int>(reached_.count()); }

  // ---- for other ways to carve with the same ball (laws/thesis.h)
  [[nodiscard]] BoneWriter& writer() BURR_RT { return writer_; }
  [[nodiscard]] Reached& reached() BURR_RT { return reached_; }
  [[nodiscard]] double advance() const BURR_RT { return advance_; }            // [voxel]
  [[nodiscard]] double least_margin() const BURR_RT { return least_margin_; }  // [voxel]

 private:
  template <class Body>
  void gather(const Body& body, bool deposit, int slices, const Half& half,
              std::uint32_t& flags) BURR_RT;
  [[nodiscard]] int choose_slices(int wanted, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] double excess_of_all_slices() BURR_RT;
  void write_off(double asked_units, double dt, int slices) BURR_RT;

  BoneWriter& writer_;
  const volume::Bone& bone_;
  Account& account_;  // the writer's
  double& debt_;      // of the account: this carver's
  CarveSettings settings_;
  CarveKernel kernel_;
  ShapeKernel shapes_;
  Reached reached_;
  int crowd_slices_ = 1;      // number of slices in which they fit
  int preferred_slices_ = 1;  // in how many it is worth the while
  struct Part {
    std::int64_t units = 0;  // excess of the slice's bricks
    int bricks = 0;
    bool known = false;
  };
  Part parts_[kMostSlices] = {};  // of each slice, from its last turn
  int slices_ = 1, slice_ = 0;    // number of slices; the next one

  double added_debt_ = 0;                               // [units]
  double rate_ = 0;                                     // smoothed rate of asking [units/s]
  double advance_ = 0, least_margin_ = 0, margin_ = 0;  // [voxel]
};

}  // namespace burr::edit
