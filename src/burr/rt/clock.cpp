#include "burr/rt/clock.h"

#include <algorithm>
#include <cmath>

namespace burr::rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

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

TickTime VirtualClock::wait() BURR_RT {
  now_ns_ = std::max(now_ns_, grid_.next_due_ns());
  return grid_.begin(now_ns_);
}

}  // namespace burr::rt
