#include "burr/thermal/dose.h"

#include <gtest/gtest.h>

#include "thermal/blocks.h"

namespace burr::thermal {
namespace {

TEST(Cem43, KnowsTheThresholdsOfTheBooks) {
  EXPECT_DOUBLE_EQ(cem43_rate(43), 1);
  EXPECT_DOUBLE_EQ(cem43_rate(47) * 1.0, 16);  // one minute
  EXPECT_DOUBLE_EQ(cem43_rate(50) * 0.5, 64);  // half a minute
  EXPECT_DOUBLE_EQ(cem43_rate(42), 0.25);
  EXPECT_DOUBLE_EQ(cem43_rate(40), 1.0 / 64);
}

TEST(Cem43, BodyTemperatureDoesNoHarmHoweverLong) {
  EXPECT_EQ(cem43_rate(37), 0);
  EXPECT_EQ(cem43_rate(38.9), 0);
  EXPECT_GT(cem43_rate(39), 0);
}

// A lump that loses no heat keeps its temperature, so its dose has a closed form.
TEST(Cem43, OfALumpThatStaysWarmIsTheClosedForm) {
  struct Case {
    double t_c, seconds, dose_min;
  };
  for (const Case& c : {Case{47, 60, 16}, Case{50, 30, 64}, Case{42, 120, 0.5}, Case{38, 600, 0}}) {
    SCOPED_TRACE(c.t_c);
    const auto bone = test::block({2, 1, 1}, 1e-3);
    HeatGrid heat(*bone, test::everything(*bone), {});
    const double capacity = HeatSettings{}.bone.capacity() * 1e-9;
    for (int i = 0; i < 2; ++i) heat.deposit(heat.centre({i, 0, 0}), 0, capacity * (c.t_c - 37));
    ASSERT_NEAR(heat.temperature_c({0, 0, 0}), c.t_c, 1e-9);
    heat.advance(c.seconds);
    EXPECT_NEAR(heat.cem43_min({1, 0, 0}), c.dose_min, 1e-8 * c.dose_min);
    HeatSummary summary;
    heat.summarise(summary);
    EXPECT_NEAR(summary.tissue[1].cem43_min, c.dose_min, 1e-8 * c.dose_min);
  }
}

}  // namespace
}  // namespace burr::thermal
