// rt/clock.h - when the next tick is due: in real time, without waiting, or as a test decides.
//
//     for (;;) { const TickTime time = clock.wait();  tick(...);  stats.add_lateness(...); }
//
// Due times lie on a grid: start + n * period. If a tick is so late that the next one is already
// due, it begins at once, and only once: the skipped periods are counted in `missed` and never made
// up for. (A burst of ticks would push the hand with old forces at many times the rate.) Guarantee:
// wait() does not allocate and takes no lock; it blocks until the tick is due. Thread: one, the
// servo's.
#pragma once

#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::rt {

[[nodiscard]] std::int64_t monotonic_ns() BURR_RT;   // CLOCK_MONOTONIC
[[nodiscard]] std::int64_t thread_cpu_ns() BURR_RT;  // CPU time used by the calling thread so far

// When a tick began. Times since the first tick, by this clock.  [ns]
struct TickTime {
  std::int64_t due_ns = 0;         // when it should have begun
  std::int64_t now_ns = 0;         // when it did begin
  std::int64_t late_ns = 0;        // now - due, never negative
  std::int64_t since_last_ns = 0;  // since the previous tick began; one period for the first
  std::int64_t missed = 0;         // whole periods skipped just before this tick
};

class TickClock {
 public:
  TickClock() = default;
  TickClock(const TickClock&) = delete;
  TickClock& operator=(const TickClock&) = delete;
  virtual ~TickClock() = default;

  [[nodiscard]] virtual std::int64_t period_ns() const BURR_RT = 0;

  // Returns when the next tick may begin. The first call starts the clock and returns at once.
  [[nodiscard]] virtual TickTime wait() BURR_RT = 0;
};

// The grid of due times that the clocks below share. Not a clock by itself.
class TickGrid {
 public:
  explicit TickGrid(std::int64_t period_ns) : period_ns_(period_ns) {}

  [[nodiscard]] std::int64_t period_ns() const BURR_RT { return period_ns_; }
  // Due time of the next tick  [ns].
  [[nodiscard]] std::int64_t next_due_ns() const BURR_RT { return due_ns_; }
  // Starts the next tick at now_ns, which must not be before its due time.
  [[nodiscard]] TickTime begin(std::int64_t now_ns) BURR_RT;

 private:
  std::int64_t period_ns_;
  std::int64_t due_ns_ = 0, last_ns_ = -1;
};

// The period in ns, rounded to a whole number; rate_hz > 0.
[[nodiscard]] std::int64_t period_from_rate(double rate_hz) BURR_RT;

// Real time: sleeps on CLOCK_MONOTONIC until an absolute time, so that errors do not add up.
class WallClock final : public TickClock {
 public:
  explicit WallClock(double rate_hz) : grid_(period_from_rate(rate_hz)) {}
  [[nodiscard]] std::int64_t period_ns() const BURR_RT override { return grid_.period_ns(); }
  [[nodiscard]] TickTime wait() BURR_RT override;

 private:
  TickGrid grid_;
  std::int64_t start_ns_ = -1;
};

// Simulated time: every tick begins exactly when it is due, without waiting.
class NoWaitClock final : public TickClock {
 public:
  explicit NoWaitClock(double rate_hz) : grid_(period_from_rate(rate_hz)) {}
  [[nodiscard]] std::int64_t period_ns() const BURR_RT override { return grid_.period_ns(); }
  [[nodiscard]] TickTime wait() BURR_RT override { return grid_.begin(grid_.next_due_ns()); }

 private:
  TickGrid grid_;
};

// For tests: time advances only by pass(), which simulates the duration of a tick's work or of a
// stall.
class VirtualClock final : public TickClock {
 public:
  explicit VirtualClock(double rate_hz) : grid_(period_from_rate(rate_hz)) {}
  void pass(std::int64_t ns) BURR_RT { now_ns_ += ns; }
  [[nodiscard]] std::int64_t now_ns() const BURR_RT { return now_ns_; }
  [[nodiscard]] std::int64_t period_ns() const BURR_RT override { return grid_.period_ns(); }
  [[nodiscard]] TickTime wait() BURR_RT override;

 private:
  TickGrid grid_;
  std::int64_t now_ns_ = 0;
};

}  // namespace burr::rt
