// What Linux grants a thread. rt/thread_rights_windows.cpp is the one for Windows; in a browser
// there are no threads.
#include "burr/rt/thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

namespace burr::rt {
namespace {

std::string reason(int code) { return std::generic_category().message(code); }

// Keeps touched pages in RAM. ONFAULT: untouched pages are not loaded. If there is a limit and no
// right to exceed it, locking future memory would make later allocations fail: then it is not done.
bool lock_memory(std::string& why) {
  rlimit limit = {};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (geteuid() != 0 && limit.rlim_cur != RLIM_INFINITY) {
    why = "the limit on locked memory is not \"unlimited\"";
    return false;
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return true;
  why = reason(errno);
  return false;
}

}  // namespace

const std::size_t Thread::kMostStack = 4 * 1024 * 1024;

ThreadGrant Thread::ask_for(const ThreadRequest& request) {
  pthread_setname_np(pthread_self(), request.name.substr(0, 15).c_str());
  ThreadGrant grant;
  std::string missing;
  const auto miss = [&missing](const std::string& text) {
    if (!missing.empty()) missing += "; ";
    missing += text;
  };

  if (request.core >= 0) {
    int code = EINVAL;
    if (request.core < CPU_SETSIZE) {
      cpu_set_t cores;
      CPU_ZERO(&cores);
      CPU_SET(static_cast<unsigned>(request.core), &cores);
      code = pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
    }
    grant.pinned = code == 0;
    if (code != 0) miss("not kept on core " + std::to_string(request.core) + ": " + reason(code));
  }
  if (request.realtime) {
    sched_param param = {};
    param.sched_priority = std::clamp(request.priority, 1, 99);
    const int code = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
    grant.fifo = code == 0;
    if (code != 0) miss("ordinary priority instead of SCHED_FIFO: " + reason(code));
    std::string why;
    grant.locked = lock_memory(why);
    if (!grant.locked) miss("memory not locked: " + why);
  }

  grant.sentence = request.name + ": ";
  if (missing.empty()) {
    grant.sentence += !request.realtime
                          ? std::string("ordinary thread")
                          : "SCHED_FIFO " + std::to_string(request.priority) + ", memory locked";
    if (grant.pinned) grant.sentence += ", core " + std::to_string(request.core);
  } else {
    grant.sentence += missing;
    if (request.realtime)
      grant.sentence +=
          " (ticks may come late; docs/understand/realtime.md says how to allow it for your user)";
  }
  return grant;
}

NormalPriority::NormalPriority() {
  int policy = SCHED_OTHER;
  sched_param param = {};
  if (pthread_getschedparam(pthread_self(), &policy, &param) != 0 || policy != SCHED_FIFO) return;
  const sched_param none = {};
  if (pthread_setschedparam(pthread_self(), SCHED_OTHER, &none) == 0)
    priority_ = param.sched_priority;
}

NormalPriority::~NormalPriority() {
  if (priority_ == 0) return;
  sched_param param = {};
  param.sched_priority = priority_;
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &param));
}

bool has_realtime_priority() {
  int policy = SCHED_OTHER;
  sched_param param = {};
  return pthread_getschedparam(pthread_self(), &policy, &param) == 0 && policy == SCHED_FIFO;
}

}  // namespace burr::rt
