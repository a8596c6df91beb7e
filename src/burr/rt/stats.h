// rt/stats.h - how long the ticks took and how late they began: quantiles of millions in 37 KiB.
//
//     stats.add(took_ns);  stats.add_lateness(time.late_ns, period_ns, time.missed);
//     stats.summary().p99_us
//
// A histogram with buckets that grow with the value, 64 per doubling: a quantile is within 0.8 % of
// the true one (half a bucket), and exact below 128 ns. Guarantee: add() is wait-free and allocates
// nothing. Thread: one writer; read on the same thread, or after that thread has ended, or from a
// copy passed through a door. Memory: all of it inside the object.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::rt {

// Summary of the ticks of a session. Without any tick all values are zero.
struct TickSummary {
  std::uint64_t ticks = 0;
  double p50_us = 0, p99_us = 0, p999_us = 0;  // nearest rank
  double max_us = 0, mean_us = 0;              // exact
  std::uint64_t over_1ms = 0;                  // ticks that took longer than 1 ms, exact
  std::uint64_t late = 0;        // began more than a tenth of a period after they were due
  std::uint64_t missed = 0;      // periods in which no tick began
  double worst_lateness_us = 0;  // largest lateness of all ticks
  double late_p50_us = 0, late_p99_us = 0, late_p999_us = 0;  // how late ticks began
};

// A histogram of durations.
class Durations {
 public:
  void add(std::int64_t ns) BURR_RT;
  // Nearest rank; 0 if nothing was added  [us].
  [[nodiscard]] double quantile_us(double q) const BURR_RT;
  [[nodiscard]] std::uint64_t count() const BURR_RT { return all_; }
  [[nodiscard]] double max_us() const BURR_RT { return 1e-3 * static_cast<double>(max_ns_); }
  [[nodiscard]] double mean_us() const BURR_RT {
    return all_ == 0 ? 0 : 1e-3 * static_cast<double>(sum_ns_) / static_cast<double>(all_);
  }

 private:
  static constexpr int kBits = 6;      // 2^6 buckets per doubling
  static constexpr int kLargest = 42;  // longer than 2^42 ns = 73 min counts as 73 min
  static constexpr std::size_t kBuckets = std::size_t{kLargest - kBits + 1} << kBits;

  static std::size_t bucket(std::uint64_t ns) BURR_RT;
  static double middle_ns(std::size_t bucket) BURR_RT;

  std::array<std::uint64_t, kBuckets> count_{};
  std::uint64_t all_ = 0, sum_ns_ = 0, max_ns_ = 0;
};

class TickStats {
 public:
  // Adds the duration of one tick. A negative one (a clock that went back) counts as zero.  [ns]
  void add(std::int64_t took_ns) BURR_RT;

  // Adds how late that tick began, and how many periods were skipped before it (see rt/clock.h).
  void add_lateness(std::int64_t late_ns, std::int64_t period_ns, std::int64_t missed) BURR_RT;

  // The duration that the share q (0..1) of the ticks did not exceed; nearest rank.  [us]
  [[nodiscard]] double quantile_us(double q) const BURR_RT { return took_.quantile_us(q); }

  [[nodiscard]] std::uint64_t ticks() const BURR_RT { return took_.count(); }
  [[nodiscard]] TickSummary summary() const BURR_RT;
  void clear() BURR_RT { *this = TickStats(); }

 private:
  Durations took_, lateness_;
  std::uint64_t over_1ms_ = 0, late_ = 0, missed_ = 0;
};

}  // namespace burr::rt
