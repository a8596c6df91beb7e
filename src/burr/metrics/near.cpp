#include "burr/metrics/near.h"

#include <algorithm>
#include <cmath>

namespace burr::metrics {

void Distances::update(const Moment& now) {
  least_ = kFar;
  for (std::size_t n = 0; n < watched_.size(); ++n) {
    d_[n] = watched_[n].distance->at(now.centre).distance - now.tool.radius;
    least_ = std::min(least_, d_[n]);
  }
}

std::size_t bin_of(double d) {
  std::size_t bin = 0;
  while (bin < kBinEnds.size() && d >= kBinEnds[bin]) ++bin;
  return bin;
}

void Histogram::add(double value) {
  const double at = std::clamp(value / step_, 0.0, static_cast<double>(count_.size() - 1));
  ++count_[static_cast<std::size_t>(at)];
  ++all_;
  largest_ = std::max(largest_, value);
}

std::optional<double> Histogram::quantile(double share) const {
  if (all_ == 0) return std::nullopt;
  const double wanted = share * static_cast<double>(all_);
  double seen = 0;
  for (std::size_t n = 0; n + 1 < count_.size(); ++n) {
    const auto here = static_cast<double>(count_[n]);
    if (seen + here >= wanted && here > 0)
      return std::min(largest_, step_ * (static_cast<double>(n) + (wanted - seen) / here));
    seen += here;
  }
  return largest_;
}

void ForceNearMaker::add(const Moment& now, double d) {
  if (!now.touching) return;
  if (now.force > forces_.largest()) peak_at_ = now.t;
  forces_.add(now.force);
  all_.add(now.force, now.dt);
  const std::size_t bin = bin_of(d);
  bins_[bin].add(now.force, now.dt);
  peaks_[bin] = std::max(peaks_[bin], now.force);
}

Assessed<ForceNear> ForceNearMaker::finish() const {
  const auto mean = all_.mean();
  if (!mean) return NotAssessable{"the burr never touched the bone"};
  ForceNear out;
  out.mean = *mean;
  out.p95 = forces_.quantile(0.95).value_or(0);
  out.peak = forces_.largest();
  out.peak_at = peak_at_;
  out.seconds = all_.weight;
  for (std::size_t n = 0; n < kBins; ++n) {
    out.time[n] = bins_[n].weight;
    out.bin_mean[n] = bins_[n].mean();
    out.bin_peak[n] = peaks_[n];
  }
  Running near = bins_[0];
  near.sum += bins_[1].sum;
  near.weight += bins_[1].weight;
  const Running& far = bins_[kBins - 1];
  constexpr double kLeast = 0.5;  // [s]
  if (near.weight >= kLeast && far.weight >= kLeast && far.sum > 0)
    out.restraint = (near.sum / near.weight) / (far.sum / far.weight);
  return out;
}

NearnessMaker::NearnessMaker(const std::vector<Watched>& watched) : past_(watched.size()) {
  for (const Watched& one : watched) {
    found_.emplace_back();
    found_.back().name = one.name;
  }
}

void NearnessMaker::approach(const Moment& now, double d, Past& past, NearnessOf& found) {
  constexpr double kNear = 1e-3, kOver = 50e-3;  // [m], [s]
  if (found.approach) return;
  if (now.gap || std::isinf(d)) past.count = 0;
  if (std::isinf(d)) return;
  if (d < kNear && past.count > 0) {
    // the oldest of the last 50 ms
    std::size_t at = (past.next + kPast - past.count) % kPast;
    while (now.t - past.t[at] > kOver + 0.5 * now.dt && (at + 1) % kPast != past.next)
      at = (at + 1) % kPast;
    if (now.t > past.t[at]) found.approach = (past.d[at] - d) / (now.t - past.t[at]);
  }
  past.d[past.next] = d;
  past.t[past.next] = now.t;
  past.next = (past.next + 1) % kPast;
  past.count = std::min(past.count + 1, kPast);
}

void NearnessMaker::add(const Moment& now, const Distances& distances) {
  for (std::size_t n = 0; n < found_.size(); ++n) {
    const double d = distances.of(n);
    NearnessOf& found = found_[n];
    if (d < found.least) {
      found.least = d;
      found.least_at = now.t;
      found.least_place = now.centre;
    }
    for (std::size_t w = 0; w < kWithin.size(); ++w)
      if (now.cutting() && d < kWithin[w]) found.cutting_within[w] += now.dt;
    approach(now, d, past_[n], found);
  }
}

void BurrChoiceMaker::add(const Moment& now, double d) {
  if (!now.cutting()) return;
  const bool diamond = now.tool.kind == tool::BurrKind::diamond;
  const double r = now.tool.radius;
  constexpr double kSame = 1e-9;  // radii from a file differ in the last bits
  if (d < settings_.near) {
    near_ += now.removed;
    if (diamond) diamond_ += now.removed;
    if (r <= settings_.small + kSame) small_ += now.removed;
    if (diamond || r <= settings_.small + kSame) either_ += now.removed;
  }
  if (d > settings_.far) {
    far_ += now.removed;
    if (!diamond && r >= settings_.large - kSame) large_ += now.removed;
  }
}

BurrChoice BurrChoiceMaker::finish() const {
  BurrChoice out;
  out.near_volume = near_;
  out.far_volume = far_;
  if (near_ > 0) {
    out.diamond = diamond_ / near_;
    out.small = small_ / near_;
    out.diamond_or_small = either_ / near_;
  }
  if (far_ > 0) out.large_cutting = large_ / far_;
  return out;
}

}  // namespace burr::metrics
