#include "support/wall_clock.h"

#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>

namespace {

std::atomic<bool> living = false;
std::atomic<std::int64_t> back_ns = 0;
std::atomic<long> times_asked = 0;

[[maybe_unused]] timespec wall_now() {
  timespec t = {};
  ::syscall(SYS_clock_gettime, CLOCK_REALTIME, &t);
  if (!living) return t;
  ++times_asked;
  const std::int64_t ns = std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec - back_ns;
  t.tv_sec = ns / 1'000'000'000;
  t.tv_nsec = ns % 1'000'000'000;
  return t;
}

}  // namespace

#if !defined(BURR_SANITIZED)
// NOLINTBEGIN: these names are glibc's
extern "C" {
int clock_gettime(clockid_t which, timespec* out) noexcept {
  if (which != CLOCK_REALTIME && which != CLOCK_REALTIME_COARSE && which != CLOCK_TAI)
    return static_cast<int>(::syscall(SYS_clock_gettime, which, out));
  *out = wall_now();
  return 0;
}
int gettimeofday(timeval* out, void*) noexcept {
  const timespec t = wall_now();
  out->tv_sec = t.tv_sec;
  out->tv_usec = t.tv_nsec / 1000;
  return 0;
}
time_t time(time_t* out) noexcept {
  const time_t t = wall_now().tv_sec;
  if (out != nullptr) *out = t;
  return t;
}
}
// NOLINTEND
#endif

namespace burr::test {

WallClock::WallClock() {
  back_ns = 0;
  times_asked = 0;
  living = true;
}
WallClock::~WallClock() { living = false; }
void WallClock::set_back(double seconds) { back_ns += static_cast<std::int64_t>(seconds * 1e9); }
long WallClock::asked() { return times_asked; }
bool WallClock::watching() {
#if defined(BURR_SANITIZED)
  return false;
#else
  return true;
#endif
}

}  // namespace burr::test
