// Made motions: zigzags, circles, moves of minimum jerk; strokes and smoothness are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "burr/metrics/filters.h"
#include "burr/metrics/smoothness.h"
#include "burr/metrics/strokes.h"
#include "metrics/ticks.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::Happening;

constexpr double kMm = 1e-3, kPi2 = 2 * std::numbers::pi;

// To and fro along x, `rate` there-and-backs a second, with a tremor of 8 to 12 Hz.
struct Zigzag {
  double rate, width, tremor;  // [1/s], [m], [m]
};
Happening zigzag_at(const Zigzag& z, double t) {
  Happening now;
  now.touching = true;
  const double phase = t * z.rate - std::floor(t * z.rate);
  const double x = phase < 0.5 ? 2 * phase : 2 - 2 * phase;
  now.place = {x * z.width + z.tremor * std::sin(kPi2 * 9.3 * t),
               z.tremor * std::sin(kPi2 * 11.1 * t + 1), z.tremor * std::sin(kPi2 * 8.2 * t + 2)};
  return now;
}

// Q2
TEST(Strokes, OfAZigzag) {
  for (const Zigzag& z : {Zigzag{0.5, 10 * kMm, 0}, Zigzag{0.75, 6 * kMm, 0.1 * kMm},
                          Zigzag{1.5, 4 * kMm, 0.2 * kMm}, Zigzag{1.0, 8 * kMm, 0.25 * kMm}}) {
    const Process done = test::process(20, [&](double t) { return zigzag_at(z, t); });
    const double found = static_cast<double>(done.strokes.size()) / 20;
    const auto figures = figures_of(done.strokes);
    ASSERT_TRUE(figures) << figures.reason();
    std::printf(
        "Q2 %.2f Hz %.0f mm tremor %.2f: %.2f of %.2f strokes/s, %.2f s, %.2f mm, curved %.2f\n",
        z.rate, z.width / kMm, z.tremor / kMm, found, 2 * z.rate, figures->median_seconds,
        figures->median_length / kMm, figures->curved_share);
    EXPECT_NEAR(found, 2 * z.rate, 0.1 * 2 * z.rate);
    EXPECT_NEAR(figures->median_seconds, 0.5 / z.rate, 0.06);
    EXPECT_NEAR(figures->median_length, z.width, 0.25 * z.width);
    EXPECT_LT(figures->curved_share, 0.1);
  }
}

// Q3: a circle has no corners; it is one curved stroke
TEST(Strokes, OfACircle) {
  const Process done = test::process(4, [](double t) {
    Happening now;
    now.touching = true;
    now.place = 3 * kMm * Vec3(std::cos(kPi2 * t), std::sin(kPi2 * t), 0);
    return now;
  });
  ASSERT_EQ(done.strokes.size(), 1U);
  EXPECT_NEAR(done.strokes[0].length, kPi2 * 3 * kMm * 4, 2 * kMm);
  EXPECT_LT(done.strokes[0].straightness(), 0.1);
  EXPECT_FALSE(figures_of(done.strokes));  // one is too few for figures
}

TEST(Strokes, EndWhereContactOrTheSpindleEnds) {
  const auto story = [](double t) {
    Happening now;
    now.place.x() = 10 * kMm * t;  // straight on
    now.touching = !(t > 1 && t < 1.2) && !(t > 2 && t < 2.05);
    now.spindle = t < 3 ? 5000 : -5000;
    if (t > 2.5) now.tool.mode = tool::Mode::smooth;
    if (t > 3.5) now.spindle = 0;
    return now;
  };
  const Process done = test::process(4, story);
  // until 1, from 1.2 to the change of mode at 2.5 (a loss of 50 ms counts as none), until 3.5
  ASSERT_EQ(done.strokes.size(), 3U);
  EXPECT_NEAR(done.strokes[0].end, 1.0, 0.02);
  EXPECT_NEAR(done.strokes[1].begin, 1.2, 0.02);
  EXPECT_NEAR(done.strokes[1].end, 2.5, 0.02);
  EXPECT_NEAR(done.strokes[2].end, 3.5, 0.02);
}

// Moves of minimum jerk (Flash & Hogan 1985): from 0 to 1 in the time 0 .. 1
double minimum_jerk(double s) {
  s = std::min(std::max(s, 0.0), 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}
std::vector<double> speed_of_moves(int moves, double seconds, double rate) {
  std::vector<double> speed;
  const int steps = static_cast<int>(seconds * rate);
  for (int m = 0; m < moves; ++m)
    for (int n = 0; n < steps; ++n) {
      const double s = n / static_cast<double>(steps);
      speed.push_back(30 * s * s * (1 - s) * (1 - s));
    }
  speed.push_back(0);
  return speed;
}

// Q4
TEST(Smoothness, OfMovesOfMinimumJerk) {
  const double exact = -std::log(720 / (1.875 * 1.875));
  for (const double rate : {100.0, 1000.0}) {
    const std::vector<double> one = speed_of_moves(1, 1.0, rate);
    std::printf("Q4 %.0f Hz: SPARC %.3f %.3f %.3f, LDLJ %.3f of %.3f\n", rate, *sparc(one, rate),
                *sparc(speed_of_moves(2, 1, rate), rate), *sparc(speed_of_moves(3, 1, rate), rate),
                *ldlj(one, rate), exact);
    EXPECT_NEAR(*sparc(one, rate), -1.40, 0.02);
    EXPECT_NEAR(*sparc(speed_of_moves(2, 1, rate), rate), -2.27, 0.05);
    EXPECT_NEAR(*sparc(speed_of_moves(3, 1, rate), rate), -2.69, 0.08);
    EXPECT_NEAR(*ldlj(one, rate), exact, 0.05);
  }
  // neither depends on size or, for the same shape, on time
  std::vector<double> larger = speed_of_moves(1, 2.0, 500);
  for (double& v : larger) v *= 7;
  EXPECT_NEAR(*ldlj(larger, 500), exact, 0.02);
  EXPECT_NEAR(*sparc(larger, 500), -1.40, 0.02);
}

TEST(Smoothness, WithoutMotionThereIsNone) {
  for (const std::vector<double>& speed :
       {std::vector<double>{}, std::vector<double>(2, 1), std::vector<double>(100, 0),
        std::vector<double>{0, 1, NAN, 1, 0}}) {
    EXPECT_FALSE(sparc(speed, 100));
    EXPECT_FALSE(ldlj(speed, 100));
  }
  EXPECT_FALSE(ldlj(std::vector<double>(100, 1), 100));  // no hand moves so
}

TEST(Smoothness, FindsFreeMovesOnly) {
  // six moves of 30 mm in 0.8 s with pauses of 0.5 s; the fourth in contact; then one of 5 mm
  const auto story = [](double t) {
    Happening now;
    const int number = static_cast<int>(t / 1.3);
    const double s = (t - 1.3 * number) / 0.8, width = number < 6 ? 30 * kMm : 5 * kMm;
    now.place.x() = number * 30 * kMm + width * minimum_jerk(s);
    now.touching = number == 3;
    return now;
  };
  const Process done = test::process(1.3 * 7, story);
  ASSERT_EQ(done.moves.size(), 5U);
  for (const Move& move : done.moves) {
    EXPECT_NEAR(move.chord, 30 * kMm, 1 * kMm);
    EXPECT_NEAR(move.sparc, -1.41, 0.1);
    EXPECT_LT(move.ldlj, -4.5);
    EXPECT_GT(move.ldlj, -6.5);
  }
  ASSERT_TRUE(smoothness_of(done.moves));
  EXPECT_FALSE(smoothness_of(std::span<const Move>(done.moves).first(4)));
}

TEST(Strokes, WithoutADistanceAreNeitherNearNorFar) {
  const std::vector<BurrStroke> strokes(6);
  EXPECT_TRUE(figures_of(strokes));
  const auto near = figures_of(strokes, 0, 2 * kMm);
  ASSERT_FALSE(near);
  EXPECT_EQ(near.reason(), kNoStrokeDistance);
}

// Gains of the band from 6 to 12 Hz.
TEST(Filters, TheBandHoldsItsMiddle) {
  for (const auto& [frequency, gain] :
       {std::pair{9.0, 0.99}, std::pair{7.0, 0.92}, std::pair{11.0, 0.80}, std::pair{6.0, 0.5},
        std::pair{3.0, 0.0}, std::pair{25.0, 0.0}}) {
    std::vector<double> sine;
    for (int n = 0; n < 2000; ++n) sine.push_back(std::sin(kPi2 * frequency * n / 100));
    const std::vector<double> out = band(sine, 100, 6, 12);
    double sum = 0;
    for (std::size_t n = 500; n < 1500; ++n) sum += out[n] * out[n] / 500;
    EXPECT_NEAR(std::sqrt(sum), gain, 0.03) << frequency;
  }
}

TEST(Filters, PassAndStop) {
  const double rate = 100;
  std::vector<double> slow, fast, straight;
  for (int n = 0; n < 1000; ++n) {
    slow.push_back(std::sin(kPi2 * 1.0 * n / rate));
    fast.push_back(std::sin(kPi2 * 20.0 * n / rate));
    straight.push_back(0.3 * n);
  }
  std::vector<double> out = slow;
  low_pass(out, rate, 6);
  for (std::size_t n = 100; n < 900; ++n) EXPECT_NEAR(out[n], slow[n], 0.01);  // no delay
  out = fast;
  low_pass(out, rate, 6);
  for (std::size_t n = 100; n < 900; ++n) EXPECT_LT(std::abs(out[n]), 0.02);
  out = straight;
  low_pass(out, rate, 6);
  for (std::size_t n = 0; n < out.size(); ++n) EXPECT_NEAR(out[n], straight[n], 1e-3);
  // the corner leaves half of the amplitude
  std::vector<double> corner;
  for (int n = 0; n < 1000; ++n) corner.push_back(std::sin(kPi2 * 6.0 * n / rate));
  out = corner;
  low_pass(out, rate, 6);
  double largest = 0;
  for (std::size_t n = 200; n < 800; ++n) largest = std::max(largest, std::abs(out[n]));
  EXPECT_NEAR(largest, 0.5, 0.02);
}

}  // namespace
}  // namespace burr::metrics
