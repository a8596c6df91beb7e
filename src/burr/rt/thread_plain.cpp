// Where there are no threads (a page in a browser): the caller does the work itself, at once, so nothing
// may wait for what another thread does. rt/thread.cpp is the one for Linux.
#include <utility>

#include "burr/rt/thread.h"

namespace burr::rt {

struct Thread::Work {
  ThreadGrant grant;
};

Thread::Thread(const ThreadRequest& request, std::function<void()> work)
    : work_(std::make_unique<Work>()) {
  work_->grant.sentence = request.name + ": done by the caller, because this system has no threads";
  work();
}

Thread::~Thread() = default;

void Thread::join() {  // the work was done before the constructor returned
}

const ThreadGrant& Thread::grant() const { return work_->grant; }

void on_threads(int count, const std::function<void(int)>& work) {
  for (int n = 0; n < count; ++n) work(n);
}

}  // namespace burr::rt
