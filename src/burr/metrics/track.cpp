#include "burr/metrics/track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/math/sums.h"
#include "burr/metrics/filters.h"

namespace burr::metrics {

TrackMaker::TrackMaker(double seconds) {
  const double expected = std::clamp(seconds, 0.0, 1e5) * kTrackRate;
  track_.samples.reserve(static_cast<std::size_t>(expected) + 16);
  track_.begins.reserve(1024);
}

void TrackMaker::close() {
  if (ticks_ == 0) return;
  const auto count = static_cast<double>(ticks_);
  TrackSample sample = sum_;
  sample.t /= count;
  sample.raw /= count;
  sample.hand /= count;
  sample.p = sample.raw;
  if (apart_) track_.begins.push_back(track_.samples.size());
  apart_ = false;
  track_.samples.push_back(sample);
  sum_ = {};
  ticks_ = 0;
}

void TrackMaker::add(const Moment& now, double d) {
  const auto slot = static_cast<std::uint64_t>(now.t * kTrackRate + 1e-6);
  if (now.gap || slot != slot_) close();
  if (now.gap || slot > slot_ + 1) apart_ = true;
  slot_ = slot;
  sum_.t += now.t;
  sum_.raw += now.centre;
  sum_.hand += now.hand;
  sum_.removed += now.removed;
  sum_.d = std::fmin(sum_.d, d);  // of a number and none it takes the number
  sum_.touching = sum_.touching || now.touching;
  sum_.turning = sum_.turning || now.turning;
  sum_.irrigated = sum_.irrigated || now.tool.irrigated;
  sum_.mode = now.tool.mode;
  sum_.diamond = now.tool.kind == tool::BurrKind::diamond;
  sum_.radius = now.tool.radius;
  sum_.force = std::max(sum_.force, now.force);
  ++ticks_;
}

Track TrackMaker::finish() {
  close();
  std::vector<double> line;
  for (std::size_t n = 0; n < track_.begins.size(); ++n) {
    const std::size_t begin = track_.begins[n];
    const std::size_t end =
        n + 1 < track_.begins.size() ? track_.begins[n + 1] : track_.samples.size();
    line.resize(end - begin);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t s = begin; s < end; ++s) line[s - begin] = track_.samples[s].raw[axis];
      low_pass(line, kTrackRate, kTrackCorner);
      for (std::size_t s = begin; s < end; ++s) track_.samples[s].p[axis] = line[s - begin];
    }
  }
  return std::move(track_);
}

std::vector<double> speeds(std::span<const TrackSample> piece) {
  std::vector<double> speed(piece.size(), 0);
  for (std::size_t n = 0; n < piece.size(); ++n) {
    const TrackSample& a = piece[n == 0 ? 0 : n - 1];
    const TrackSample& b = piece[std::min(n + 1, piece.size() - 1)];
    if (b.t > a.t) speed[n] = math::norm(b.p - a.p) / (b.t - a.t);
  }
  return speed;
}

}  // namespace burr::metrics
