// Made recordings with known forces, distances, times and burrs.
#include "burr/metrics/process.h"
#include "burr/metrics/speed_near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "burr/metrics/order.h"
#include "burr/metrics/visibility.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "metrics/metric_bones.h"
#include "metrics/ticks.h"
#include "record/made_up.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::Happening;
using test::kMm;

// A soft ball of 2 mm about the origin in a block of bone.
class ProcessTest : public ::testing::Test {
 protected:
  static constexpr double kVoxel = 0.25e-3;
  ProcessTest() {
    const phantom::Depth ball = phantom::ball(2 * kMm);
    plan_.hi.x() = 18 * kMm;
    plan_.bone = phantom::without(test::below(6 * kMm), ball);
    plan_.labels = {{ball, test::kNerve}};
    bone_ = test::build(plan_, plan_.bone, kVoxel);
    nerve_ = test::distance_to(*bone_, test::kNerve);
    voxels_ = test::voxels_of(*bone_, test::kNerve);
    settings_.critical = {{"nerve", nerve_.get()}};
  }
  test::Plan plan_;
  std::unique_ptr<volume::Bone> bone_;
  std::shared_ptr<const volume::DistanceTo> nerve_;
  VoxelSet voxels_;
  ProcessSettings settings_;
};

// A tool of the rack is as near as its cutting parts are, wherever it is held: here a rod of 2 mm that lies across,
// 10 mm long, with its end where the hand holds it.
TEST_F(ProcessTest, AToolOfTheRackIsAsNearAsItsCuttingParts) {
  tool::ShapedTool rod;
  constexpr double kEdge = 0.2 * kMm;
  const auto add = [&rod](double radius, double middle, tool::Role role) {
    ASSERT_TRUE(tool::add_part(
        rod.tool, {{tool::ShapeKind::cylinder, radius - kEdge, 0, 5 * kMm - kEdge, kEdge},
                   {{0, 0, middle}, math::Quat::Identity()},
                   role}));
  };
  add(1 * kMm, 5 * kMm, tool::Role::cuts);
  add(3 * kMm, 15 * kMm, tool::Role::rubs);  // a handle: it does not cut
  MomentMaker moments(test::kRate, false, {rod});
  Distances distances({{"nerve", nerve_.get()}});
  tick::TickRow row;
  row.tool = {.radius = 1.5 * kMm, .full_speed = 5000};
  row.tool.number = 0;
  row.hand.world_from_tool.q = math::Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  const auto at = [&](const Vec3& p) {
    row.contact.proxy = row.hand.world_from_tool.p = p;
    Moment now;
    EXPECT_TRUE(moments.make(row, false, now));
    distances.update(now);
    EXPECT_NEAR(now.tool.radius, 1 * kMm, 0.02 * kMm);
    return distances.of(0);
  };
  EXPECT_NEAR(at({-5 * kMm, 0, 8 * kMm}), 5 * kMm, 0.15 * kMm) << "its middle is over the ball";
  EXPECT_NEAR(at({4 * kMm, 0, 0}), 2 * kMm, 0.15 * kMm) << "its end";
  EXPECT_LT(at({-5 * kMm, 0, 2 * kMm}), 0) << "in it";
  // contact has turned it away: its end is over the ball
  row.contact.turn = Vec3(0, -0.5 * std::numbers::pi, 0);
  EXPECT_NEAR(at({0, 0, 4 * kMm}), 2 * kMm, 0.15 * kMm);
  row.contact.turn = Vec3::Zero();
  EXPECT_GT(at({-5 * kMm, 0, 60 * kMm}), 12 * kMm);
  // the round burr
  row.tool.number = -1;
  row.tool.radius = 1 * kMm;
  EXPECT_NEAR(at({4 * kMm, 0, 0}), 1 * kMm, 0.1 * kMm);
}

// Q1: straight down the z axis towards the ball, 10 mm/s from d = 5 mm to d = 0.4 mm, then still;
// force 0.5 N and cutting all the time. The burr's radius is 1 mm.
TEST_F(ProcessTest, NearnessOfAStraightApproach) {
  const auto story = [](double t) {
    Happening now;
    now.place.z() = std::max(8 - 10 * t, 3.4) * kMm;
    now.touching = true;
    now.force = 0.5;
    now.removal = 1e-9;
    return now;
  };
  const Process done = test::process(1.46, story, settings_);
  ASSERT_EQ(done.nearness.size(), 1U);
  EXPECT_EQ(done.nearness[0].name, "nerve");
  ASSERT_TRUE(done.nearness[0].found) << done.nearness[0].found.reason();
  const Nearness& near = *done.nearness[0].found;
  EXPECT_NEAR(near.least, 0.4 * kMm, 0.5 * kVoxel);
  EXPECT_NEAR(near.least_at, 0.46, 0.02);
  EXPECT_NEAR(near.least_place.z(), 3.4 * kMm, 0.2 * kMm);
  // d falls below 2 mm at 0.3 s, below 1 mm at 0.4 s, below 0.5 mm at 0.45 s; then 1 s of standing
  const double slack = 0.5 * kVoxel / 10e-3 + 2e-3;
  EXPECT_NEAR(near.cutting_within[0], 1.16, slack);
  EXPECT_NEAR(near.cutting_within[1], 1.06, slack);
  EXPECT_NEAR(near.cutting_within[2], 1.01, slack);
  ASSERT_TRUE(near.approach);
  EXPECT_NEAR(*near.approach, 10e-3, 2e-3);
  EXPECT_NEAR(done.paths.all, 4.6 * kMm, 0.1 * kMm);
  EXPECT_EQ(done.paths.free, 0);
  EXPECT_NEAR(done.times.total, 1.46, 1e-9);
  EXPECT_NEAR(done.times.cutting, 1.459, 2e-3);
}

TEST_F(ProcessTest, FarAwayThereIsNoNearness) {
  const Process done = test::process(
      0.2,
      [](double) {
        return Happening{.place = {0, 0, 60 * kMm}};
      },
      settings_);
  ASSERT_TRUE(done.nearness[0].found);
  EXPECT_EQ(done.nearness[0].found->least, kFar);
  EXPECT_FALSE(done.nearness[0].found->approach);
  ASSERT_FALSE(done.force);
  EXPECT_NE(done.force.reason().find("never touched"), std::string::npos);
  ASSERT_FALSE(done.choice);
  EXPECT_NE(done.choice.reason().find("nothing was removed"), std::string::npos);
  EXPECT_NEAR(done.times.free, 0.2, 1e-9);
}

// Q5: 1 N for 1 s at d = 6 mm, 0.4 N for 2 s at d = 1.5 mm, 3 N for 10 ms at d = 3 mm
TEST_F(ProcessTest, ForceByDistance) {
  const auto story = [](double t) {
    Happening now;
    now.touching = true;
    now.place.x() = (t < 1 ? 9 : t < 3 ? 4.5 : 6) * kMm;
    now.force = t < 1 ? 1.0 : t < 3 ? 0.4 : 3.0;
    return now;
  };
  const Process done = test::process(3.01, story, settings_);
  ASSERT_TRUE(done.force) << done.force.reason();
  const ForceNear& force = *done.force;
  EXPECT_NEAR(force.mean, (1 + 0.8 + 0.03) / 3.01, 1e-6);
  EXPECT_NEAR(force.p95, 1.0, 0.011);
  EXPECT_DOUBLE_EQ(force.peak, 3.0);
  EXPECT_NEAR(force.peak_at, 3.0, 1e-9);
  ASSERT_TRUE(done.force->by_distance);
  const ForceByDistance& by = *done.force->by_distance;
  EXPECT_NEAR(by.time[1], 2.0, 1e-6);
  EXPECT_NEAR(by.time[3], 1.0, 1e-6);
  EXPECT_EQ(by.time[0], 0);
  EXPECT_FALSE(by.bin_mean[0]);
  ASSERT_TRUE(by.bin_mean[1] && by.bin_mean[2] && by.bin_mean[3]);
  EXPECT_NEAR(*by.bin_mean[1], 0.4, 1e-9);
  EXPECT_NEAR(*by.bin_mean[3], 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(by.bin_peak[2], 3.0);
  ASSERT_TRUE(by.restraint);
  EXPECT_NEAR(*by.restraint, 0.4, 1e-9);
  // too little time far away: no ratio
  const Process brief = test::process(
      1.2, [&](double t) { return story(t + 0.8); }, settings_);
  ASSERT_TRUE(brief.force && brief.force->by_distance);
  EXPECT_FALSE(brief.force->by_distance->restraint);
}

// Round the nerve: at 20 mm/s 6 mm away, then at 5 mm/s 1.5 mm away, cutting; then at 40 mm/s without.
TEST_F(ProcessTest, SpeedByDistance) {
  const auto story = [](double t) {
    Happening now;
    now.touching = true;
    // nothing is cut while the hand changes place, which takes no time here
    now.removal = t < 1.7 || (t > 2.3 && t < 3.7) ? 1e-9 : 0;
    const double radius = (t < 2 ? 9 : 4.5) * kMm;
    const double way = (t < 2 ? 20 * t : t < 4 ? 5 * (t - 2) : 10 + 40 * (t - 4)) * kMm;
    now.place = radius * Vec3(std::cos(way / radius), std::sin(way / radius), 0);
    return now;
  };
  const auto speed = speed_near(test::process(4.5, story, settings_).track);
  ASSERT_TRUE(speed) << speed.reason();
  EXPECT_NEAR(speed->time[3], 1.7, 0.03);
  EXPECT_NEAR(speed->time[1], 1.4, 0.03);
  EXPECT_EQ(speed->time[0], 0);
  EXPECT_FALSE(speed->bin_mean[0]);
  ASSERT_TRUE(speed->bin_mean[3] && speed->bin_mean[1]);
  EXPECT_NEAR(*speed->bin_mean[3], 20e-3, 0.3e-3);
  EXPECT_NEAR(*speed->bin_mean[1], 5e-3, 0.3e-3);
  ASSERT_TRUE(speed->ratio);
  EXPECT_NEAR(*speed->ratio, 0.25, 0.02);
  // only near: no ratio
  const auto near = speed_near(test::process(
                                   2, [&](double t) { return story(t + 2); }, settings_)
                                   .track);
  ASSERT_TRUE(near);
  EXPECT_NEAR(*near->bin_mean[1], 5e-3, 3e-4);
  EXPECT_FALSE(near->ratio);
  const auto never = speed_near(test::process(
                                    0.4, [&](double t) { return story(t + 4); }, settings_)
                                    .track);
  EXPECT_FALSE(never);
}

// Q9: a diamond of 1 mm near, a cutting burr of 3 mm far away, and a cutting one of 3 mm near for a
// quarter of the volume there
TEST_F(ProcessTest, ChoiceOfBurr) {
  const auto story = [](double t) {
    Happening now;
    now.removal = 1e-9;
    if (t < 1) {
      now.place.x() = 12 * kMm;
      now.tool.radius = 3 * kMm;
    } else if (t < 1.75) {
      now.place.x() = 4 * kMm;
      now.tool.kind = tool::BurrKind::diamond;
    } else {
      now.place.x() = 6 * kMm;
      now.tool.radius = 3 * kMm;
    }
    return now;
  };
  const Process done = test::process(2.0, story, settings_);
  ASSERT_TRUE(done.choice) << done.choice.reason();
  EXPECT_NEAR(done.choice->near_volume, 1e-9, 3e-12);
  EXPECT_NEAR(done.choice->far_volume, 1e-9, 3e-12);
  ASSERT_TRUE(done.choice->diamond && done.choice->small && done.choice->large_cutting);
  EXPECT_NEAR(*done.choice->diamond, 0.75, 0.002);
  EXPECT_NEAR(*done.choice->small, 0.75, 0.002);
  EXPECT_NEAR(*done.choice->diamond_or_small, 0.75, 0.002);
  EXPECT_EQ(*done.choice->large_cutting, 1);
}

// a peak of one tick is kept, and the burr changes with its tick
TEST_F(ProcessTest, TrackKeepsThePeakForceAndTheBurr) {
  const auto story = [](double t) {
    Happening now;
    now.force = std::abs(t - 0.507) < 1e-6 ? 7 : 2;
    if (t >= 0.7) now.tool = {.radius = 3e-3, .full_speed = 5000, .kind = tool::BurrKind::diamond};
    return now;
  };
  const Track track = test::process(1.0, story, settings_).track;
  ASSERT_EQ(track.samples.size(), 100U);
  EXPECT_EQ(track.samples[50].force, 7);
  EXPECT_EQ(track.samples[51].force, 2);
  EXPECT_FALSE(track.samples[69].diamond);
  EXPECT_EQ(track.samples[69].radius, 1e-3);
  EXPECT_TRUE(track.samples[70].diamond);
  EXPECT_EQ(track.samples[70].radius, 3e-3);
}

// Q6: the burr goes into the soft ball by p and out again, twice
struct Pass {
  double p;
  double spindle = 5000;
  tool::BurrKind kind = tool::BurrKind::cutting;
};
Happening pass_at(const Pass& pass, double t) {
  Happening now;
  const double swing = 0.5 * (1 - std::cos(2 * std::numbers::pi * t));  // 0, 1, 0, 1, 0 in 2 s
  now.place.z() = 6 * kMm + (3 * kMm - pass.p - 6 * kMm) * swing;
  now.spindle = pass.spindle;
  now.tool.kind = pass.kind;
  now.force = 0.2;
  return now;
}

TEST_F(ProcessTest, HowDeepABurrWentIntoSoftTissue) {
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  for (const double p : {0.0, 0.3, 0.8, 1.0}) {
    const Process done = test::process(
        2, [&](double t) { return pass_at({p * kMm}, t); }, settings_, bone_->grid());
    ASSERT_TRUE(done.soft[0].intact) << done.soft[0].intact.reason();
    const IntactSoft& nerve = *done.soft[0].intact;
    EXPECT_NEAR(nerve.entered.value, p * kMm, 0.5 * kVoxel) << p;
    EXPECT_EQ(nerve.entered.met, p < 0.5);
    if (p >= 0.3) {
      EXPECT_FALSE(nerve.touched.met);
      EXPECT_EQ(nerve.contact_count, 2U);
      ASSERT_EQ(nerve.contacts.size(), 2U);
      EXPECT_NEAR(nerve.contacts[0].depth, p * kMm, 0.5 * kVoxel);
      EXPECT_NEAR(nerve.contacts[0].begin + nerve.contacts[0].end, 1.0, 0.02);
      EXPECT_NEAR(nerve.contacts[1].begin + nerve.contacts[1].end, 3.0, 0.02);
      EXPECT_NEAR(nerve.contacts[0].mean_force, 0.2, 1e-9);
      EXPECT_NEAR(nerve.deepest_place.z(), (3 - p) * kMm, 0.1 * kMm);
    }
    // two balls, 2 and 1 mm, overlap by p
    const double r1 = 2, r2 = 1, d = 3 - p;
    const double truth = std::numbers::pi * p * p *
                         (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) * (r1 - r2)) / (12 * d) * 1e-9;
    EXPECT_NEAR(nerve.volume, truth, 0.15 * truth + 0.05e-9) << p;
  }
}

// A burr so fast that it passes the ball between two ticks, deepest in their middle.
TEST_F(ProcessTest, TheErrorHoldsWhatIsBetweenTwoTicks) {
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  for (const double way : {0.2, 1.0, 3.0}) {  // mm in a tick
    const Process done = test::process(
        0.02,
        [&](double t) {
          return Happening{.place = {(t * test::kRate - 10.5) * way * kMm, 0, 2.2 * kMm}};
        },
        settings_, bone_->grid());
    ASSERT_TRUE(done.soft[0].intact) << done.soft[0].intact.reason();
    const Mark& entered = done.soft[0].intact->entered;
    EXPECT_NEAR(entered.value, 0.8 * kMm, entered.error) << way;
    EXPECT_LT(entered.error, 0.5 * kVoxel + 0.5 * way * kMm + 1e-9);
    if (way > 2) {
      EXPECT_LT(entered.value + 0.5 * kVoxel, 0.8 * kMm);
    }
  }
}

TEST_F(ProcessTest, OnlyATurningBurrHarms) {
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  const Process still = test::process(
      2,
      [&](double t) {
        return pass_at({1 * kMm, 100}, t);
      },
      settings_, bone_->grid());
  ASSERT_FALSE(still.soft[0].intact);  // it never turned: nothing is known
  EXPECT_NE(still.soft[0].intact.reason().find("never turned"), std::string::npos);
  // in the bone it stands still, outside it turns
  const Process stopped = test::process(
      2,
      [&](double t) {
        Happening now = pass_at({1 * kMm}, t);
        if (now.place.z() < 4 * kMm) now.spindle = 200;
        return now;
      },
      settings_, bone_->grid());
  ASSERT_TRUE(stopped.soft[0].intact);
  EXPECT_TRUE(stopped.soft[0].intact->touched.met);
  EXPECT_EQ(stopped.soft[0].intact->contact_count, 0U);
}

TEST_F(ProcessTest, ADiamondMayTouch) {
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  for (const auto kind : {tool::BurrKind::cutting, tool::BurrKind::diamond}) {
    const Process done = test::process(
        2,
        [&](double t) {
          return pass_at({0.2 * kMm, 5000, kind}, t);
        },
        settings_, bone_->grid());
    ASSERT_TRUE(done.soft[0].intact);
    EXPECT_EQ(done.soft[0].intact->touched.met, kind == tool::BurrKind::diamond);
    EXPECT_TRUE(done.soft[0].intact->entered.met);
  }
}

TEST_F(ProcessTest, WhoDidNothingHasSparedNothing) {
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 0.05}};
  const Process done = test::process(
      2,
      [](double) {
        return Happening{.place = {0, 0, 7 * kMm}};
      },
      settings_, bone_->grid());
  ASSERT_TRUE(done.soft[0].intact);
  EXPECT_FALSE(done.soft[0].intact->entered.met);
  EXPECT_FALSE(done.soft[0].intact->entered.earned);
}

// Q8: three seconds of standing still near bone, and the same far from it
TEST_F(ProcessTest, HesitationIsALongPauseNearBone) {
  const std::array<volume::TissueId, 1> ids = {test::kBone};
  NoProgress quiet;
  auto made = volume::DistanceTo::make(*bone_, ids, {}, quiet);
  ASSERT_TRUE(made);
  settings_.bone = &*made;
  const auto story = [](double t) {
    Happening now;
    // cuts for 1 s, waits 3 s at 3 mm above the bone, cuts 1 s, waits 1.5 s, cuts, then far away
    const bool cuts = t < 1 || (t >= 4 && t < 5) || (t >= 6.5 && t < 7);
    now.removal = cuts ? 1e-9 : 0;
    now.place.z() = (cuts ? 6 : t < 7 ? 10 : 30) * kMm;
    now.tool.irrigated = t >= 4;
    return now;
  };
  const Process done = test::process(12, story, settings_);
  ASSERT_TRUE(done.times.hesitation) << done.times.hesitation.reason();
  EXPECT_EQ(done.times.hesitation->count, 1U);
  EXPECT_NEAR(done.times.hesitation->seconds, 3.0, 0.01);
  EXPECT_NEAR(done.times.cutting, 2.5, 0.01);
  EXPECT_NEAR(done.times.irrigated, 1.5, 0.01);
}

TEST_F(ProcessTest, ThePoleHardlyCuts) {
  const auto story = [](double t) {
    Happening now;
    now.touching = true;
    now.removal = 1e-9;
    const double theta = t < 1 ? 0.2 : 1.0;  // sine 0.199, 0.84
    now.normal = {std::sin(theta), 0, std::cos(theta)};
    return now;
  };
  const Process done = test::process(4, story);
  EXPECT_NEAR(done.times.pole_volume / done.times.volume, 0.25, 0.002);
}

TEST_F(ProcessTest, NumbersThatAreNotFiniteAreLeftOut) {
  auto rows = test::rows_of(1, [](double) {
    return Happening{.place = {0, 0, 5 * kMm}, .force = 1, .touching = true, .removal = 1e-9};
  });
  rows[500].contact.proxy.x() = std::numeric_limits<double>::quiet_NaN();
  rows[501].contact.force.z() = std::numeric_limits<double>::infinity();
  const Process done = test::process(rows, settings_);
  EXPECT_NEAR(done.force->mean, 1, 1e-12);
  EXPECT_NEAR(done.times.total, 0.998, 1e-9);
  EXPECT_TRUE(std::isfinite(done.paths.all));
}

// In 20 ms that nobody saw, the nerve came 7 mm nearer: how fast the burr came is known from what
// follows.
TEST_F(ProcessTest, AGapIsNoApproach) {
  auto rows = test::rows_of(1.2, [](double t) {
    Happening now;
    now.place.z() = (t < 1 ? 11 : 4.3 - 10 * (t - 1.02)) * kMm;
    return now;
  });
  test::drop(rows, 1.0, 1.02);
  const Process done = test::process(rows, settings_);
  ASSERT_TRUE(done.nearness[0].found->approach);
  EXPECT_NEAR(*done.nearness[0].found->approach, 10e-3, 3e-3);
}

// In 20 ms that nobody saw, the burr came from 1.3 to 0.7 mm: nobody saw it cross 1 mm.
TEST_F(ProcessTest, ACrossingThatNobodySawIsNoApproach) {
  auto rows = test::rows_of(1.2, [](double t) {
    Happening now;
    now.place.z() = (t < 1 ? 4.3 : std::max(3.7 - 10 * (t - 1.02), 3.3)) * kMm;
    return now;
  });
  test::drop(rows, 1.0, 1.02);
  const Process done = test::process(rows, settings_);
  ASSERT_TRUE(done.nearness[0].found);
  EXPECT_LT(done.nearness[0].found->least, 0.5 * kMm);
  EXPECT_FALSE(done.nearness[0].found->approach);
}

// A burr of 1 mm at d = 1.5 mm becomes one of 2 mm: it is nearer, but it did not come nearer.
TEST_F(ProcessTest, ALargerBurrIsNoApproach) {
  const Process done = test::process(
      1,
      [](double t) {
        Happening now;
        now.place.z() = 4.5 * kMm;
        now.tool.radius = (t < 0.5 ? 1 : 2) * kMm;
        return now;
      },
      settings_);
  ASSERT_TRUE(done.nearness[0].found);
  EXPECT_NEAR(done.nearness[0].found->least, 0.5 * kMm, 0.5 * kVoxel);
  EXPECT_FALSE(done.nearness[0].found->approach);
}

// Half of the time the recording does not say how large the burr is; then it is in the nerve.
TEST_F(ProcessTest, ATickWithoutARadiusHasNoDistance) {
  const std::array<volume::TissueId, 1> ids = {test::kBone};
  NoProgress quiet;
  auto made = volume::DistanceTo::make(*bone_, ids, {}, quiet);
  ASSERT_TRUE(made);
  settings_.bone = &*made;
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  for (const double radius : {0.0, std::numeric_limits<double>::quiet_NaN(), -1 * kMm}) {
    const auto story = [radius](double t, double from) {
      Happening now;
      now.touching = true;
      now.force = t < from ? 1 : 3;
      now.removal = 1e-9;
      now.place.z() = (t < from ? 5 : 1) * kMm;  // d = 2 mm; then inside
      if (t >= from) now.tool.radius = radius;
      return now;
    };
    const Process half = test::process(
        2, [&](double t) { return story(t, 1); }, settings_, bone_->grid());
    ASSERT_TRUE(half.nearness[0].found);
    EXPECT_NEAR(half.nearness[0].found->least, 2 * kMm, 0.5 * kVoxel);
    EXPECT_EQ(half.nearness[0].found->cutting_within[1], 0);
    ASSERT_TRUE(half.force && half.force->by_distance);
    EXPECT_NEAR(half.force->mean, 2, 1e-9);  // a force needs no distance
    EXPECT_EQ(half.force->by_distance->time[0], 0);
    ASSERT_TRUE(half.soft[0].intact);
    EXPECT_EQ(half.soft[0].intact->entered.value, 0);
    for (const BurrStroke& stroke : half.strokes) EXPECT_NEAR(stroke.d, 2 * kMm, 0.5 * kVoxel);

    const Process none = test::process(
        2, [&](double t) { return story(t, 0); }, settings_, bone_->grid());
    const std::string why = "the burr's radius is not recorded";
    ASSERT_FALSE(none.nearness[0].found);
    EXPECT_EQ(none.nearness[0].found.reason(), why);
    ASSERT_TRUE(none.force);
    ASSERT_FALSE(none.force->by_distance);
    EXPECT_EQ(none.force->by_distance.reason(), why);
    ASSERT_FALSE(none.choice);
    EXPECT_EQ(none.choice.reason(), why);
    ASSERT_FALSE(none.times.hesitation);
    EXPECT_EQ(none.times.hesitation.reason(), why);
    ASSERT_FALSE(none.soft[0].intact);
    EXPECT_EQ(none.soft[0].intact.reason(), why);
  }
}

// Near to what? Without a structure there is no answer, and no zero.
TEST_F(ProcessTest, WithoutAStructureNothingIsNear) {
  const auto story = [](double) {
    return Happening{.place = {0, 0, 5 * kMm}, .force = 1, .touching = true, .removal = 1e-9};
  };
  const Process none = test::process(1, story);
  ASSERT_FALSE(none.choice);
  EXPECT_NE(none.choice.reason().find("no structure"), std::string::npos);
  ASSERT_TRUE(none.force);
  ASSERT_FALSE(none.force->by_distance);
  EXPECT_EQ(none.force->by_distance.reason(), none.choice.reason());
  ASSERT_FALSE(none.times.hesitation);
  EXPECT_NE(none.times.hesitation.reason().find("distance to the bone"), std::string::npos);
  // one that this bone does not have
  const volume::DistanceTo nowhere;
  const Process missing = test::process(1, story, {.critical = {{"marrow", &nowhere}}});
  ASSERT_FALSE(missing.nearness[0].found);
  EXPECT_NE(missing.nearness[0].found.reason().find("not in this bone"), std::string::npos);
  EXPECT_FALSE(missing.choice);
  EXPECT_FALSE(missing.force->by_distance);
  // beside one that it has, it changes nothing
  settings_.critical.push_back({"marrow", &nowhere});
  const Process both = test::process(1, story, settings_);
  ASSERT_TRUE(both.nearness[0].found && both.choice);
  EXPECT_NEAR(both.nearness[0].found->least, 2 * kMm, 0.5 * kVoxel);
  EXPECT_FALSE(both.nearness[1].found);
}

// Two pauses of 1.5 s are none of 3 s if nobody knows what was done between them.
TEST_F(ProcessTest, AGapEndsAPause) {
  const std::array<volume::TissueId, 1> ids = {test::kBone};
  NoProgress quiet;
  auto made = volume::DistanceTo::make(*bone_, ids, {}, quiet);
  ASSERT_TRUE(made);
  settings_.bone = &*made;
  auto rows = test::rows_of(3.1, [](double) { return Happening{.place = {0, 0, 8 * kMm}}; });
  EXPECT_EQ(test::process(rows, settings_).times.hesitation->count, 1U);
  test::drop(rows, 1.5, 1.6);
  EXPECT_EQ(test::process(rows, settings_).times.hesitation->count, 0U);
}

// Writes a recording of these ticks and measures it.
class RecordingTest : public ProcessTest {
 protected:
  Process recorded(const std::vector<tick::TickRow>& rows) {
    const record::test::Folder folder;
    const auto player = written(rows, folder);
    NoProgress quiet;
    auto read = process_of(*player, settings_, quiet);
    EXPECT_TRUE(read) << read.error().text;
    return std::move(*read);
  }
  std::unique_ptr<record::Player> written(const std::vector<tick::TickRow>& rows,
                                          const record::test::Folder& folder) {
    record::SessionInfo info;
    info.volume = record::volume_info(*bone_);
    info.rate_hz = test::kRate;
    record::Recorder recorder(test::kRate);
    EXPECT_TRUE(recorder.start(folder / "s.mcap", info, nullptr).ok());
    for (const tick::TickRow& row : rows) {
      recorder.wait_for_room();
      EXPECT_TRUE(recorder.ticks().push(row));
    }
    EXPECT_TRUE(recorder.finish().ok());
    auto player = record::Player::open(folder / "s.mcap");
    EXPECT_TRUE(player) << player.error().text;
    return std::move(*player);
  }
};

// The burr cuts 1 mm^3/s along x, and the hand jumps 5 mm in a second of which no tick is left.
TEST_F(RecordingTest, AGapPartsWhatIsBeforeItFromWhatIsAfter) {
  auto rows = test::rows_of(3, [](double t) {
    Happening now;
    now.place = {(t < 2 ? 10 * t - 15 : 10 * t - 20) * kMm, (t < 2 ? 0 : 5) * kMm, 9 * kMm};
    now.touching = true;
    now.removal = 1e-9;
    return now;
  });
  test::drop(rows, 1, 2);
  const Process done = recorded(rows);
  EXPECT_NEAR(done.lost_removed, 1e-9, 2e-12);
  EXPECT_NEAR(done.times.volume, 2e-9, 3e-12);
  EXPECT_NEAR(done.times.total, 2, 1e-9);
  EXPECT_NEAR(done.times.cutting, 2, 3e-3);
  EXPECT_NEAR(done.paths.all, 20 * kMm, 0.4 * kMm);  // the ends of two pieces; no jump
  ASSERT_EQ(done.strokes.size(), 2U);
  EXPECT_NEAR(done.strokes[0].end, 1, 0.02);
  EXPECT_NEAR(done.strokes[1].begin, 2, 0.02);
  for (const BurrStroke& stroke : done.strokes) EXPECT_NEAR(stroke.length, 10 * kMm, 0.2 * kMm);
  EXPECT_EQ(done.unusable, 0U);
}

// Of one tick alone that is missing, too.
TEST_F(RecordingTest, OneMissingTickIsAGap) {
  auto rows = test::rows_of(1, [](double t) {
    return Happening{
        .place = {0, (t < 0.505 ? 0 : 8) * kMm, 9 * kMm}, .touching = true, .removal = 1e-9};
  });
  test::drop(rows, 0.505, 0.506);
  const Process done = recorded(rows);
  EXPECT_NEAR(done.lost_removed, 2e-12, 1e-18);
  EXPECT_NEAR(done.paths.all, 0, 1e-9);
}

// A tick with a number that is not finite is a gap too: nobody knows where its volume was cut.
TEST_F(RecordingTest, AnUnusableTickIsAGap) {
  auto rows = test::rows_of(1, [](double t) {
    return Happening{
        .place = {0, (t < 0.505 ? 0 : 8) * kMm, 9 * kMm}, .touching = true, .removal = 1e-9};
  });
  rows[505].contact.proxy.x() = std::numeric_limits<double>::quiet_NaN();
  const Process done = recorded(rows);
  EXPECT_EQ(done.unusable, 1U);
  EXPECT_NEAR(done.lost_removed, 2e-12, 1e-18);
  EXPECT_NEAR(done.paths.all, 0, 1e-9);
}

// A session of 150 ms: the last 50 are sampled too.
TEST_F(RecordingTest, TheEndOfARecordingIsInSightToo) {
  const record::test::Folder folder;
  const auto player = written(
      test::rows_of(0.15,
                    [](double) {
                      return Happening{.place = {0, 0, 9 * kMm}, .touching = true, .removal = 1e-9};
                    }),
      folder);
  const std::vector<EyeSample> eyes = {{.t = 0, .eye = {0, 0, 300 * kMm}}};
  NoProgress quiet;
  const auto seen = visibility_of(*player, *bone_, eyes, quiet);
  ASSERT_TRUE(seen) << seen.error().text;
  ASSERT_TRUE(*seen) << seen->reason();
  EXPECT_NEAR((*seen)->volume, 0.149e-9,
              1e-15);  // the first tick counts as one that removes nothing
  EXPECT_NEAR((*seen)->seen_share, 1, 1e-9);
}

// A recording on the disk gives the same as the ticks that were written to it.
TEST_F(RecordingTest, GivesTheSameAsItsTicks) {
  const auto rows = test::rows_of(3, [](double t) {
    Happening now = pass_at({0.7 * kMm}, t / 1.5);
    now.touching = now.place.z() < 5 * kMm;
    now.removal = now.touching ? 1e-9 : 0;
    return now;
  });
  settings_.soft = {{"nerve", &voxels_, nerve_.get(), 1}};
  const Process read = recorded(rows);
  const Process made = test::process(rows, settings_, bone_->grid());
  EXPECT_EQ(read.paths.all, made.paths.all);
  EXPECT_EQ(read.times.cutting, made.times.cutting);
  EXPECT_EQ(read.force->mean, made.force->mean);
  EXPECT_EQ(read.nearness[0].found->least, made.nearness[0].found->least);
  EXPECT_EQ(read.soft[0].intact->volume, made.soft[0].intact->volume);
  EXPECT_EQ(read.strokes.size(), made.strokes.size());
  EXPECT_EQ(read.unusable, 0U);
}

TEST(Order, CountsInversions) {
  const std::vector<std::string> steps = {"a", "b", "c", "d"};
  const std::vector<StepMark> marks = {{1, "a", StepEvent::done},     {2, "c", StepEvent::begun},
                                       {3, "c", StepEvent::done},     {4, "b", StepEvent::done},
                                       {5, "c", StepEvent::reopened}, {6, "c", StepEvent::done},
                                       {7, "other", StepEvent::done}};
  const Order order = order_of(marks, steps);
  EXPECT_EQ(order.done, 3U);
  EXPECT_EQ(order.reopened, 1U);
  EXPECT_EQ(order.skipped, std::vector<std::string>{"d"});
  ASSERT_EQ(order.inversions.size(), 1U);
  EXPECT_EQ(order.inversions[0].first, "c");
  EXPECT_EQ(order.inversions[0].second, "b");
  ASSERT_TRUE(order.tau);
  EXPECT_NEAR(*order.tau, 1.0 / 3, 1e-12);
  EXPECT_FALSE(order_of({}, steps).tau);
}

}  // namespace
}  // namespace burr::metrics
