// Tremor, drift and uneven force have the size and the band that they are given.
#include "burr/surgeon/unsteady.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace burr::surgeon {
namespace {

constexpr double kTick = 1e-3;

double rms(const std::vector<double>& x) {
  double sum = 0;
  for (const double one : x) sum += one * one;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

// Share of the power between two frequencies, by the discrete Fourier transform at every 0.1 Hz up
// to 40 Hz.
double share_between(const std::vector<double>& x, double low, double high) {
  double inside = 0, all = 0;
  for (double hz = 0.1; hz < 40; hz += 0.1) {
    double re = 0, im = 0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double angle = 2 * std::numbers::pi * hz * kTick * static_cast<double>(n);
      re += x[n] * std::cos(angle);
      im += x[n] * std::sin(angle);
    }
    const double power = re * re + im * im;
    all += power;
    if (hz >= low && hz <= high) inside += power;
  }
  return inside / all;
}

TEST(Unsteady, TremorHasTheRmsOnEachAxisAndItsBandAroundNineAndAHalfHertz) {
  for (const double wanted : {0.05e-3, 0.25e-3}) {
    Tremor tremor(wanted, kTick, 7);
    std::vector<double> axis[3];
    for (int n = 0; n < 200'000; ++n) {
      const math::Vec3 at = tremor.next();
      for (int i = 0; i < 3; ++i) axis[i].push_back(at[i]);
    }
    for (const auto& one : axis) EXPECT_NEAR(rms(one), wanted, 0.06 * wanted);
    const std::vector<double> part(axis[0].begin(), axis[0].begin() + 10'000);
    EXPECT_GT(share_between(part, 8, 11), 0.6);
    EXPECT_GT(share_between(part, 6, 13), 0.8);
  }
}

TEST(Unsteady, TremorHasTheSameRmsForEveryStepWidth) {
  for (const double dt : {0.5e-3, 2e-3}) {
    Tremor tremor(1, dt, 3);
    std::vector<double> x;
    for (int n = 0; n < 300'000; ++n) x.push_back(tremor.next().x());
    EXPECT_NEAR(rms(x), 1, 0.06);
  }
}

TEST(Unsteady, DriftIsSlowAndHasItsRms) {
  Drift drift(0.5e-3, kTick, 5);
  std::vector<double> x;
  for (int n = 0; n < 600'000; ++n) x.push_back(drift.next().y());
  EXPECT_NEAR(rms(x), 0.5e-3, 0.05e-3);
  // after 1 / (2 pi 0.5 Hz) it remembers 1/e
  const auto later = static_cast<std::size_t>(1 / (2 * std::numbers::pi * kDriftHz) / kTick);
  double sum = 0;
  for (std::size_t n = later; n < x.size(); ++n) sum += x[n] * x[n - later];
  EXPECT_NEAR(sum / static_cast<double>(x.size()) / (rms(x) * rms(x)), std::exp(-1), 0.08);
}

TEST(Unsteady, ForceVariesAboutOneByItsRms) {
  UnevenForce force(0.3, kTick, 9);
  double sum = 0, square = 0;
  constexpr int kTicks = 600'000;
  for (int n = 0; n < kTicks; ++n) {
    const double factor = force.next() - 1;
    sum += factor;
    square += factor * factor;
  }
  EXPECT_NEAR(sum / kTicks, 0, 0.05);
  EXPECT_NEAR(std::sqrt(square / kTicks), 0.3, 0.04);
}

TEST(Unsteady, NothingIsNothing) {
  Tremor tremor(0, kTick, 1);
  Drift drift(0, kTick, 1);
  UnevenForce force(0, kTick, 1);
  for (int n = 0; n < 1000; ++n) {
    EXPECT_EQ(tremor.next().norm(), 0);
    EXPECT_EQ(drift.next().norm(), 0);
    EXPECT_EQ(force.next(), 1);
  }
}

TEST(Unsteady, TheSeedDecides) {
  Tremor a(1, kTick, 1), same(1, kTick, 1), other(1, kTick, 2);
  const math::Vec3 first = a.next();
  EXPECT_EQ(first, same.next());
  EXPECT_NE(first, other.next());
}

}  // namespace
}  // namespace burr::surgeon
