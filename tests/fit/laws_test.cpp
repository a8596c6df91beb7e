// Constants estimated from a log, compared with those that the log was made with.
#include "burr/fit/laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "burr/fit/least_squares.h"
#include "fit/made_logs.h"

namespace burr::fit {
namespace {

using test::Random;
using test::Truth;

const Fitted* constant(const MaterialFit& fit, const std::string& key) {
  for (const Fitted& one : fit.constants)
    if (one.key == key) return &one;
  return nullptr;
}

TEST(Student, AsInTheTables) {
  const std::map<std::size_t, double> table = {
      {1, 12.7062047},  {2, 4.30265273},  {3, 3.18244631},  {4, 2.77644511},   {5, 2.57058184},
      {10, 2.22813885}, {29, 2.04522964}, {30, 2.04227246}, {100, 1.98397152}, {1000, 1.96233908}};
  for (const auto& [freedom, t] : table) EXPECT_NEAR(student_95(freedom), t, 1e-7) << freedom;
  // the series and the expansion agree where they meet
  EXPECT_NEAR(student_95(400), student_95(401), 2e-5);
  EXPECT_GT(student_95(400), student_95(401));
}

TEST(LeastSquares, IntervalOfAMeanIsThatOfTheTextbook) {
  // a column of ones: the mean, +- t s / sqrt(n)
  const std::vector<std::vector<double>> ones = {{1, 1, 1, 1, 1}};
  const std::vector<double> y = {1, 2, 3, 4, 5};
  const LineFit fit = least_squares(ones, y);
  ASSERT_EQ(fit.state, LineFit::State::good);
  EXPECT_NEAR(fit.value[0], 3, 1e-12);
  EXPECT_NEAR(fit.residual, std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(fit.half[0], 2.77644511 * std::sqrt(2.5 / 5), 1e-7);
}

TEST(LeastSquares, TwoColumnsAgainstTheNormalEquations) {
  BURR_FIT_SEEDED(random, 5);
  std::normal_distribution<double> noise;
  std::vector<std::vector<double>> x(2);
  std::vector<double> y;
  double aa = 0, ab = 0, bb = 0, ay = 0, by = 0;
  for (int n = 0; n < 40; ++n) {
    const double a = 1 + noise(random), b = 1000 * (2 + noise(random)), v = noise(random);
    x[0].push_back(a);
    x[1].push_back(b);
    y.push_back(v);
    aa += a * a, ab += a * b, bb += b * b, ay += a * v, by += b * v;
  }
  const double det = aa * bb - ab * ab;
  const double p = (bb * ay - ab * by) / det, q = (aa * by - ab * ay) / det;
  double rest = 0;
  for (std::size_t n = 0; n < y.size(); ++n) rest += std::pow(y[n] - p * x[0][n] - q * x[1][n], 2);
  const double s = std::sqrt(rest / 38);
  const LineFit fit = least_squares(x, y);
  ASSERT_EQ(fit.state, LineFit::State::good);
  EXPECT_NEAR(fit.value[0], p, 1e-10);
  EXPECT_NEAR(fit.value[1], q, 1e-13);
  EXPECT_NEAR(fit.residual, s, 1e-10);
  EXPECT_NEAR(fit.half[0], student_95(38) * s * std::sqrt(bb / det), 1e-10);
  EXPECT_NEAR(fit.half[1], student_95(38) * s * std::sqrt(aa / det), 1e-13);
}

// ---- exact logs

TEST(Laws, ExactLogsGiveTheirConstantsBack) {
  const Truth truth;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    BURR_FIT_SEEDED(random, seed);
    const auto one = fit_laws(test::level_1(truth, 50, 0, 0, random)).at(0);
    EXPECT_EQ(one.rows, 50U);
    ASSERT_EQ(one.constants.size(), 2U);
    EXPECT_NEAR(constant(one, "cutting_friction")->value / truth.mu, 1, 1e-9);
    EXPECT_NEAR(constant(one, "cutting_energy_J_mm3")->value / truth.energy, 1, 1e-9);
    EXPECT_TRUE(one.undetermined.empty());
    const auto two = fit_laws(test::level_2(truth, 50, 0, random)).at(0);
    ASSERT_EQ(two.constants.size(), 6U);
    EXPECT_NEAR(constant(two, "chip_tangential_N_mm2")->value / truth.tc, 1, 1e-9);
    EXPECT_NEAR(constant(two, "edge_tangential_N_mm")->value / truth.te, 1, 1e-9);
    EXPECT_NEAR(constant(two, "chip_radial_N_mm2")->value / truth.rc, 1, 1e-9);
    EXPECT_NEAR(constant(two, "edge_radial_N_mm")->value / truth.re, 1, 1e-9);
    EXPECT_LT(constant(two, "edge_radial_N_mm")->half / truth.re, 1e-9);
  }
}

TEST(Laws, WithoutPowerTheTangentialForceTimesSpeedServes) {
  BURR_FIT_SEEDED(random, 3);
  const Truth truth;
  ForceLog log = test::level_1(truth, 50, 0, 0, random);
  for (ForceRow& row : log.rows) row.power.reset();
  const auto fit = fit_laws(log).at(0);
  EXPECT_NEAR(constant(fit, "cutting_energy_J_mm3")->value / truth.energy, 1, 1e-9);
  // a measured power is preferred to the force
  for (ForceRow& row : log.rows) row.power = 2 * *row.tangential * row.speed * row.radius;
  EXPECT_NEAR(constant(fit_laws(log).at(0), "cutting_energy_J_mm3")->value / truth.energy, 2, 1e-9);
}

TEST(Laws, RowsInWhichNothingIsCutAreLeftOutAndCounted) {
  BURR_FIT_SEEDED(random, 4);
  const Truth truth;
  ForceLog log = test::level_1(truth, 40, 0, 0, random);
  for (std::size_t n = 0; n < 4; ++n) *log.rows[n].tangential += 100;  // would spoil it all
  log.rows[0].normal = 0.049;
  log.rows[1].speed = 0;
  log.rows[2].removal = 0;
  log.rows[3].speed = -100;
  const auto fit = fit_laws(log).at(0);
  EXPECT_EQ(fit.rows, 36U);
  EXPECT_EQ(fit.left_out, 4U);
  EXPECT_NEAR(constant(fit, "cutting_friction")->value / truth.mu, 1, 1e-9);
}

TEST(Laws, EachMaterialHasItsOwn) {
  BURR_FIT_SEEDED(random, 6);
  Truth soft, hard;
  hard.energy = 5e9;
  ForceLog log = test::level_1(soft, 30, 0, 0, random);
  ForceLog other = test::level_1(hard, 30, 0, 0, random);
  other.materials[0] = "enamel";
  log.append(other);
  const auto fits = fit_laws(log);
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_EQ(fits[1].material, "enamel");
  EXPECT_NEAR(constant(fits[0], "cutting_energy_J_mm3")->value / soft.energy, 1, 1e-9);
  EXPECT_NEAR(constant(fits[1], "cutting_energy_J_mm3")->value / hard.energy, 1, 1e-9);
}

// ---- noise

TEST(Laws, TheErrorShrinksWithTheRootOfTheRows) {
  const Truth truth;
  std::map<std::size_t, double> error_1, error_2, half;
  for (const std::size_t rows : {50U, 200U, 800U, 3200U}) {
    constexpr int kLogs = 100;
    for (int n = 0; n < kLogs; ++n) {
      BURR_FIT_SEEDED(random, 1000 * rows + static_cast<std::size_t>(n));
      const auto one = fit_laws(test::level_1(truth, rows, 0.3, 2, random)).at(0);
      const auto two = fit_laws(test::level_2(truth, rows, 0.3, random)).at(0);
      error_1[rows] +=
          std::pow(constant(one, "cutting_energy_J_mm3")->value / truth.energy - 1, 2) / kLogs;
      error_2[rows] +=
          std::pow(constant(two, "chip_tangential_N_mm2")->value / truth.tc - 1, 2) / kLogs;
      half[rows] += constant(one, "cutting_friction")->half / kLogs;
    }
  }
  // a hundred logs give an error to 7 %, the ratio of two to 10 %
  for (const std::size_t rows : {50U, 200U, 800U}) {
    EXPECT_NEAR(std::sqrt(error_1[rows] / error_1[4 * rows]), 2, 0.6) << rows;
    EXPECT_NEAR(std::sqrt(error_2[rows] / error_2[4 * rows]), 2, 0.6) << rows;
    EXPECT_NEAR(half[rows] / half[4 * rows], 2, 0.15) << rows;
  }
  EXPECT_NEAR(std::sqrt(error_1[50] / error_1[3200]), 8, 2.4);
}

TEST(Laws, TheIntervalHoldsTheTruthNineteenTimesOfTwenty) {
  const Truth truth;
  const std::map<std::string, double> truths = {
      {"cutting_friction", truth.mu},      {"cutting_energy_J_mm3", truth.energy},
      {"chip_tangential_N_mm2", truth.tc}, {"edge_tangential_N_mm", truth.te},
      {"chip_radial_N_mm2", truth.rc},     {"edge_radial_N_mm", truth.re}};
  for (const std::size_t rows : {6U, 60U}) {  // few rows: here Student's factor matters
    std::map<std::string, int> held;
    for (std::uint64_t n = 0; n < 1000; ++n) {
      BURR_FIT_SEEDED(random, 77'000 + 1'000'000 * rows + n);
      const auto one = fit_laws(test::level_1(truth, rows, 0.2, 1.5, random)).at(0);
      auto all = one.constants;
      const auto two = fit_laws(test::level_2(truth, rows, 0.1, random)).at(0);
      for (const Fitted& c : two.constants)
        if (std::string(c.key).find("_N_mm") != std::string::npos) all.push_back(c);
      ASSERT_EQ(all.size(), 6U);
      for (const Fitted& c : all)
        if (std::abs(c.value - truths.at(c.key)) <= c.half) ++held[c.key];
    }
    for (const auto& [key, value] : truths) {
      EXPECT_NEAR(held[key], 950, 30) << key << " of " << rows << " rows";
      RecordProperty(key + "_" + std::to_string(rows), held[key]);
    }
  }
}

// ---- logs without enough information

TEST(Laws, ALogThatCannotTellTwoConstantsApartSaysSo) {
  BURR_FIT_SEEDED(random, 8);
  const Truth truth;
  ForceLog log = test::level_2(truth, 100, 0.05, random);
  // the engaged edge grows with the chip, as with one feed and one depth
  for (ForceRow& row : log.rows) row.edge = 1e5 * row.removal / (row.speed * row.radius);
  const auto fit = fit_laws(log).at(0);
  EXPECT_EQ(constant(fit, "chip_tangential_N_mm2"), nullptr);
  EXPECT_EQ(constant(fit, "edge_radial_N_mm"), nullptr);
  ASSERT_EQ(fit.undetermined.size(), 2U);
  EXPECT_NE(
      fit.undetermined[0].find("chip_tangential_N_mm2 and edge_tangential_N_mm: these constants"),
      std::string::npos)
      << fit.undetermined[0];
  EXPECT_NE(fit.undetermined[0].find("cut at several feeds"), std::string::npos);
  // nor one in which both are constant, or no edge is engaged at all
  for (ForceRow& row : log.rows) {
    row.removal = 4e-9;
    row.speed = 3000;
    row.edge = 1e-3;
  }
  EXPECT_EQ(fit_laws(log).at(0).undetermined.size(), 2U);
  for (ForceRow& row : log.rows) row.edge = 0;
  EXPECT_EQ(fit_laws(log).at(0).undetermined.size(), 2U);
}

TEST(Laws, TooFewRowsTellNothing) {
  BURR_FIT_SEEDED(random, 9);
  const Truth truth;
  for (const std::size_t rows : {0U, 1U, 2U}) {
    const auto fit = fit_laws(test::level_1(truth, rows, 0, 0, random)).at(0);
    EXPECT_TRUE(fit.constants.empty());
    ASSERT_EQ(fit.undetermined.size(), 2U) << rows;
    EXPECT_NE(fit.undetermined[0].find("are needed"), std::string::npos) << fit.undetermined[0];
  }
  EXPECT_EQ(fit_laws(test::level_1(truth, 3, 0, 0, random)).at(0).constants.size(), 2U);
  const auto three = fit_laws(test::level_2(truth, 3, 0, random)).at(0);
  EXPECT_EQ(three.constants.size(), 2U) << "two columns ask for four rows";
}

TEST(Laws, ALogWithoutTangentialForceStillTellsTheEnergy) {
  BURR_FIT_SEEDED(random, 10);
  const Truth truth;
  ForceLog log = test::level_1(truth, 30, 0, 0, random);
  for (ForceRow& row : log.rows) row.tangential.reset();
  const auto fit = fit_laws(log).at(0);
  EXPECT_EQ(constant(fit, "cutting_friction"), nullptr);
  EXPECT_NEAR(constant(fit, "cutting_energy_J_mm3")->value / truth.energy, 1, 1e-9);
  for (ForceRow& row : log.rows) row.power.reset();
  EXPECT_EQ(fit_laws(log).at(0).undetermined.size(), 2U);
}

}  // namespace
}  // namespace burr::fit
