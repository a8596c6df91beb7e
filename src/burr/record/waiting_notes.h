// record/waiting_notes.h - views and events on their way from the main thread to the recorder's
// writing thread. For use of this room only.
//
// The servo never touches it. If the disk is too slow, at most kMost notes wait; more are dropped
// and counted. Thread: put() any but the servo's; take() the writer's; dropped() any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace burr::record {

struct WaitingNote {
  bool view = false;  // a message of /view; otherwise of /course
  std::uint64_t tick = 0;
  std::string json;
};

class WaitingNotes {
 public:
  static constexpr std::size_t kMost = 4096;

  void put(WaitingNote note) {
    const std::lock_guard lock(mutex_);
    if (notes_.size() >= kMost)
      ++dropped_;
    else
      notes_.push_back(std::move(note));
  }
  // In order, those before tick `until`.
  [[nodiscard]] std::vector<WaitingNote> take(std::uint64_t until) {
    const std::lock_guard lock(mutex_);
    std::vector<WaitingNote> taken, later;
    for (WaitingNote& note : notes_) (note.tick < until ? taken : later).push_back(std::move(note));
    notes_ = std::move(later);
    return taken;
  }
  void drop_all() {
    const std::lock_guard lock(mutex_);
    dropped_ += notes_.size();
    notes_.clear();
  }
  [[nodiscard]] std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<WaitingNote> notes_;
  std::uint64_t dropped_ = 0;
};

}  // namespace burr::record
