// What Windows grants a thread. rt/thread_rights.cpp is the one for Linux.
#include "burr/rt/thread.h"

#include <pthread.h>
#include <windows.h>
// after windows.h, which it needs
#include <psapi.h>

#include <string>
#include <system_error>

namespace burr::rt {
namespace {

// What the program may touch after it has asked, and still keep.
constexpr std::size_t kRoom = 256 * 1024 * 1024;

std::string reason(DWORD code) { return std::system_category().message(static_cast<int>(code)); }

// Keeps touched pages in RAM: raises the lower limit of the program's working set, which needs a right that every user has
// by default. Windows takes no page away below that limit if the limit is hard. VirtualLock would load pages that nobody
// has used.
bool lock_memory(std::string& why) {
  const HANDLE self = GetCurrentProcess();
  PROCESS_MEMORY_COUNTERS now = {};
  now.cb = sizeof now;
  if (GetProcessMemoryInfo(self, &now, sizeof now) == 0) {
    why = reason(GetLastError());
    return false;
  }
  const SIZE_T least = now.WorkingSetSize + kRoom;
  constexpr DWORD kHard = QUOTA_LIMITS_HARDWS_MIN_ENABLE | QUOTA_LIMITS_HARDWS_MAX_DISABLE;
  if (SetProcessWorkingSetSizeEx(self, least, least + kRoom, kHard) == 0) {
    why = reason(GetLastError());
    return false;
  }
  SIZE_T got = 0, most = 0;
  DWORD flags = 0;
  if (GetProcessWorkingSetSizeEx(self, &got, &most, &flags) != 0 && got >= least &&
      (flags & QUOTA_LIMITS_HARDWS_MIN_ENABLE) != 0)
    return true;
  why = "the system did not raise the lower limit of the working set";  // wine does not
  return false;
}

bool keep_on(int core, std::string& why) {
  constexpr int kCores = 64;  // of a processor group; a thread is in one group
  if (core < kCores) {
    if (SetThreadAffinityMask(GetCurrentThread(), DWORD_PTR{1} << core) != 0) return true;
    why = reason(GetLastError());
  } else {
    why = reason(ERROR_INVALID_PARAMETER);
  }
  return false;
}

bool set_priority(int priority) { return SetThreadPriority(GetCurrentThread(), priority) != 0; }

}  // namespace

const std::size_t Thread::kMostStack = 1024 * 1024;

ThreadGrant Thread::ask_for(const ThreadRequest& request) {
  pthread_setname_np(pthread_self(), request.name.substr(0, 15).c_str());
  ThreadGrant grant;
  std::string missing, why;
  const auto miss = [&missing](const std::string& text) {
    if (!missing.empty()) missing += "; ";
    missing += text;
  };

  if (request.core >= 0) {
    grant.pinned = keep_on(request.core, why);
    if (!grant.pinned) miss("not kept on core " + std::to_string(request.core) + ": " + why);
  }
  if (request.realtime) {
    // Windows has no levels above this one that need no administrator, so request.priority chooses nothing
    grant.fifo = set_priority(THREAD_PRIORITY_TIME_CRITICAL);
    if (!grant.fifo) miss("ordinary priority instead of time-critical: " + reason(GetLastError()));
    grant.locked = lock_memory(why);
    if (!grant.locked) miss("memory not locked: " + why);
  }

  grant.sentence = request.name + ": ";
  if (missing.empty()) {
    grant.sentence +=
        !request.realtime ? "ordinary thread" : "time-critical priority, memory locked";
    if (grant.pinned) grant.sentence += ", core " + std::to_string(request.core);
  } else {
    grant.sentence += missing;
    if (request.realtime) grant.sentence += " (ticks may come late)";
  }
  return grant;
}

NormalPriority::NormalPriority() {
  if (has_realtime_priority() && set_priority(THREAD_PRIORITY_NORMAL))
    priority_ = THREAD_PRIORITY_TIME_CRITICAL;
}

NormalPriority::~NormalPriority() {
  if (priority_ != 0) static_cast<void>(set_priority(priority_));
}

bool has_realtime_priority() {
  return GetThreadPriority(GetCurrentThread()) == THREAD_PRIORITY_TIME_CRITICAL;
}

}  // namespace burr::rt
