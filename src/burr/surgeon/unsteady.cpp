#include "burr/surgeon/unsteady.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr std::uint64_t kTremorStream = 11, kDriftStream = 12, kForceStream = 13;
constexpr double kLowestHz = 0.1, kLeastFactor = 0.1;

Vec3 normals(people::RandomStream& random) BURR_RT {
  const double x = random.normal(), y = random.normal();
  return {x, y, random.normal()};
}

}  // namespace

Tremor::Tremor(double rms, double dt, std::uint64_t seed) : random_(seed, kTremorStream) {
  const double w = 2 * std::numbers::pi * kTremorHz, damping = 0.5 / kTremorQuality;
  const double keep = std::exp(-damping * w * dt);
  one_ = 2 * keep * std::cos(w * std::sqrt(1 - damping * damping) * dt);
  two_ = -keep * keep;
  // variance of an autoregression of order two (Box & Jenkins, section 3.2)
  noise_ = rms * std::sqrt((1 + two_) * ((1 - two_) * (1 - two_) - one_ * one_) / (1 - two_));
  last_ = rms * normals(random_);
  // correlated with it as two steps of the process are
  const double both = one_ / (1 - two_);
  before_ = both * last_ + std::sqrt(std::max(0.0, 1 - both * both)) * rms * normals(random_);
}

Vec3 Tremor::next() BURR_RT {
  const Vec3 now = one_ * last_ + two_ * before_ + noise_ * normals(random_);
  before_ = last_;
  last_ = now;
  return now;
}

Drift::Drift(double rms, double dt, std::uint64_t seed) : random_(seed, kDriftStream) {
  keep_ = std::exp(-2 * std::numbers::pi * kDriftHz * dt);
  noise_ = rms * std::sqrt(1 - keep_ * keep_);
  at_ = rms * normals(random_);
}

Vec3 Drift::next() BURR_RT {
  at_ = keep_ * at_ + noise_ * normals(random_);
  return at_;
}

UnevenForce::UnevenForce(double rms, double dt, std::uint64_t seed) : random_(seed, kForceStream) {
  const double each = rms / std::sqrt(static_cast<double>(kOctaves));
  double hz = kLowestHz;
  for (std::size_t n = 0; n < kOctaves; ++n, hz *= 2) {
    keep_[n] = std::exp(-2 * std::numbers::pi * hz * dt);
    noise_[n] = each * std::sqrt(1 - keep_[n] * keep_[n]);
    at_[n] = each * random_.normal();
  }
}

double UnevenForce::next() BURR_RT {
  double sum = 1;
  for (std::size_t n = 0; n < kOctaves; ++n) {
    at_[n] = keep_[n] * at_[n] + noise_[n] * random_.normal();
    sum += at_[n];
  }
  return std::max(sum, kLeastFactor);
}

}  // namespace burr::surgeon
