#include "burr/rt/thread.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace burr::rt {
namespace {

// Touches the stack pages that the work will use, so that the first tick does not wait for them.
__attribute__((noinline)) void touch_stack(std::size_t bytes) {
  constexpr std::size_t kChunk = 16 * 1024, kPage = 4096;
  volatile unsigned char chunk[kChunk];
  for (std::size_t i = 0; i < kChunk; i += kPage) chunk[i] = 1;
  if (bytes > kChunk) touch_stack(bytes - kChunk);
  static_cast<void>(chunk[0]);  // read after the call: keeps this frame, no tail call
}

}  // namespace

struct Thread::Work {
  std::mutex mutex;
  std::condition_variable asked;
  bool ready = false;
  ThreadGrant grant;
  std::thread thread;
};

Thread::Thread(const ThreadRequest& request, std::function<void()> work)
    : work_(std::make_unique<Work>()) {
  Work& shared = *work_;
  shared.thread = std::thread([&shared, request, work = std::move(work)] {
    ThreadGrant grant = ask_for(request);
    touch_stack(std::min(request.stack_bytes, kMostStack));
    {
      const std::lock_guard lock(shared.mutex);
      shared.grant = std::move(grant);
      shared.ready = true;
    }
    shared.asked.notify_one();
    work();
  });
  std::unique_lock lock(shared.mutex);
  shared.asked.wait(lock, [&shared] { return shared.ready; });
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

}  // namespace burr::rt
