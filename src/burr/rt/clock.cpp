#include "burr/rt/clock.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

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

std::int64_t period_from_rate(double rate_hz) BURR_RT {
  return std::max<std::int64_t>(1, std::llround(static_cast<double>(kSecond) / rate_hz));
}

TickTime TickGrid::begin(std::int64_t now_ns) BURR_RT {
  TickTime time;
  time.now_ns = std::max(now_ns, due_ns_);
  // the due time that this tick belongs to: the last one that is not in the future
  time.missed = (time.now_ns - due_ns_) / period_ns_;
  time.due_ns = due_ns_;
  time.late_ns = time.now_ns - due_ns_;
  time.since_last_ns = last_ns_ < 0 ? period_ns_ : time.now_ns - last_ns_;
  due_ns_ += (time.missed + 1) * period_ns_;
  last_ns_ = time.now_ns;
  return time;
}

TickTime WallClock::wait() BURR_RT {
  if (start_ns_ < 0) start_ns_ = monotonic_ns();
  const std::int64_t due = start_ns_ + grid_.next_due_ns();
  if (monotonic_ns() < due) sleep_until(due);
  return grid_.begin(monotonic_ns() - start_ns_);
}

TickTime VirtualClock::wait() BURR_RT {
  now_ns_ = std::max(now_ns_, grid_.next_due_ns());
  return grid_.begin(now_ns_);
}

}  // namespace burr::rt
