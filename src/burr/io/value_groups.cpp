#include "burr/io/value_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace burr::io {
namespace {

constexpr double kMostSampled = 2e6;
constexpr std::size_t kBins = 256;
// A voxel is even if it changes less than this share of the range from one voxel to the next, or
// belongs to the most even third where noise makes all of them uneven.
constexpr double kEven = 0.035, kMostEven = 0.35;
constexpr double kBlurBins = 1.5;
// A peak stands out if it falls by this share of its height on the way to a higher one.
constexpr double kStandsOut = 0.3;
constexpr double kLeastShare = 0.004;  // a smaller group is no material
constexpr double kRare = 0.02;

float at_share(std::vector<float> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

std::vector<double> blurred(const std::vector<double>& bins, double sigma) {
  const int reach = static_cast<int>(std::ceil(3.3 * sigma));
  std::vector<double> out(bins.size(), 0.0);
  const int n = static_cast<int>(bins.size());
  for (int b = 0; b < n; ++b)
    for (int d = -reach; d <= reach; ++d) {
      // mirrored at the ends
      int from = b + d;
      if (from < 0) from = -1 - from;
      if (from >= n) from = 2 * n - 1 - from;
      out[static_cast<std::size_t>(b)] +=
          bins[static_cast<std::size_t>(std::clamp(from, 0, n - 1))] *
          std::exp(-0.5 * d * d / (sigma * sigma));
    }
  return out;
}

// How many bins lie between two values that can occur: more than one where the values are whole
// numbers of a small range, and then each of them would be a peak. 1: there are too few values, as
// in a scan without noise.
double bins_between_values(const ValueSample& sample, double low, double high) {
  constexpr std::size_t kMost = 100000, kFewest = 9;
  std::vector<float> some;
  const std::size_t step = sample.values.size() / kMost + 1;
  for (std::size_t v = 0; v < sample.values.size(); v += step)
    if (double{sample.values[v]} >= low && double{sample.values[v]} <= high)
      some.push_back(sample.values[v]);
  std::sort(some.begin(), some.end());
  const auto different =
      static_cast<std::size_t>(std::unique(some.begin(), some.end()) - some.begin());
  if (different < kFewest) return 1;
  return static_cast<double>(kBins) / static_cast<double>(different - 1);
}

// The histogram of the even places.
std::vector<double> even_places(const ValueSample& sample, double low, double high) {
  std::vector<float> steep;
  for (const float s : sample.steep)
    if (s > 0 && std::isfinite(s)) steep.push_back(s);
  double most = kEven * (high - low);
  if (!steep.empty()) most = std::max(most, double{at_share(std::move(steep), kMostEven)});
  std::vector<double> bins(kBins, 0.0);
  const double scale = static_cast<double>(kBins) / (high - low);
  for (std::size_t v = 0; v < sample.values.size(); ++v) {
    if (!(double{sample.steep[v]} <= most)) continue;
    const double value = double{sample.values[v]};
    if (value < low || value > high) continue;
    ++bins[std::min(kBins - 1, static_cast<std::size_t>((value - low) * scale))];
  }
  return bins;
}

struct Peak {
  std::size_t top = 0;
  std::size_t first = 0, last = 0;  // its bins
  bool merged = false;
};

// Peaks that stand out, each with the bins around it: bins are taken from the highest to the lowest;
// one between two peaks ends the lower of them, unless that stands out.
std::vector<Peak> peaks_of(const std::vector<double>& bins) {
  std::vector<std::size_t> order(bins.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bins[a] > bins[b]; });
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> owner(bins.size(), kNone);
  std::vector<Peak> peaks;
  const auto root = [&](std::size_t peak) {
    while (peaks[peak].merged) peak = peaks[peak].top;  // top: the peak it went into
    return peak;
  };
  for (const std::size_t b : order) {
    if (bins[b] <= 0) break;
    const std::size_t left = b > 0 && owner[b - 1] != kNone ? root(owner[b - 1]) : kNone;
    const std::size_t right =
        b + 1 < bins.size() && owner[b + 1] != kNone ? root(owner[b + 1]) : kNone;
    if (left == kNone && right == kNone) {
      owner[b] = peaks.size();
      peaks.push_back({b, b, b, false});
      continue;
    }
    if (left == kNone || right == kNone || left == right) {
      owner[b] = left == kNone ? right : left;
    } else {
      const bool left_is_higher = bins[peaks[left].top] >= bins[peaks[right].top];
      const std::size_t high = left_is_higher ? left : right, less = left_is_higher ? right : left;
      owner[b] = high;
      if (bins[peaks[less].top] - bins[b] < kStandsOut * bins[peaks[less].top]) {
        peaks[high].first = std::min(peaks[high].first, peaks[less].first);
        peaks[high].last = std::max(peaks[high].last, peaks[less].last);
        peaks[less].merged = true;
        peaks[less].top = high;
      }
    }
    Peak& mine = peaks[owner[b]];
    mine.first = std::min(mine.first, b);
    mine.last = std::max(mine.last, b);
  }
  std::erase_if(peaks, [](const Peak& peak) { return peak.merged; });
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.top < b.top; });
  return peaks;
}

}  // namespace

ValueSample sample_values(const float* values, const math::Ijk& scan_size, const math::Ijk& from,
                          const math::Ijk& size, std::optional<float> outside) {
  ValueSample out;
  const double all = static_cast<double>(size.cast<double>().prod());
  const int step = std::max(1, static_cast<int>(std::ceil(std::cbrt(all / kMostSampled))));
  // few slices are all looked at
  const math::Ijk steps(step, step, size.z() < 8 * step ? 1 : step);
  const std::ptrdiff_t sx = 1, sy = scan_size.x(),
                       sz = std::ptrdiff_t{scan_size.x()} * scan_size.y();
  const auto measured = [&](float value) { return !std::isnan(value) && value != outside; };
  const std::array<std::ptrdiff_t, 3> strides = {sx, sy, sz};
  for (int k = 0; k < size.z(); k += steps.z())
    for (int j = 0; j < size.y(); j += steps.y())
      for (int i = 0; i < size.x(); i += steps.x()) {
        const math::Ijk at(i, j, k);
        const float* here =
            values + sx * (from.x() + i) + sy * (from.y() + j) + sz * (from.z() + k);
        if (!measured(*here)) {
          ++out.left_out;
          continue;
        }
        float sum = 0;
        for (int a = 0; a < 3; ++a) {
          const auto axis = static_cast<std::size_t>(a);
          const float before = at[a] > 0 ? *(here - strides[axis]) : *here,
                      after = at[a] + 1 < size[a] ? *(here + strides[axis]) : *here;
          const float d = measured(before) && measured(after)
                              ? 0.5F * (after - before)
                              : std::numeric_limits<float>::infinity();
          sum += d * d;
        }
        out.values.push_back(*here);
        out.steep.push_back(std::sqrt(sum));
      }
  return out;
}

ValueGroups groups_of(const ValueSample& sample) {
  ValueGroups out;
  if (sample.values.empty()) return out;
  out.low = value_at_share(sample, 0.001);
  out.high = value_at_share(sample, 0.995);
  if (!(out.high > out.low)) {
    out.all.push_back({out.low, 1.0, 0.0});
    return out;
  }
  // Metal can be far above all else: the rare values that lie more than four times as high as the
  // second group are left out, and the rest is looked at more closely.
  for (int round = 0; round < 3; ++round) {
    const std::vector<double> bins = even_places(sample, out.low, out.high);
    const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
    const double between = bins_between_values(sample, out.low, out.high);
    const double sigma = std::max(kBlurBins, 0.6 * between);
    const std::vector<double> smooth = blurred(bins, sigma);
    const double width = (out.high - out.low) / static_cast<double>(kBins);
    out.all.clear();
    for (const Peak& peak : peaks_of(smooth)) {
      double mass = 0, sum = 0, weight = 0;
      for (std::size_t b = peak.first; b <= peak.last; ++b) mass += bins[b];
      if (mass < kLeastShare * total) continue;
      const auto half = [&](std::size_t b) { return smooth[b] >= 0.5 * smooth[peak.top]; };
      std::size_t first = peak.top, last = peak.top;
      while (first > peak.first && half(first - 1)) --first;
      while (last < peak.last && half(last + 1)) ++last;
      for (std::size_t b = first; b <= last; ++b) {
        weight += bins[b];
        sum += bins[b] * (static_cast<double>(b) + 0.5);
      }
      if (weight <= 0) continue;
      // without the blur of this histogram
      const double wide = static_cast<double>(last - first + 1), blur = 2.355 * sigma;
      const double bins_wide = std::sqrt(std::max(0.0, wide * wide - blur * blur));
      out.all.push_back({out.low + width * sum / weight, mass / total, width * bins_wide});
    }
    if (out.all.size() < 2) break;
    const double most = out.all[0].value + 4 * (out.all[1].value - out.all[0].value);
    if (most > 0.6 * (out.high - out.low) + out.low ||
        share_between(sample, most, std::numeric_limits<double>::max()) > kRare)
      break;
    out.high = most;
  }
  return out;
}

double value_at_share(const ValueSample& sample, double share) {
  return double{at_share(sample.values, share)};
}

double share_between(const ValueSample& sample, double low, double high) {
  if (sample.values.empty()) return 0;
  const auto inside = std::count_if(sample.values.begin(), sample.values.end(),
                                    [&](float v) { return double{v} >= low && double{v} <= high; });
  return static_cast<double>(inside) / static_cast<double>(sample.values.size());
}

}  // namespace burr::io
