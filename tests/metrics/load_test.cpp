// Economy of motion, rest of the shaft, dwelling, heat, load on the motor and on the mind.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "burr/metrics/dwell.h"
#include "burr/metrics/economy.h"
#include "burr/metrics/heat.h"
#include "burr/metrics/motor_load.h"
#include "burr/metrics/reaction.h"
#include "burr/metrics/shaft.h"
#include "burr/rt/flags.h"
#include "metrics/metric_bones.h"
#include "metrics/ticks.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::Happening;
using test::kMm;

// Every tick of a made-up session.
template <class Maker>
void feed(Maker& maker, const std::vector<tick::TickRow>& rows) {
  MomentMaker moments(test::kRate);
  Moment now;
  for (const tick::TickRow& row : rows)
    if (moments.make(row, false, now)) maker.add(now);
}

// ---- M5

// 10 s along x at 2 mm/s, 1 mm^3/s: 20 mm of way, 10 mm^3. The region ends at x = 12 mm, and the burr
// of 1 mm still reaches into it at 13 mm: 6.5 s of 10 s are inside.
TEST(Economy, OfAStraightWayOutOfTheRegion) {
  const auto all = test::process(10, [](double t) {
    return Happening{.place = {2 * t * kMm, 0, 0}, .touching = true, .removal = 1e-9};
  });
  const Region steps = in_half_space({12 * kMm, 0, 0}, {1, 0, 0});
  const Economy found = economy_of(all.track, all.paths.all, 20, steps);
  EXPECT_NEAR(found.path, 20 * kMm, 0.1 * kMm);
  EXPECT_NEAR(found.volume, 10e-9, 0.01e-9);
  ASSERT_TRUE(found.outside_share && found.per_path && found.strokes_per_volume);
  EXPECT_NEAR(*found.outside_share, 0.35, 0.005);
  EXPECT_NEAR(*found.per_path, 6.5e-9 / (20 * kMm), 0.01 * 6.5e-9 / (20 * kMm));
  EXPECT_NEAR(*found.strokes_per_volume, 2e9, 0.01e9);  // 20 strokes in 10 mm^3
}

TEST(Economy, WithoutRegionsOrCuttingIsNoAnswer) {
  const auto cut = test::process(1, [](double) { return Happening{.removal = 1e-9}; });
  EXPECT_FALSE(economy_of(cut.track, 0.01, 3, {}).outside_share);
  EXPECT_TRUE(economy_of(cut.track, 0.01, 3, {}).strokes_per_volume);
  const auto idle = test::process(1, [](double) { return Happening{}; });
  EXPECT_FALSE(economy_of(idle.track, 0.01, 0, in_ball(Vec3::Zero(), 1)).outside_share);
  EXPECT_FALSE(economy_of(idle.track, 0.01, 0, in_ball(Vec3::Zero(), 1)).strokes_per_volume);
}

// ---- M15

// A tool that stands on end beside a wall: its shaft goes `deep` into the wall.
TEST(Shaft, IsInBoneFromItsSurfaceOnAtThreeResolutions) {
  for (const double h : test::kVoxels) {
    test::Plan plan;
    plan.lo = {-6 * kMm, -4 * kMm, -4 * kMm};
    plan.hi = {6 * kMm, 4 * kMm, 30 * kMm};
    plan.bone = [](const Vec3& p) { return -p.x() - 2 * kMm; };  // bone at x < -2 mm
    const auto wall = test::build(plan, plan.bone, h);
    const DrawnShaft shaft{1.2 * kMm, 60 * kMm};
    // how far the shaft's surface is from the wall when it is first seen in it; 1 mm: never
    double first = 1 * kMm;
    for (double gap = 0.5 * kMm; gap > -0.5 * kMm && first == 1 * kMm; gap -= 0.01 * kMm)
      if (shaft_in_bone(*wall, {-2 * kMm + shaft.radius + gap, 0, 0}, Vec3::UnitZ(), 1 * kMm,
                        shaft))
        first = gap;
    EXPECT_NEAR(first, 0, 0.05 * kMm) << h;
    // the head itself may be in the wall: it is not the shaft
    EXPECT_FALSE(shaft_in_bone(*wall, {-2 * kMm, 0, 0}, Vec3::UnitX(), 1 * kMm, shaft));
  }
}

// In the wall from 1 s to 2 s of 4 s.
TEST(Shaft, CountsTheTimeInBone) {
  test::Plan plan;
  plan.lo = {-6 * kMm, -4 * kMm, -4 * kMm};
  plan.hi = {6 * kMm, 4 * kMm, 30 * kMm};
  plan.bone = [](const Vec3& p) { return -p.x() - 2 * kMm; };
  const auto wall = test::build(plan, plan.bone, 0.4 * kMm);
  const auto rows = test::rows_of(4, [](double t) {
    return Happening{.place = {(t >= 1 && t < 2 ? -2 : 2) * kMm, 0, 0}};
  });
  ShaftInBoneMaker maker({1.2 * kMm, 60 * kMm});
  MomentMaker moments(test::kRate);
  Moment now;
  for (const tick::TickRow& row : rows)
    if (moments.make(row, false, now) && maker.add(now)) maker.look(*wall);
  const auto found = maker.finish();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->seconds, 1, 0.11);
  EXPECT_NEAR(found->first_at, 1, 0.11);
  EXPECT_NEAR(found->looked, 4, 0.11);
}

TEST(Shaft, RestsAsTheTicksSay) {
  auto rows = test::rows_of(3, [](double) { return Happening{}; });
  for (tick::TickRow& row : rows) {
    const bool rests = (row.tick >= 500 && row.tick < 750) || (row.tick >= 2000 && row.tick < 2100);
    if (rests) row.contact.flags |= rt::kFlagShaft;
    row.contact.unsent_torque = {0, row.tick == 2050 ? 0.02 : rests ? 0.01 : 0.05, 0};
  }
  ShaftRestMaker deaf;
  feed(deaf, test::rows_of(1, [](double) { return Happening{}; }));
  EXPECT_FALSE(deaf.finish());

  MomentMaker moments(test::kRate, true);
  ShaftRestMaker maker;
  Moment now;
  for (const tick::TickRow& row : rows)
    if (moments.make(row, false, now)) maker.add(now);
  const auto found = maker.finish();
  ASSERT_TRUE(found) << found.reason();
  EXPECT_EQ(found->contacts, 2U);
  EXPECT_NEAR(found->seconds, 0.35, 1e-9);
  EXPECT_NEAR(found->largest_twist, 0.02, 1e-12);
  EXPECT_NEAR(found->largest_at, 2.05, 1e-9);
}

// ---- M17

// It stays for 4 s, moves on, stays for 2 s, and rubs over 3 mm for 5 s.
TEST(Dwell, CountsLongStaysInOnePlaceOnly) {
  const auto rows = test::rows_of(12, [](double t) {
    Happening now{.touching = true};
    if (t < 4)
      now.place = {0.3 * kMm * std::sin(20 * t), 0, 0};
    else if (t < 6)
      now.place = {20 * kMm, 0, 0};
    else
      now.place = {40 * kMm + 1.5 * kMm * std::sin(2 * std::numbers::pi * t), 0, 0};
    now.spindle = t < 11.5 ? 5000 : 0;
    return now;
  });
  DwellMaker maker;
  feed(maker, rows);
  const auto found = maker.finish();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->count, 1U);
  EXPECT_NEAR(found->seconds, 4, 0.01);
  EXPECT_NEAR(found->longest, 4, 0.01);
  EXPECT_EQ(found->longest_at, 0);
  DwellMaker still;  // a burr that does not turn warms nothing
  feed(still, test::rows_of(5, [](double) { return Happening{.touching = true, .spindle = 0}; }));
  EXPECT_FALSE(still.finish());
}

// 2 W for 5 s into a half-space, then 5 s of rest.
Heat warmed(double h, bool wet) {
  test::Plan plan;
  plan.lo = Vec3::Constant(-12 * kMm);
  plan.hi = Vec3::Constant(12 * kMm);
  plan.bone = [](const Vec3& p) { return -p.z(); };
  const auto bone = test::build(plan, plan.bone, h);
  auto rows = test::rows_of(10, [wet](double t) {
    Happening now{.place = {0, 0, 1 * kMm}, .touching = true, .removal = t < 5 ? 1e-15 : 0};
    now.tool.irrigated = wet;
    return now;
  });
  for (tick::TickRow& row : rows) row.cutting_w = row.tick < 5000 ? 2 : 0;
  HeatMaker maker(*bone, math::Aabb{Vec3::Constant(-11 * kMm), Vec3::Constant(11 * kMm)}, {});
  feed(maker, rows);
  const auto heat = maker.finish();
  EXPECT_TRUE(heat);
  return heat ? *heat : Heat{};
}

TEST(HeatOf, GivesThePowerToTheBoneAtThreeResolutions) {
  std::vector<double> peaks;
  for (const double h : test::kVoxels) {
    const Heat heat = warmed(h, false);
    EXPECT_NEAR(heat.ledger.spent, 10, 0.01) << h;  // 2 W for 5 s
    EXPECT_NEAR(heat.ledger.into, 2.5, 0.01) << h;  // a quarter stays: chips carry the rest away
    ASSERT_EQ(heat.tissues.size(), 1U);
    EXPECT_EQ(heat.tissues[0].name, "bone");
    EXPECT_GT(heat.tissues[0].cem43_min, 1) << h;
    peaks.push_back(heat.tissues[0].peak_c - 37);
  }
  std::printf("peak rise %.1f %.1f %.1f K\n", peaks[0], peaks[1], peaks[2]);
  // the cells are 1 mm for the two finer bones, and 0.8 mm for the coarse one: a smaller heated ball
  EXPECT_NEAR(peaks[1] / peaks[2], 1, 0.05);
  EXPECT_GT(peaks[0], peaks[1]);
}

TEST(HeatOf, IsLessUnderWater) {
  const Heat dry = warmed(0.4 * kMm, false), wet = warmed(0.4 * kMm, true);
  ASSERT_EQ(wet.tissues.size(), 1U);
  EXPECT_LT(wet.tissues[0].peak_c, dry.tissues[0].peak_c - 1);
  EXPECT_EQ(dry.ledger.convected, 0);
  EXPECT_GT(wet.ledger.convected, 0.1);
}

TEST(HeatOf, WithoutPowerIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  HeatMaker maker(*bone, math::Aabb{Vec3::Constant(-6 * kMm), Vec3::Constant(6 * kMm)}, {});
  feed(maker, test::rows_of(1, [](double) { return Happening{.touching = true}; }));
  EXPECT_FALSE(maker.finish());
}

// ---- M20

TEST(MotorLoad, CountsSlowAndStandingSpindles) {
  auto rows = test::rows_of(10, [](double t) {
    return Happening{.touching = t >= 1, .spindle = t < 4 ? 5000.0 : t < 6 ? 3900.0 : 4100.0};
  });
  for (tick::TickRow& row : rows) {
    row.hand.pedal = row.tick < 9000 ? 1 : 0;  // the last second: the foot is off
    row.cutting_nm = row.tick == 5000 ? 0.03 : 0.01;
    row.cutting_w = 4;
    if (row.tick >= 5500 && row.tick < 5600) row.contact.flags |= rt::kFlagStalled;
  }
  MotorLoadMaker maker;
  feed(maker, rows);
  const auto found = maker.finish();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->contact, 8, 1e-9);
  EXPECT_NEAR(found->slowed, 2, 1e-9);
  EXPECT_NEAR(found->stalled, 0.1, 1e-9);
  EXPECT_NEAR(found->energy, 32, 1e-9);
  EXPECT_EQ(found->peak_torque, 0.03);
  EXPECT_NEAR(found->peak_at, 5, 1e-9);
  EXPECT_FALSE(MotorLoadMaker().finish());
}

record::CourseEvent event(double t, record::CourseKind kind, const char* what) {
  record::CourseEvent out;
  out.tick = static_cast<std::uint64_t>(std::llround(1000 * t));
  out.kind = kind;
  out.what = what;
  return out;
}

TEST(Reaction, IsTheMedianOfTheAnsweredCues) {
  using enum record::CourseKind;
  std::vector<record::CourseEvent> course = {event(1, question, "why"), event(2, answer, "why")};
  const double waits[] = {0.4, 0.9, 0.5, 0.6, 0.7};
  for (int n = 0; n < 5; ++n) {
    course.push_back(event(30 * n + 30, question, "cue"));
    course.push_back(event(30 * n + 30 + waits[n], answer, "cue"));
  }
  course.push_back(event(200, question, "cue"));  // answered too late
  course.push_back(event(211, answer, "cue"));
  course.push_back(event(230, question, "cue"));  // never
  const auto cues = cues_of(course, 1000);
  const auto found = reaction_of(cues, 0.5);
  ASSERT_TRUE(found) << found.reason();
  EXPECT_EQ(found->cues, 7U);
  EXPECT_EQ(found->missed, 2U);
  EXPECT_NEAR(found->median, 0.6, 1e-9);
  ASSERT_TRUE(found->load);
  EXPECT_NEAR(*found->load, 0.2, 1e-9);
  EXPECT_FALSE(reaction_of(cues, std::nullopt)->load);
  EXPECT_FALSE(reaction_of(std::span(cues).first(4), 0.5));
}

}  // namespace
}  // namespace burr::metrics
