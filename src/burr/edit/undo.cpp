#include "burr/edit/undo.h"

#include <algorithm>
#include <cstring>

#include "burr/base/check.h"

namespace burr::edit {

using volume::BrickIndex;
using volume::kBrickVoxels;

namespace {

// Bricks: several ticks of the widest burr, and 3 MiB.
constexpr std::uint64_t kAhead = 2048;

}  // namespace

UndoStore::UndoStore(const volume::Bone& bone, std::size_t stroke_bricks)
    : bone_(bone),
      entries_(std::max<std::size_t>(stroke_bricks, 64)),
      strokes_(4096),
      kept_in_(static_cast<std::size_t>(bone.brick_count())),
      originals_(bone.used_slots() + bone.free_slots()),
      original_at_(static_cast<std::size_t>(bone.brick_count()), -1) {
  commit_ahead();
}

void UndoStore::commit_ahead() {
  entries_.commit(static_cast<std::size_t>(entries_published_.load(std::memory_order_relaxed)) +
                  kAhead);
  originals_.commit(static_cast<std::size_t>(originals_published_.load(std::memory_order_relaxed)) +
                    kAhead);
}

void UndoStore::copy(const volume::Bone& bone, BrickIndex brick, KeptBrick& to) BURR_RT {
  to.brick = brick;
  const volume::Field* field = bone.brick_field(brick);
  if (field == nullptr) {
    std::memset(&to.field, 0, sizeof to.field);
    std::memset(to.tissue, 0, sizeof to.tissue);
    return;
  }
  std::memcpy(&to.field, field, sizeof to.field);
  std::memcpy(to.tissue, bone.brick_tissue(brick), sizeof to.tissue);
}

void UndoStore::begin_stroke(std::uint64_t path_mark, std::int64_t removed) BURR_RT {
  forget_undone();
  newest_ = done_ + 1;
  if (newest_ - oldest_ > strokes_.size()) ++oldest_;
  stroke(done_) = {next_entry_, 0, path_mark, removed, 0, 0};
  ++done_;
  ++serial_;
  open_ = true;
  overflowed_ = false;
}

void UndoStore::forget_undone() BURR_RT {
  if (newest_ > done_) next_entry_ = stroke(done_).first;
  newest_ = done_;
}

void UndoStore::end_stroke(std::int64_t removed, std::int64_t moved) BURR_RT {
  if (open_) {
    Stroke& now = stroke(done_ - 1);
    now.removed = removed - now.removed_before;
    now.moved = moved;
  }
  open_ = false;
}

bool UndoStore::keep(BrickIndex brick) BURR_RT {
  BURR_CHECK(open_);
  const auto at = static_cast<std::size_t>(brick);
  if (original_at_[at] < 0) {
    BURR_CHECK(originals_used_ < originals_.size());  // one for every brick that can hold anything
    original_at_[at] = static_cast<std::int32_t>(originals_used_);
    copy(bone_, brick, originals_[originals_used_++]);
    originals_published_.store(originals_used_, std::memory_order_relaxed);
  }
  Stroke& now = stroke(done_ - 1);
  if (kept_in_[at] == serial_ || overflowed_) return overflowed_;
  bool forgot = false;
  while (oldest_ < done_ - 1 && next_entry_ + 1 - stroke(oldest_).first > entries_.size()) {
    ++oldest_;
    forgot = true;
  }
  if (next_entry_ + 1 - now.first >
      entries_.size()) {  // one stroke larger than everything: it cannot be undone
    overflowed_ = true;
    oldest_ = done_;
    return true;
  }
  kept_in_[at] = serial_;
  copy(bone_, brick, entry(next_entry_));
  ++next_entry_;
  entries_published_.store(next_entry_, std::memory_order_relaxed);
  ++now.count;
  return forgot;
}

UndoStore::Range UndoStore::undo() BURR_RT {
  BURR_CHECK(can_undo());
  const Stroke& s = stroke(--done_);
  return {s.first, s.count, s.path_mark, s.removed, s.moved};
}

UndoStore::Range UndoStore::redo() BURR_RT {
  BURR_CHECK(can_redo());
  const Stroke& s = stroke(done_++);
  return {s.first, s.count, s.path_mark, s.removed, s.moved};
}

const KeptBrick* UndoStore::original_of(BrickIndex brick) const BURR_RT {
  const std::int32_t at = original_at_[static_cast<std::size_t>(brick)];
  return at < 0 ? nullptr : &originals_[static_cast<std::size_t>(at)];
}

void UndoStore::forget_strokes() BURR_RT {
  open_ = false;
  oldest_ = done_ = newest_ = newest_ + 1;
}

}  // namespace burr::edit
