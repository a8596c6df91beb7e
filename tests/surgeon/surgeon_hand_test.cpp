// The hand of a scripted surgeon: its stop delay, its restraint, its way.
#include "burr/surgeon/surgeon_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burr/phantom/build.h"
#include "support/rt_guard.h"
#include "surgeon/surgeon_bone.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr double kTick = 1e-3, kRadius = 1 * kMm;

// All above z = `floor` may go.
FieldGrid goal_above(double floor) {
  FieldGrid goal(phantom::box_grid(Vec3::Constant(-10 * kMm), Vec3::Constant(10 * kMm), 0.5 * kMm));
  for (std::size_t n = 0; n < goal.nodes(); ++n)
    goal.value[n] = static_cast<float>(goal.node(n).z() - floor);
  return goal;
}

Skill steady(double stop_delay) {
  Skill skill;
  skill.tremor = skill.drift = skill.force_noise = 0;
  skill.stop_delay = stop_delay;
  return skill;
}

Stroke downwards(const Vec3& start) {
  Stroke stroke;
  stroke.start = start;
  stroke.along = Vec3::UnitX();
  stroke.into = -Vec3::UnitZ();
  stroke.length = 3 * kMm;
  return stroke;
}

// How far below the goal the burr's lowest point gets in free air, and for how long it goes on
// downwards after the goal has ended.
struct Overshoot {
  double depth = 0, seconds = 0;
};
Overshoot overshoot(double stop_delay) {
  const FieldGrid goal = goal_above(0);
  SurgeonHand hand(steady(stop_delay), kTick, 1, Vec3(0, 0, 3 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  hand.begin(downwards(Vec3(0, 0, 2 * kMm)), kRadius);
  Overshoot out;
  double lowest = 1;
  int crossed = -1;
  for (int n = 0; n < 20'000; ++n) {
    const double z = hand.state(kTick).world_from_tool.p.z() - kRadius;
    if (crossed < 0 && z < 0) crossed = n;
    if (z < lowest) {
      lowest = z;
      if (crossed >= 0) out.seconds = kTick * (n - crossed + 1);
    } else if (crossed >= 0) {
      break;
    }
  }
  out.depth = -lowest;
  return out;
}

TEST(SurgeonHand, GoesOnForItsStopDelayAfterTheGoalHasEnded) {
  for (const double delay : {0.1, 0.2, 0.45}) {
    const Overshoot over = overshoot(delay);
    EXPECT_NEAR(over.seconds, delay, 3 * kTick);
    EXPECT_NEAR(over.depth, 1e-3 * delay, 0.02 * kMm);  // at 1 mm/s
  }
}

TEST(SurgeonHand, PressesLessBesideWhatIsSparedByItsRestraint) {
  const FieldGrid goal = goal_above(-1);  // far below
  FieldGrid far = goal_above(-1), beside = goal_above(-1);
  for (float& one : far.value) one = 1;
  for (float& one : beside.value) one = static_cast<float>(kRadius);
  double settled[2] = {};
  for (const int which : {0, 1}) {
    SurgeonHand hand(steady(0.1), kTick, 1, Vec3(0, 0, 1 * kMm), Vec3::UnitZ());
    hand.look_at(&goal, which == 0 ? &far : &beside);
    hand.begin(downwards(Vec3(0, 0, 0)), kRadius);
    // a wall at z = 0 with a spring of 1000 N/m
    double force = 0;
    for (int n = 0; n < 2000; ++n) {
      const double z = hand.state(kTick).world_from_tool.p.z();
      force = std::max(0.0, -1000 * z);
      hand.write_force(Vec3(0, 0, force));
    }
    settled[which] = force;
  }
  EXPECT_NEAR(settled[0], Skill{}.force, 0.02);
  EXPECT_NEAR(settled[1], Skill{}.force * Skill{}.restraint, 0.02);
}

TEST(SurgeonHand, StartsItsStrokeWhereTheWayMeetsBone) {
  const FieldGrid goal = goal_above(-1);
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3(0, 0, 5 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  hand.begin(downwards(Vec3(0, 0, -5 * kMm)), kRadius);
  double lowest = 1;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = hand.state(kTick).world_from_tool.p;
    lowest = std::min(lowest, p.z());
    hand.write_force(Vec3(0, 0, std::max(0.0, -1000 * p.z())));
  }
  EXPECT_GT(lowest, -1.5 * kMm);  // pressed with 1.2 N, not driven to the point behind
}

// The plan ends at a wall across the stroke. A hand that is past it by 0.05 mm goes no farther.
TEST(SurgeonHand, AStrokeThatHasLeftThePlanTurnsBack) {
  FieldGrid goal = goal_above(0);
  for (std::size_t n = 0; n < goal.nodes(); ++n)
    goal.value[n] = static_cast<float>(-goal.node(n).x());
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3(-0.95 * kMm, 0, 3 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  hand.begin(downwards(Vec3(-0.95 * kMm, 0, 2 * kMm)), kRadius);
  double farthest = -1;
  for (int n = 0; n < 3000; ++n)
    farthest = std::max(farthest, hand.state(kTick).world_from_tool.p.x());
  EXPECT_LT(farthest, -0.9 * kMm);
}

// It presses on a ledge below a roof that must stay: where the plan ends it lifts along the way out, not up.
TEST(SurgeonHand, LiftsAlongTheWayOut) {
  FieldGrid goal = goal_above(0);
  for (std::size_t n = 0; n < goal.nodes(); ++n)
    goal.value[n] = static_cast<float>(-goal.node(n).z());
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3(0, 0, -0.9 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  Stroke stroke = downwards(Vec3(0, 0, -0.9 * kMm));
  stroke.out = -Vec3::UnitY();
  hand.begin(stroke, kRadius);
  double highest = -1, away = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = hand.state(kTick).world_from_tool.p;
    hand.write_force(Vec3(0, 0, 0.1));
    highest = std::max(highest, p.z());
    away = std::min(away, p.y());
  }
  EXPECT_LT(highest, -0.85 * kMm);
  EXPECT_LT(away, -1 * kMm);
}

// The plan is a ridge: from its crest there is room for 0.3 mm to either side. Nobody goes to and fro there for
// the whole bout.
TEST(SurgeonHand, GivesUpABoutThatHasNoRoom) {
  FieldGrid goal = goal_above(-1);
  for (std::size_t n = 0; n < goal.nodes(); ++n)
    goal.value[n] = static_cast<float>(kRadius + 0.3 * kMm - std::abs(goal.node(n).x()));
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3(0, 0, 0), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  hand.begin(downwards(Vec3(0, 0, 0)), kRadius);
  int ticks = 0;
  for (; ticks < 3000 && !hand.free(); ++ticks) static_cast<void>(hand.state(kTick));
  EXPECT_LT(kTick * ticks, 0.7);  // a bout takes 1.5 s
}

// A wall that does not give way, 1 mm from the start: the hand does not lean on it for the rest of the bout.
TEST(SurgeonHand, SweepsBackWhereItIsHeldUp) {
  const FieldGrid goal = goal_above(-1);
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3(0, 0, 0), Vec3::UnitZ());
  hand.look_at(&goal, nullptr);
  hand.begin(downwards(Vec3(0, 0, 0)), kRadius);
  bool met = false, back = false;
  for (int n = 0; n < 1400; ++n) {
    const Vec3 p = hand.state(kTick).world_from_tool.p;
    hand.write_force(1000 * Vec3(std::min(0.0, 1 * kMm - p.x()), 0, std::max(0.0, -p.z())));
    met = met || p.x() > 1.8 * kMm;
    back = back || (met && p.x() < 0.3 * kMm);
  }
  EXPECT_TRUE(met);
  EXPECT_TRUE(back);
}

TEST(SurgeonHand, RetreatsWithThePedalUpAndWaits) {
  SurgeonHand hand(steady(0.1), kTick, 1, Vec3::Zero(), Vec3::UnitZ());
  EXPECT_TRUE(hand.waiting());
  hand.retreat(Vec3::UnitZ(), 20 * kMm);
  EXPECT_FALSE(hand.waiting());
  for (int n = 0; n < 300; ++n) EXPECT_EQ(hand.state(kTick).pedal, 0);
  EXPECT_TRUE(hand.waiting());
  EXPECT_NEAR(hand.intended().z(), 20 * kMm, 1e-9);
}

TEST(SurgeonHand, ATickTakesNoMemory) {
  const FieldGrid goal = goal_above(0);
  SurgeonHand hand(skill_of(Level::careless), kTick, 1, Vec3(0, 0, 3 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, &goal);
  hand.begin(downwards(Vec3(0, 0, 2 * kMm)), kRadius);
  const test::RtGuard guard;
  for (int n = 0; n < 1000; ++n) static_cast<void>(hand.state(kTick));
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

// Where the gap is full at the place that it touches, a hand that adds puts nothing there: it looks before the foot goes
// down, however long it takes to see. Where there is room it begins to add when it has seen that.
double first_added_s(double border, double stop_delay) {
  FieldGrid goal = goal_above(border);
  for (float& value : goal.value) value = -value;  // below the border there is room
  SurgeonHand hand(steady(stop_delay), kTick, 1, Vec3(0, 0, 3 * kMm), Vec3::UnitZ());
  hand.look_at(&goal, nullptr, true);
  Stroke stroke = downwards(Vec3(0, 0, 1.2 * kMm));
  stroke.idle_way = true;
  hand.begin(stroke, kRadius);
  double met = -1;
  for (int n = 0; n < 1500; ++n) {
    const device::HandState now = hand.state(kTick);
    const double z = now.world_from_tool.p.z();
    hand.write_force(1000 * std::max(0.0, kRadius - z) * Vec3::UnitZ());  // a surface at z = 0
    if (z < kRadius && met < 0) met = kTick * n;
    if (now.pedal > 0) return met < 0 ? 0 : kTick * n - met;
  }
  return -1;
}

TEST(SurgeonHand, WhoAddsLooksBeforeTheFootGoesDown) {
  for (const double delay : {0.0, 0.2, 0.45}) {
    EXPECT_EQ(first_added_s(-0.5 * kMm, delay), -1)
        << "nothing may be added there; delay " << delay;
    const double waits = first_added_s(3 * kMm, delay);
    EXPECT_GE(waits, delay - 0.1);
    EXPECT_LE(waits, delay + 0.05);
  }
}

}  // namespace
}  // namespace burr::surgeon
