// edit/changed_queue.h - bricks that changed and have not been recorded yet, each once, oldest
// first.
//
// Thread: servo. Memory: 5 B a brick of the grid, at construction.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

class ChangedQueue {
 public:
  explicit ChangedQueue(const volume::Bone& bone)
      : ring_(static_cast<std::size_t>(bone.brick_count()) + 1),
        waiting_(static_cast<std::size_t>(bone.brick_count())) {}

  void push(volume::BrickIndex brick) BURR_RT {
    std::uint8_t& waits = waiting_[static_cast<std::size_t>(brick)];
    if (waits != 0) return;
    waits = 1;
    ring_[head_] = brick;
    head_ = head_ + 1 == ring_.size() ? 0 : head_ + 1;
    ++size_;
  }

  // kNoBrick: the queue is empty
  volume::BrickIndex pop() BURR_RT {
    if (size_ == 0) return volume::kNoBrick;
    const volume::BrickIndex brick = ring_[tail_];
    tail_ = tail_ + 1 == ring_.size() ? 0 : tail_ + 1;
    --size_;
    waiting_[static_cast<std::size_t>(brick)] = 0;
    return brick;
  }

  [[nodiscard]] std::size_t size() const BURR_RT { return size_; }

 private:
  std::vector<volume::BrickIndex> ring_;
  std::vector<std::uint8_t> waiting_;
  std::size_t head_ = 0, tail_ = 0, size_ = 0;
};

}  // namespace burr::edit
