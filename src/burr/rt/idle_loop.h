// rt/idle_loop.h - a loop that does nothing but be on time: how late this machine wakes a thread,
// whatever the tick does.
//
//     IdleLoop idle(1000, {.name = "idle", .realtime = true});
//     ...                                           // the sessions to compare with
//     const TickSummary waited = idle.stop();   // lateness and missed periods; work: next to 0
//
// Thread: construct and stop on one thread; the loop runs on its own.
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

  // Ends it; what it saw. Again: the same.
  [[nodiscard]] TickSummary stop();
  [[nodiscard]] const ThreadGrant& grant() const { return thread_.grant(); }

 private:
  std::atomic<bool> stop_ = false;
  TickStats stats_;  // the loop's own until it is joined
  Thread thread_;
};

}  // namespace burr::rt
