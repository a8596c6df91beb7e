// The functions against a wider format of the C library, which is a second method: 64 bits on x86-64, 113 on ARM.
#include "burr/math/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "burr/math/turn.h"

namespace burr::math {
namespace {

constexpr int kTries = 100000;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The worst distance from the truth over random arguments between `low` and `high`.  [unit in the last place]
template <class Function, class Truth>
double worst(double low, double high, Function function, Truth truth) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(low, high);
  double most = 0;
  for (int n = 0; n < kTries; ++n) {
    const double x = any(random), y = any(random);
    const long double is = truth(static_cast<long double>(x), static_cast<long double>(y));
    const double near = std::fabs(static_cast<double>(is));
    const double unit = std::nextafter(near, kInfinite) - near;
    const auto off = static_cast<double>(std::fabs(function(x, y) - is) / unit);
    if (!(off <= most)) most = off;
  }
  return most;
}

TEST(Elementary, ExponentialIsNearlyAlwaysTheNearestNumber) {
  for (const double far : {0.01, 1.0, 40.0, 700.0}) {
    EXPECT_LT(worst(
                  -far, far, [](double x, double) { return exponential(x); },
                  [](long double x, long double) { return std::exp(x); }),
              0.515)
        << far;
    EXPECT_LT(worst(
                  -far, far, [](double x, double) { return exponential_minus_one(x); },
                  [](long double x, long double) { return std::expm1(x); }),
              0.60)
        << far;
  }
}

TEST(Elementary, SineAndCosineAreNearlyAlwaysTheNearestNumber) {
  for (const double far : {0.02, 0.1, 7.0, 50000.0}) {
    EXPECT_LT(worst(
                  -far, far, [](double x, double) { return sine(x); },
                  [](long double x, long double) { return std::sin(x); }),
              0.51)
        << far;
    EXPECT_LT(worst(
                  -far, far, [](double x, double) { return cosine(x); },
                  [](long double x, long double) { return std::cos(x); }),
              0.51)
        << far;
  }
}

TEST(Elementary, AngleAndHypotenuseAreNearlyAlwaysTheNearestNumber) {
  for (const double far : {1e-6, 0.02, 1.0, 1000.0}) {
    EXPECT_LT(worst(
                  -far, far, [](double x, double y) { return angle_of(y, x); },
                  [](long double x, long double y) { return std::atan2(y, x); }),
              0.51)
        << far;
    EXPECT_LT(worst(
                  -far, far, [](double x, double) { return arctangent(x); },
                  [](long double x, long double) { return std::atan(x); }),
              0.51)
        << far;
    EXPECT_LT(worst(
                  -far, far, [](double x, double y) { return hypotenuse(x, y); },
                  [](long double x, long double y) { return std::hypot(x, y); }),
              0.51)
        << far;
  }
}

TEST(Elementary, WhatIsKnownExactlyIsExact) {
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(1), M_E);
  EXPECT_EQ(exponential_minus_one(0), 0);
  EXPECT_EQ(exponential_minus_one(1e-300), 1e-300);
  EXPECT_EQ(sine(0), 0);
  EXPECT_EQ(cosine(0), 1);
  EXPECT_EQ(sine(M_PI / 2), 1);
  EXPECT_EQ(sine(M_PI), 0x1.1a62633145c07p-53) << "what the double lacks to pi";
  EXPECT_EQ(angle_of(1, 0), M_PI / 2);
  EXPECT_EQ(angle_of(-1, 0), -M_PI / 2);
  EXPECT_EQ(angle_of(0, -1), M_PI);
  EXPECT_EQ(angle_of(0, 1), 0);
  EXPECT_EQ(angle_of(0, 0), 0);
  EXPECT_EQ(angle_of(1, 1), M_PI / 4);
  EXPECT_EQ(hypotenuse(3, 4), 5);
  EXPECT_EQ(hypotenuse(0, 0), 0);
}

TEST(Elementary, WhatIsTooLargeOrNoNumberIsSaidByTheResult) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(exponential(800), kInfinite);
  EXPECT_EQ(exponential(-800), 0);
  EXPECT_EQ(exponential(kInfinite), kInfinite);
  EXPECT_EQ(exponential(-kInfinite), 0);
  EXPECT_GT(exponential(-745), 0);
  EXPECT_EQ(exponential_minus_one(-800), -1);
  EXPECT_EQ(exponential_minus_one(800), kInfinite);
  for (const double is :
       {exponential(none), exponential_minus_one(none), sine(none), cosine(none), sine(kInfinite),
        angle_of(none, 1), angle_of(1, none), hypotenuse(none, 1)})
    EXPECT_TRUE(std::isnan(is));
  EXPECT_NEAR(sine(1e6), std::sin(1e6), 1e-9) << "by whole turns";
}

TEST(Elementary, ARotationVectorAndItsRotationAreInverse) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> any(-1.7, 1.7);  // the norm stays below pi
  for (int n = 0; n < 1000; ++n) {
    const Vec3 turn(any(random), any(random), any(random));
    const Quat q = rotation_of(turn);
    EXPECT_LT((rotation_vector(q) - turn).norm(), 1e-14);
    const Quat other(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    EXPECT_LT((q.coeffs() - other.coeffs()).norm(), 1e-15);
  }
  EXPECT_EQ(rotation_of(Vec3::Zero()).w(), 1);
}

TEST(Elementary, ARotationBetweenTwoIsEigens) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const Quat a = normalized(Quat(any(random), any(random), any(random), any(random)));
    const Quat b = n % 2 == 0 ? normalized(Quat(any(random), any(random), any(random), any(random)))
                              : turned(a, 1e-9 * Vec3(any(random), any(random), any(random)));
    const double share = 0.5 * (any(random) + 1);
    EXPECT_LT((between(a, b, share).coeffs() - a.slerp(share, b).coeffs()).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace burr::math
