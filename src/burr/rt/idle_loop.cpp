#include "burr/rt/idle_loop.h"

#include "burr/rt/clock.h"

namespace burr::rt {

IdleLoop::IdleLoop(double rate_hz, const ThreadRequest& request)
    : thread_(request, [this, rate_hz] {
        WallClock clock(rate_hz);
        while (!stop_.load(std::memory_order_relaxed)) {
          const TickTime time = clock.wait();
          const std::int64_t before = thread_cpu_ns();
          stats_.add_lateness(time.late_ns, clock.period_ns(), time.missed);
          stats_.add(thread_cpu_ns() - before);
        }
      }) {}

TickSummary IdleLoop::stop() {
  stop_ = true;
  thread_.join();
  return stats_.summary();
}

}  // namespace burr::rt
