// Real time on Windows: the parts of rt/clock.h that ask the system. rt/wall_clock.cpp is the one for Linux.
#include <windows.h>

#include "burr/rt/clock.h"

namespace burr::rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
// CREATE_WAITABLE_TIMER_HIGH_RESOLUTION: since Windows 10 of 2018. An ordinary timer keeps to a grid of up to 15.6 ms.
constexpr DWORD kHighResolution = 2;

std::int64_t frequency() {
  LARGE_INTEGER per_second = {};
  QueryPerformanceFrequency(&per_second);  // never fails, and never changes while the computer runs
  return per_second.QuadPart;
}

// A thread's own timer.
class Timer {
 public:
  Timer() : handle_(made(kHighResolution)) {
    if (handle_ == nullptr) handle_ = made(0);
  }
  ~Timer() {
    if (handle_ != nullptr) CloseHandle(handle_);
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  // Waits for about this long. The time given to Windows is relative: its absolute times follow the time of day, which jumps.
  void wait(std::int64_t ns) const BURR_RT {
    LARGE_INTEGER due = {};
    due.QuadPart = -((ns + 99) / 100);  // below zero: from now on; in steps of 100 ns
    if (handle_ == nullptr || SetWaitableTimer(handle_, &due, 0, nullptr, nullptr, FALSE) == 0) {
      Sleep(1);
      return;
    }
    WaitForSingleObject(handle_, INFINITE);
  }

 private:
  static HANDLE made(DWORD flags) {
    return CreateWaitableTimerExW(nullptr, nullptr, flags, TIMER_MODIFY_STATE | SYNCHRONIZE);
  }
  HANDLE handle_;
};

const Timer& own_timer() {
  thread_local const Timer timer;
  return timer;
}

}  // namespace

std::int64_t monotonic_ns() BURR_RT {
  static const std::int64_t per_second = frequency();
  LARGE_INTEGER now = {};
  QueryPerformanceCounter(&now);
  // apart, or the product would not fit after a few minutes
  return now.QuadPart / per_second * kSecond + now.QuadPart % per_second * kSecond / per_second;
}

// Windows adds to this once per tick of its own clock (15.6 ms), so the work of one tick reads as nothing or as too much;
// only sums over a second or more mean something.
std::int64_t thread_cpu_ns() BURR_RT {
  FILETIME begun = {}, ended = {}, kernel = {}, user = {};
  if (GetThreadTimes(GetCurrentThread(), &begun, &ended, &kernel, &user) == 0) return 0;
  const auto ns = [](const FILETIME& time) {
    return 100 * (std::int64_t{time.dwHighDateTime} << 32 | std::int64_t{time.dwLowDateTime});
  };
  return ns(kernel) + ns(user);
}

TickTime WallClock::wait() BURR_RT {
  const Timer& timer = own_timer();  // made by the first call, which waits for nothing
  if (start_ns_ < 0) start_ns_ = monotonic_ns();
  const std::int64_t due = start_ns_ + grid_.next_due_ns();
  // due times lie on the clock's grid, so that what a timer adds is not added up; it may also wake a little early
  for (std::int64_t now = monotonic_ns(); now < due; now = monotonic_ns()) timer.wait(due - now);
  return grid_.begin(monotonic_ns() - start_ns_);
}

}  // namespace burr::rt
