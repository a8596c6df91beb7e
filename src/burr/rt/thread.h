// rt/thread.h - a thread that the scheduler puts first, where the machine allows it.
//
//     Thread servo({.name = "servo", .realtime = true}, [&] { ... });
//     fmt::print("{}\n", servo.grant().sentence);      // what it got, or what is missing and why
//
// Asking never fails: without the right to it the work runs on an ordinary thread, and the sentence
// names the fallback and the cure. Thread: construct and join on one thread. Memory: taken when
// constructed; the work itself decides what it allocates.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace burr::rt {

struct ThreadRequest {
  std::string name = "servo";            // as `top -H` shows it; at most 15 letters are kept
  bool realtime = false;                 // SCHED_FIFO and locked memory; false: an ordinary thread
  int priority = 80;                     // of SCHED_FIFO, 1..99; under the kernel's own threads
  int core = -1;                         // the one core to stay on; -1: any
  std::size_t stack_bytes = 256 * 1024;  // touched before the work starts, so it never faults then
};

// What was given of what was requested.
struct ThreadGrant {
  bool fifo = false;     // runs under SCHED_FIFO
  bool locked = false;   // memory touched once stays in RAM
  bool pinned = false;   // stays on the requested core
  std::string sentence;  // "servo: SCHED_FIFO 80, memory locked" or what is missing, and the cure
};

class Thread {
 public:
  // Starts at once. work must not throw.
  Thread(const ThreadRequest& request, std::function<void()> work);
  ~Thread();  // joins
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  void join();
  [[nodiscard]] const ThreadGrant& grant() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

// Calls work(0) to work(count - 1), each on a thread of its own, the first on the calling one; all
// have ended when it returns. One or none: no thread is started. work must not throw.
void on_threads(int count, const std::function<void(int)>& work);

// The calling thread, and those it begins, run as ordinary ones while this lives; then it goes
// first again if it did.
class Ordinary {
 public:
  Ordinary();
  ~Ordinary();
  Ordinary(const Ordinary&) = delete;
  Ordinary& operator=(const Ordinary&) = delete;

 private:
  [[maybe_unused]] int priority_ = 0;  // of SCHED_FIFO before; 0: it was ordinary
};

// The calling thread runs under SCHED_FIFO.
[[nodiscard]] bool goes_first();

}  // namespace burr::rt
