// Where no thread can go first (a browser). rt/thread.cpp is the one for Linux.
#include <thread>
#include <utility>
#include <vector>

#include "burr/rt/thread.h"

namespace burr::rt {

struct Thread::Work {
  ThreadGrant grant;
  std::thread thread;
};

Thread::Thread(const ThreadRequest& request, std::function<void()> work)
    : work_(std::make_unique<Work>()) {
  work_->grant.sentence =
      request.name + ": ordinary thread, because this system has no real-time threads";
  work_->thread = std::thread(std::move(work));
}

Thread::~Thread() { join(); }

void Thread::join() {
  if (work_->thread.joinable()) work_->thread.join();
}

const ThreadGrant& Thread::grant() const { return work_->grant; }

void on_threads(int count, const std::function<void(int)>& work) {
  std::vector<std::thread> others;
  for (int n = 1; n < count; ++n) others.emplace_back([&work, n] { work(n); });
  work(0);
  for (std::thread& other : others) other.join();
}

NormalPriority::NormalPriority() = default;
NormalPriority::~NormalPriority() {  // there is nothing to give back
}

bool has_realtime_priority() { return false; }

}  // namespace burr::rt
