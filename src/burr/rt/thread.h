// rt/thread.h - starts a thread with real-time priority where the system allows it.
//
//     Thread servo({.name = "servo", .realtime = true}, [&] { ... });
//     fmt::print("{}\n", servo.grant().sentence);  // what was granted, or what is missing and why
//
// A request never fails: without the right to real-time priority the work runs on an ordinary
// thread, and the sentence says so and how to change it. Thread: construct and join on one thread.
// Memory: allocated at construction; the work itself decides what it allocates.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace burr::rt {

struct ThreadRequest {
  std::string name = "servo";            // as shown by `top -H`; at most 15 characters are kept
  bool realtime = false;                 // SCHED_FIFO and locked memory; false: an ordinary thread
  int priority = 80;                     // of SCHED_FIFO, 1..99; below the kernel's own threads
  int core = -1;                         // the only core to run on; -1: any
  std::size_t stack_bytes = 256 * 1024;  // touched before the work starts: no page faults later
};

// What was granted of the request.
struct ThreadGrant {
  bool fifo = false;     // runs before ordinary threads: SCHED_FIFO; on Windows time-critical
  bool locked = false;   // memory that was touched once stays in RAM
  bool pinned = false;   // runs on the requested core only
  std::string sentence;  // "servo: SCHED_FIFO 80, memory locked", or what is missing and the cure
};

class Thread {
 public:
  // Starts at once. `work` must not throw.
  Thread(const ThreadRequest& request, std::function<void()> work);
  ~Thread();  // joins
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  void join();
  [[nodiscard]] const ThreadGrant& grant() const;

 private:
  // Each system has its own (thread_rights*.cpp). Asks for what the calling thread is to have; never fails.
  static ThreadGrant ask_for(const ThreadRequest& request);
  // At most so much of a stack is touched ahead: half of what a thread gets there, which leaves room for the work.
  static const std::size_t kMostStack;

  struct Work;
  std::unique_ptr<Work> work_;
};

// Calls work(0) .. work(count - 1), each once, on as many threads at the same time; work(0) on the calling one. Returns when
// all have returned.
void on_threads(int count, const std::function<void(int)>& work);

// While this object lives, the calling thread and the threads that it starts have ordinary
// priority. Its destructor restores the real-time priority if the thread had one.
class NormalPriority {
 public:
  NormalPriority();
  ~NormalPriority();
  NormalPriority(const NormalPriority&) = delete;
  NormalPriority& operator=(const NormalPriority&) = delete;

 private:
  [[maybe_unused]] int priority_ = 0;  // of SCHED_FIFO before; 0: it was normal
};

// True if the calling thread runs under SCHED_FIFO (on Windows: time-critical).
[[nodiscard]] bool has_realtime_priority();

}  // namespace burr::rt
