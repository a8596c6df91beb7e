// edit/bone_writer.h - the one place from which bricks of the bone are written while it is worked
// on.
//
//     every write:  keep the old brick for undo -> write -> queue it for the recorder
//                   -> note the change for the surface -> update the caches and the account
//
// The laws of cutting (carve.h, laws/thesis.h) and the brush compute what a brick becomes; undo,
// redo and reset put old bricks back. All of them write here, so none can forget a step.
//
// Thread: servo, the one writer of the bone. Frame: p_grid [voxel]. Memory: 3 B a brick of the grid
// at construction, none afterwards.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "burr/edit/account.h"
#include "burr/edit/carve_kernel.h"
#include "burr/edit/changed_queue.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::edit {

class BoneWriter {
 public:
  static constexpr std::uint8_t kMixed = 255;

  // What it knows of each brick of the bone; found in the bone, which takes 50 ms in 512^3 voxels.
  struct Known {
    std::vector<std::uint16_t> highest;  // (brick_count) largest field value of the brick
    std::vector<std::uint8_t> uniform;   // (brick_count) its one solid tissue, or kMixed
  };
  // changed: gets every brick that is written; may be nullptr. known: of another writer of this bone
  // that has ended; empty: none.
  BoneWriter(volume::Bone& bone, volume::IsoVertices& surface, UndoStore& undo,
             ChangedQueue* changed, Known known = {});
  // For the next writer of the bone. This one must not write any more.
  [[nodiscard]] Known take_known() { return std::move(known_); }
  // Between ticks: one more queue that gets every brick that is written; nullptr: none.
  void set_watch(ChangedQueue* watch) { watch_ = watch; }

  [[nodiscard]] const volume::Bone& bone() const BURR_RT { return bone_; }
  [[nodiscard]] const UndoStore& undo() const BURR_RT { return undo_; }
  // Largest field value of the brick.
  [[nodiscard]] int highest(volume::BrickIndex brick) const BURR_RT {
    return known_.highest[static_cast<std::size_t>(brick)];
  }
  // Its one tissue, or kMixed.
  [[nodiscard]] std::uint8_t tissue_of(volume::BrickIndex brick) const BURR_RT {
    return known_.uniform[static_cast<std::size_t>(brick)];
  }
  // Volume of one unit of the account [m^3].
  [[nodiscard]] double unit_m3() const BURR_RT { return unit_m3_; }
  [[nodiscard]] Account& account() BURR_RT { return account_; }
  [[nodiscard]] const Account& account() const BURR_RT { return account_; }
  [[nodiscard]] Ledger ledger() const BURR_RT { return account_.ledger(unit_m3_); }

  // How often a brick was written since the start. A copy of the bone that another thread made
  // between two equal readings, begun() after it and done() before it, is the bone after so many
  // writes.
  [[nodiscard]] std::uint64_t writes_begun() const BURR_RT {
    return begun_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::uint64_t writes_done() const BURR_RT {
    return done_.load(std::memory_order_acquire);
  }

  // Makes room for material in a brick of air. False, and kFlagReserve: there is none left.
  [[nodiscard]] bool make_room(volume::BrickIndex brick, std::uint32_t& flags) BURR_RT;

  // The brick after a kernel removed something (applied), or added it as `material`. The account of
  // volumes is the caller's. Adds kFlagUndoFull.
  void write_less(volume::BrickIndex brick, const volume::BrickField& now, const Applied& applied,
                  std::uint32_t& flags) BURR_RT;
  void write_more(volume::BrickIndex brick, const volume::BrickField& now, const Applied& applied,
                  volume::TissueId material, std::uint32_t& flags) BURR_RT;

  // Replaces the content of a brick (brush.h). The old content is kept for undo, and the change is
  // in the account; the removed volume is added to `asked`, too. Adds kFlagReserve and
  // kFlagUndoFull.
  void rewrite(const KeptBrick& now, std::uint32_t& flags) BURR_RT;
  // Puts this content into a brick, with the old one kept for undo. Not in the account. Adds
  // kFlagReserve and kFlagUndoFull.
  void put(const KeptBrick& now, std::uint32_t& flags) BURR_RT;
  // Swaps a brick of the bone with a kept one (undo, redo). Not in the account.
  void swap(KeptBrick& kept) BURR_RT;
  // Puts a kept brick back (reset). Not in the account.
  void restore(const KeptBrick& kept) BURR_RT;

  // Would a ball here be free of the kept brick's material?  centre, radius: p_grid [voxel]
  [[nodiscard]] bool clear_of(const KeptBrick& kept, const math::Vec3& centre,
                              double radius) const BURR_RT;

 private:
  void write(volume::BrickIndex brick, const volume::BrickField& now) BURR_RT;
  void write_applied(volume::BrickIndex brick, const volume::BrickField& now,
                     const Applied& applied) BURR_RT;
  void note_whole(volume::BrickIndex brick, const volume::BrickField& before,
                  const volume::BrickField& now) BURR_RT;

  // Counts a write while it lasts.
  class Count {
   public:
    explicit Count(BoneWriter& writer) BURR_RT : writer_(writer) {
      writer_.begun_.store(writer_.begun_.load(std::memory_order_relaxed) + 1,
                           std::memory_order_relaxed);
      std::atomic_thread_fence(std::memory_order_release);
    }
    ~Count() BURR_RT {
      writer_.done_.store(writer_.begun_.load(std::memory_order_relaxed),
                          std::memory_order_release);
    }
    Count(const Count&) = delete;
    Count& operator=(const Count&) = delete;

   private:
    BoneWriter& writer_;
  };

  volume::Bone& bone_;
  volume::IsoVertices& surface_;
  UndoStore& undo_;
  ChangedQueue* changed_;
  ChangedQueue* watch_ = nullptr;
  std::atomic<std::uint64_t> begun_ = 0, done_ = 0;
  Known known_;
  double unit_m3_;
  Account account_;
};

}  // namespace burr::edit
