// device/guardian.h - a small process that releases the force of a device when burr dies or hangs.
//
//     auto guardian = Guardian::start({"line", kNoCurrent}, tty);   // before the first force
//     ... (*guardian)->beat() at every exchange ...                 // the destructor ends it
//
// For devices that hold their last force until a new one comes and have no watchdog of their own.
// The process is burr-guard (apps/burr-guard), installed beside the library. It notices the end of
// burr, whatever the cause, because the kernel then closes a pipe; it notices that burr hangs or is
// stopped because the beats stop. In both cases it sends "no force" to the device repeatedly: for a
// while after burr's end, and while burr hangs until the next beat. Signals sent to burr's terminal
// do not reach it.
//
// Thread: start() and the destructor on one thread; beat() any, wait-free. Memory: one page shared
// with the process.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/rt/rt.h"

namespace burr::device {

class Guardian {
 public:
  // words: how to reach the device, in the arguments of burr-guard. fd: the file it writes to, or
  // -1. When this returns, the process is ready. Error: burr-guard is not found, or it cannot reach
  // the device.
  [[nodiscard]] static Result<std::unique_ptr<Guardian>> start(std::vector<std::string> words,
                                                               int fd = -1);
  ~Guardian();  // ends the process: there is nothing to guard any more
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // Says that burr is alive. After the first beat, a pause longer than kMissedMs counts as a hang.
  void beat() BURR_RT { beats_->fetch_add(1, std::memory_order_relaxed); }
  static constexpr int kMissedMs = 100;

  [[nodiscard]] pid_t process() const { return child_; }

 private:
  Guardian(pid_t child, int line, std::atomic<unsigned>* beats)
      : child_(child), line_(line), beats_(beats) {}

  pid_t child_;
  int line_;
  std::atomic<unsigned>* beats_;
};

}  // namespace burr::device
