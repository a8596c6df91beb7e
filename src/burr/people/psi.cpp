#include "burr/people/psi.h"

#include <algorithm>
#include <cmath>

#include "burr/people/psychometric.h"

namespace burr::people {
namespace {

constexpr std::size_t kSlopes = 10;
constexpr double kSlopeLow = 0.7, kSlopeHigh = 8;
constexpr double kHardly = 1e-5;  // share of the whole belief that is ignored

// Entropy of an answer, for a belief of this weight in which right answers have this share.
double entropy(double right, double weight) {
  const double p = right / weight;
  return -right * std::log(p) - (weight - right) * std::log1p(-p);
}

double between(double low, double high, int at, int of) {
  return low * std::pow(high / low, static_cast<double>(at) / (of - 1));
}

}  // namespace

Psi::Psi(const PsiSettings& settings) {
  std::vector<Psychometric> known;
  for (int t = 0; t < settings.thresholds; ++t)
    for (int s = 0; s < static_cast<int>(kSlopes); ++s)
      known.push_back({between(settings.smallest, settings.largest, t, settings.thresholds),
                       between(kSlopeLow, kSlopeHigh, s, static_cast<int>(kSlopes)), settings.guess,
                       settings.lapse});
  belief_.assign(known.size(), 1.0 / static_cast<double>(known.size()));
  for (int n = 0; n < settings.levels; ++n) {
    levels_.push_back(between(settings.smallest, settings.largest, n, settings.levels));
    // never exactly certain, so that no answer is impossible
    for (const Psychometric& one : known)
      right_.push_back(std::min(one.right(levels_.back()), 1 - 1e-9));
  }
  choose();
}

void Psi::choose() {
  // thresholds with almost no belief add no information, and most of them soon have almost none
  believed_.clear();
  double all = 0;
  for (std::size_t t = 0; t < belief_.size(); t += kSlopes) {
    double weight = 0;
    for (std::size_t k = t; k < t + kSlopes; ++k) weight += belief_[k];
    if (weight < kHardly) continue;
    believed_.emplace_back(t, weight);
    all += weight;
  }
  double most = -1;
  for (std::size_t n = 0; n < levels_.size(); ++n) {
    const double* right = &right_[n * belief_.size()];
    double p = 0, left = 0;
    for (const auto& [t, weight] : believed_) {
      double here = 0;
      for (std::size_t k = t; k < t + kSlopes; ++k) here += belief_[k] * right[k];
      p += here;
      left += entropy(here, weight);
    }
    const double gain = entropy(p, all) - left;
    if (gain > most) {
      most = gain;
      next_ = n;
    }
  }
}

void Psi::answer(bool right) {
  const double* random = &right_[next_ * belief_.size()];
  double sum = 0;
  for (std::size_t k = 0; k < belief_.size(); ++k)
    sum += belief_[k] *= right ? random[k] : 1 - random[k];
  for (double& one : belief_) one /= sum;
  choose();
}

}  // namespace burr::people
