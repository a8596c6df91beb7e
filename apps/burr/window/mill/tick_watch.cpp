#include "window/mill/tick_watch.h"

#include <algorithm>

#include "burr/rt/flags.h"

namespace burr::app {

void TickWatch::see(const tick::TickRow& row, double rate_hz, Clock::time_point now) {
  stats_.add(static_cast<std::int64_t>(1e3 * static_cast<double>(row.took_us)));
  if ((row.contact.flags & rt::kFlagWatchdog) != 0) lost_at_ = now;

  // number of ticks that should have arrived; two may still be on the way
  if (!first_) first_ = {row.tick, now};
  const double due = std::chrono::duration<double>(now - first_->second).count() * rate_hz;
  const double done = static_cast<double>(row.tick - first_->first);
  const auto missed = static_cast<std::uint64_t>(std::max(0.0, due - done - 2));
  if (missed > missed_ + 3) missed_at_ = now;
  missed_ = std::max(missed_, missed);
}

TickHealth TickWatch::health(bool sheds, Clock::time_point now) const {
  if (now - lost_at_ < std::chrono::seconds(5)) return TickHealth::lost;
  if (sheds || now - missed_at_ < std::chrono::seconds(3)) return TickHealth::busy;
  return TickHealth::good;
}

}  // namespace burr::app
