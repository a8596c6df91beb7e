#include "burr/metrics/near.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burr::metrics {

namespace {

// Of the round burr's head, or of the nearest place on the cutting parts of a tool of the rack. Far away it may be
// less by what the tool reaches.
double distance_of(const volume::DistanceTo& to, const Moment& now) {
  constexpr double kExact = 12e-3;  // no measure looks farther [m]
  const double middle = to.at(now.centre).distance;
  if (now.parts == nullptr) return middle - now.tool.radius;
  // where there is no answer for the middle it is farther than the reach
  if (std::min(middle, to.reach()) - now.parts->reach > kExact) return middle - now.parts->reach;
  double least = kFar;
  for (const math::Vec3& on : now.parts->on)
    least = std::min(least, to.at(now.centre + now.turn * on).distance);
  return least;
}

}  // namespace

void Distances::update(const Moment& now) {
  least_ = kNoDistance;
  const bool known = now.radius_known();
  radius_ = radius_ || known;
  for (std::size_t n = 0; n < watched_.size(); ++n) {
    const volume::DistanceTo& to = *watched_[n].distance;
    d_[n] = known && !to.empty() ? distance_of(to, now) : kNoDistance;
    if (!std::isnan(d_[n]) && !(least_ <= d_[n])) least_ = d_[n];
  }
}

std::string Distances::why_none(std::size_t n) const {
  if (watched_[n].distance->empty()) return kNotInBone;
  return radius_ ? "" : kNoRadius;
}

std::string Distances::why_none() const {
  if (watched_.empty()) return kNoStructure;
  const bool any = std::any_of(watched_.begin(), watched_.end(),
                               [](const Watched& one) { return !one.distance->empty(); });
  if (!any) return "none of the structures is in this bone: no voxel has a label of theirs";
  return radius_ ? "" : kNoRadius;
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
  const double below = share * static_cast<double>(all_);
  double seen = 0;
  for (std::size_t n = 0; n + 1 < count_.size(); ++n) {
    const auto here = static_cast<double>(count_[n]);
    if (seen + here >= below && here > 0)
      return std::min(largest_, step_ * (static_cast<double>(n) + (below - seen) / here));
    seen += here;
  }
  return largest_;
}

void ForceNearMaker::add(const Moment& now, double d) {
  if (!now.touching) return;
  if (now.force > forces_.largest()) peak_at_ = now.t;
  forces_.add(now.force);
  all_.add(now.force, now.dt);
  if (std::isnan(d)) return;
  const std::size_t bin = bin_of(d);
  bins_[bin].add(now.force, now.dt);
  peaks_[bin] = std::max(peaks_[bin], now.force);
}

Assessed<ForceNear> ForceNearMaker::finish(const Distances& distances) const {
  const auto mean = all_.mean();
  if (!mean) return NotAssessable{"the burr never touched the bone"};
  ForceNear out;
  out.mean = *mean;
  out.p95 = forces_.quantile(0.95).value_or(0);
  out.peak = forces_.largest();
  out.peak_at = peak_at_;
  out.seconds = all_.weight;
  ForceByDistance by;
  double known = 0;  // [s]
  for (std::size_t n = 0; n < kBins; ++n) {
    known += bins_[n].weight;
    by.time[n] = bins_[n].weight;
    by.bin_mean[n] = bins_[n].mean();
    by.bin_peak[n] = peaks_[n];
  }
  if (!(known > 0)) {
    const std::string why = distances.why_none();
    out.by_distance = NotAssessable{why.empty() ? kNoRadius : why};
    return out;
  }
  Running near = bins_[0];
  near.sum += bins_[1].sum;
  near.weight += bins_[1].weight;
  const Running& far = bins_[kBins - 1];
  constexpr double kLeast = 0.5;  // [s]
  if (near.weight < kLeast || far.weight < kLeast)
    by.restraint = NotAssessable{
        "the burr was in contact for less than half a second near what is to be spared, or far "
        "from it"};
  else if (far.sum > 0)
    by.restraint = (near.sum / near.weight) / (far.sum / far.weight);
  else
    by.restraint = NotAssessable{"no force was recorded far from what is to be spared"};
  out.by_distance = std::move(by);
  return out;
}

NearnessMaker::NearnessMaker(const std::vector<Watched>& watched)
    : found_(watched.size()), past_(watched.size()) {}

void NearnessMaker::approach(const Moment& now, double d, Past& past, Nearness& found) {
  constexpr double kNear = 1e-3, kOver = 50e-3;  // [m], [s]
  if (found.approach) return;
  // a larger burr is nearer without having moved
  if (now.gap || !std::isfinite(d) || now.tool.radius != past.radius) past.count = 0;
  if (!std::isfinite(d)) return;
  past.radius = now.tool.radius;
  if (d < kNear && past.count > 0 && past.d[(past.next + kPast - 1) % kPast] >= kNear) {
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
    Nearness& found = found_[n];
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

std::vector<NearnessOf> NearnessMaker::finish(const Distances& distances) const {
  std::vector<NearnessOf> out;
  for (std::size_t n = 0; n < found_.size(); ++n) {
    NearnessOf one{distances.watched()[n].name};
    const std::string why = distances.why_none(n);
    one.found = why.empty() ? Assessed<Nearness>(found_[n]) : NotAssessable{why};
    out.push_back(std::move(one));
  }
  return out;
}

void BurrChoiceMaker::add(const Moment& now, double d) {
  if (!now.cutting() || std::isnan(d)) return;
  known_ = true;
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

Assessed<BurrChoice> BurrChoiceMaker::finish(const Distances& distances) const {
  if (std::string why = distances.why_none(); !why.empty()) return NotAssessable{std::move(why)};
  if (!known_) return NotAssessable{"nothing was removed while the burr's radius was known"};
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
