// Real time: the parts of rt/clock.h that ask the system. rt/wall_clock_windows.cpp is the one for Windows.
#include <cerrno>
#include <ctime>

#include "burr/rt/clock.h"

namespace burr::rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read_clock(clockid_t which) BURR_RT {
  timespec t = {};
  clock_gettime(which, &t);
  return std::int64_t{t.tv_sec} * kSecond + t.tv_nsec;
}

void sleep_until(std::int64_t monotonic) BURR_RT {
  timespec t = {};
  t.tv_sec = static_cast<std::time_t>(monotonic / kSecond);
  t.tv_nsec = monotonic % kSecond;
  // a signal (Ctrl-C) wakes the thread early; the time is absolute, so just sleep again
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace

std::int64_t monotonic_ns() BURR_RT { return read_clock(CLOCK_MONOTONIC); }
std::int64_t thread_cpu_ns() BURR_RT { return read_clock(CLOCK_THREAD_CPUTIME_ID); }

TickTime WallClock::wait() BURR_RT {
  if (start_ns_ < 0) start_ns_ = monotonic_ns();
  const std::int64_t due = start_ns_ + grid_.next_due_ns();
  if (monotonic_ns() < due) sleep_until(due);
  return grid_.begin(monotonic_ns() - start_ns_);
}

}  // namespace burr::rt
