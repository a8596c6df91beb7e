// edit/undo.h - keeps the old content of bricks: per stroke for undo and redo, and from the start
// of the session for reset.
//
// A brick is copied the first time a stroke touches it. Undo swaps the stroke's bricks with the
// present content, so the same entries serve redo. When the memory is full the oldest stroke is
// dropped, and keep() reports it. The content at the start is never dropped.
//
// Thread: servo; commit_ahead() on any one other. Memory: 1.5 KiB for each brick that was ever
// changed and for each brick that a stroke remembers, taken a little ahead of use; addresses for
// all of them are reserved at construction.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "burr/rt/reserved.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

struct KeptBrick {
  volume::BrickField field;
  volume::TissueId tissue[volume::kBrickVoxels];
  volume::BrickIndex brick = volume::kNoBrick;
};

class UndoStore {
 public:
  // stroke_bricks: how many bricks all remembered strokes may touch in total
  UndoStore(const volume::Bone& bone, std::size_t stroke_bricks);

  // Takes the memory that the next strokes will need. Call it every few milliseconds while the
  // servo cuts, from another thread.
  void commit_ahead();

  // ---- while cutting
  // Drops the strokes that could be redone. removed: of the account, now [units]
  void begin_stroke(std::uint64_t path_mark, std::int64_t removed = 0) BURR_RT;
  // moved: lost by a piece that this stroke moved [units]
  void end_stroke(std::int64_t removed = 0, std::int64_t moved = 0) BURR_RT;
  [[nodiscard]] bool stroke_open() const BURR_RT { return open_; }
  // Call before a brick is written. True: an older stroke was dropped, or this stroke itself is too
  // large.
  bool keep(volume::BrickIndex brick) BURR_RT;

  // A brick as it is now; zeros for a brick of air.
  static void copy(const volume::Bone& bone, volume::BrickIndex brick, KeptBrick& to) BURR_RT;

  // Bricks that all remembered strokes may touch together.
  [[nodiscard]] std::size_t room() const BURR_RT { return entries_.size(); }

  // ---- undo and redo: entries of the stroke, which the caller must swap
  struct Range {
    std::uint64_t first = 0, count = 0;  // entry numbers; entry(i) for i in [first, first + count)
    std::uint64_t path_mark = 0;
    std::int64_t removed = 0;  // by the stroke [units]
    std::int64_t moved = 0;    // lost by the piece that it moved [units]
  };
  [[nodiscard]] bool can_undo() const BURR_RT { return !open_ && done_ > oldest_; }
  [[nodiscard]] bool can_redo() const BURR_RT { return !open_ && done_ < newest_; }
  [[nodiscard]] Range undo() BURR_RT;  // the last stroke; redo() then returns it first
  [[nodiscard]] Range redo() BURR_RT;
  // Nothing can be redone any more.
  void forget_undone() BURR_RT;
  [[nodiscard]] const KeptBrick& entry(std::uint64_t number) const BURR_RT {
    return entries_[number % entries_.size()];
  }
  [[nodiscard]] KeptBrick& entry(std::uint64_t number) BURR_RT {
    return entries_[number % entries_.size()];
  }

  // ---- content at the start of the session
  [[nodiscard]] std::size_t touched() const BURR_RT {
    return originals_used_;
  }  // bricks ever changed
  [[nodiscard]] const KeptBrick& original(std::size_t number) const BURR_RT {
    return originals_[number];
  }
  // nullptr: the brick was never changed
  [[nodiscard]] const KeptBrick* original_of(volume::BrickIndex brick) const BURR_RT;
  void forget_strokes() BURR_RT;

 private:
  struct Stroke {
    std::uint64_t first = 0, count = 0, path_mark = 0;
    std::int64_t removed_before = 0, removed = 0, moved = 0;  // [units]
  };
  [[nodiscard]] Stroke& stroke(std::uint64_t number) BURR_RT {
    return strokes_[number % strokes_.size()];
  }

  const volume::Bone& bone_;
  rt::ReservedArray<KeptBrick> entries_;  // a ring
  std::uint64_t next_entry_ = 0;
  std::vector<Stroke> strokes_;  // a ring
  std::uint64_t oldest_ = 0, done_ = 0,
                newest_ = 0;  // strokes [oldest, done) can be undone, [done, newest) redone
  std::uint64_t serial_ = 0;  // of the open stroke; never reused
  bool open_ = false, overflowed_ = false;
  std::vector<std::uint64_t> kept_in_;  // (brick_count) serial of the stroke that kept it last
  rt::ReservedArray<KeptBrick> originals_;
  std::size_t originals_used_ = 0;
  std::vector<std::int32_t> original_at_;  // (brick_count) -1: never changed

  // how much memory is used, for commit_ahead()
  std::atomic<std::uint64_t> entries_published_ = 0, originals_published_ = 0;
};

}  // namespace burr::edit
