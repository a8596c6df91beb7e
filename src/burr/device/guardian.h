// device/guardian.h - a small process that takes the force back when burr dies.
//
//     auto guardian = Guardian::start({"line", kNoCurrent}, tty);    // before the first force
//     ... (*guardian)->beat() at every exchange ...                  // ends: it is dismissed
//
// For devices that hold their last force for as long as nobody says otherwise and have no watchdog
// of their own. It is burr-guard (apps/burr-guard), beside the library: it sees burr's end by a
// line that the kernel cuts, whatever ended it, and a burr that hangs or is stopped by beats that
// stop. Then it says "no force" to the device, again and again for a while; while burr hangs, until
// it beats again. Signals for burr's terminal do not reach it.
//
// Thread: start() and its end on one thread; beat() any, wait-free. Memory: one page shared with
// it.
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
  // words: the device's way, as burr-guard understands it. fd: what it is to write to, or -1. Once
  // this returns it is ready. Error: it cannot be found, or not reach the device.
  [[nodiscard]] static Result<std::unique_ptr<Guardian>> start(std::vector<std::string> words,
                                                               int fd = -1);
  ~Guardian();  // there is nothing to guard any more
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // burr is alive. From the first one on it is missed after kMissed.
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
