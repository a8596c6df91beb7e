// rt/idle_loop.h - measures how late this computer wakes a thread: a loop without any work, as a
// comparison for the real tick.
//
//     IdleLoop idle(1000, {.name = "idle", .realtime = true});
//     ...                                          // the sessions to compare with
//     const TickSummary waited = idle.stop();      // lateness and missed periods; almost no work
//
// Thread: construct and stop on one thread; the loop runs on a thread of its own.
#pragma once

#include <atomic>

#include "burr/rt/stats.h"
#include "burr/rt/thread.h"

namespace burr::rt {

class IdleLoop {
 public:
  // Starts at once.
  IdleLoop(double rate_hz, const ThreadRequest& request);
  ~IdleLoop() { static_cast<void>(stop()); }
  IdleLoop(const IdleLoop&) = delete;
  IdleLoop& operator=(const IdleLoop&) = delete;

  // Ends the loop and returns what it measured. Further calls return the same.
  [[nodiscard]] TickSummary stop();
  [[nodiscard]] const ThreadGrant& grant() const { return thread_.grant(); }

 private:
  std::atomic<bool> stop_ = false;
  TickStats stats_;  // used only by the loop's thread until that is joined
  Thread thread_;
};

}  // namespace burr::rt
