#include "burr/rt/stats.h"

#include <algorithm>
#include <cmath>

namespace burr::rt {

// The leading 1 + kBits bits of the value, and by how much they were shifted; 0..127 have a bucket
// each.
std::size_t Durations::bucket(std::uint64_t ns) BURR_RT {
  ns = std::min(ns, (std::uint64_t{1} << kLargest) - 1);
  const int shift = std::max(0, static_cast<int>(std::bit_width(ns)) - (kBits + 1));
  return (static_cast<std::size_t>(shift) << kBits) + static_cast<std::size_t>(ns >> shift);
}

double Durations::middle_ns(std::size_t bucket) BURR_RT {
  if (bucket < (std::size_t{2} << kBits)) return static_cast<double>(bucket);
  const std::size_t shift = (bucket >> kBits) - 1;
  const std::size_t lead = bucket - (shift << kBits);
  const double width = std::ldexp(1.0, static_cast<int>(shift));
  return static_cast<double>(lead) * width + 0.5 * (width - 1);
}

void Durations::add(std::int64_t ns) BURR_RT {
  const auto held = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
  ++count_[bucket(held)];
  ++all_;
  sum_ns_ += held;
  max_ns_ = std::max(max_ns_, held);
}

double Durations::quantile_us(double q) const BURR_RT {
  if (all_ == 0) return 0;
  const double share = std::clamp(q, 0.0, 1.0) * static_cast<double>(all_);
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(share)));
  std::uint64_t seen = 0;
  for (std::size_t b = 0; b < kBuckets; ++b) {
    seen += count_[b];
    if (seen >= rank) return std::min(middle_ns(b), static_cast<double>(max_ns_)) * 1e-3;
  }
  return max_us();
}

void TickStats::add(std::int64_t took_ns) BURR_RT {
  took_.add(took_ns);
  over_1ms_ += took_ns > 1'000'000 ? 1 : 0;
}

void TickStats::add_lateness(std::int64_t late_ns, std::int64_t period_ns,
                             std::int64_t missed) BURR_RT {
  lateness_.add(late_ns);
  late_ += late_ns > period_ns / 10 ? 1 : 0;
  missed_ += static_cast<std::uint64_t>(std::max<std::int64_t>(missed, 0));
}

TickSummary TickStats::summary() const BURR_RT {
  TickSummary s;
  s.ticks = took_.count();
  s.p50_us = took_.quantile_us(0.5);
  s.p99_us = took_.quantile_us(0.99);
  s.p999_us = took_.quantile_us(0.999);
  s.max_us = took_.max_us();
  s.mean_us = took_.mean_us();
  s.over_1ms = over_1ms_;
  s.late = late_;
  s.missed = missed_;
  s.worst_lateness_us = lateness_.max_us();
  s.late_p50_us = lateness_.quantile_us(0.5);
  s.late_p99_us = lateness_.quantile_us(0.99);
  s.late_p999_us = lateness_.quantile_us(0.999);
  return s;
}

}  // namespace burr::rt
