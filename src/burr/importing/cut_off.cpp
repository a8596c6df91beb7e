#include "burr/importing/cut_off.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace burr::importing {
namespace {

// Values that occur, each with its number of voxels.
struct Heap {
  float value = 0;
  std::size_t count = 0;
};

std::vector<Heap> heaps_of(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  std::vector<Heap> out;
  for (const float value : values) {
    if (out.empty() || out.back().value != value) out.push_back({value, 0});
    ++out.back().count;
  }
  return out;
}

// Voxels within `reach` of this heap, without its own.
double beside(const std::vector<Heap>& heaps, std::size_t which, double reach) {
  double sum = 0;
  const auto near = [&](std::size_t n) {
    return std::abs(double{heaps[n].value} - double{heaps[which].value}) <= reach;
  };
  for (std::size_t n = which; n > 0 && near(n - 1); --n)
    sum += static_cast<double>(heaps[n - 1].count);
  for (std::size_t n = which + 1; n < heaps.size() && near(n); ++n)
    sum += static_cast<double>(heaps[n].count);
  return sum;
}

}  // namespace

CutOff find_cut_off(const io::ValueSample& sample) {
  CutOff out;
  const std::vector<Heap> heaps = heaps_of(sample.values);
  if (heaps.size() < 9) return out;
  const double low = double{heaps.front().value}, high = double{heaps.back().value};
  const double all = static_cast<double>(sample.values.size());
  constexpr double kReach = 0.04;  // of the range: where the voxels of one material lie
  const double reach = kReach * (high - low);
  // a pile has so much less beside it than it holds
  const auto stands_alone = [&](std::size_t which, double less) {
    return beside(heaps, which, reach) < less * static_cast<double>(heaps[which].count);
  };
  // the commonest value between the ends: with noise, as many voxels lie beside it. It must be of a
  // material, and not of edges.
  std::size_t commonest = 1;
  for (std::size_t n = 2; n + 1 < heaps.size(); ++n)
    if (heaps[n].count > heaps[commonest].count) commonest = n;
  constexpr double kMaterial = 0.05;  // of the voxels
  const double own = static_cast<double>(heaps[commonest].count);
  constexpr double kWithoutNoise = 0.35, kCut = 0.15;
  if (stands_alone(commonest, kWithoutNoise) ||
      own + beside(heaps, commonest, reach) < kMaterial * all)
    return out;
  constexpr double kLeastLow = 0.02,
                   kLeastHigh = 0.002;  // shares; air is plenty, dense bone is not
  out.low_value = low;
  out.high_value = high;
  out.low_share = static_cast<double>(heaps.front().count) / all;
  out.high_share = static_cast<double>(heaps.back().count) / all;
  out.low = out.low_share >= kLeastLow && stands_alone(0, kCut);
  out.high = out.high_share >= kLeastHigh && stands_alone(heaps.size() - 1, kCut);
  return out;
}

std::string piles_text(const CutOff& cut) {
  const auto one = [](double share, const char* end, double value) {
    return fmt::format("{:.2g} % of the voxels hold exactly the {} value ({:.4g})", 100 * share,
                       end, value);
  };
  if (cut.low && cut.high)
    return fmt::format("{}, and {:.2g} % the highest ({:.4g})",
                       one(cut.low_share, "lowest", cut.low_value), 100 * cut.high_share,
                       cut.high_value);
  if (cut.low) return one(cut.low_share, "lowest", cut.low_value);
  return cut.high ? one(cut.high_share, "highest", cut.high_value) : std::string();
}

}  // namespace burr::importing
