// From the rows of ticks to what is heard.
#include "burr/workshop/sound_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "burr/scenario/rack.h"
#include "burr/sound/synth.h"
#include "sound/ear.h"

namespace burr::workshop {
namespace {

tick::TickRow row(std::uint64_t tick, double removed_mm3, double energy_j) {
  tick::TickRow made;
  made.tick = tick;
  made.ledger.removed = 1e-9 * removed_mm3;
  made.ledger.energy = energy_j;
  return made;
}

TEST(SoundTracker, HowFastAndHowHardIsTheDifferenceOfTwoRows) {
  for (const double rate : {1'000.0, 4'000.0}) {
    tick::ServoSettings settings;
    settings.rate_hz = rate;
    // 3 mm3/s of 0.4 J/mm3; at the steps of a recording and of a window
    for (const std::uint64_t step : {1U, 16U, 40U}) {
      SoundTracker tracker(settings);
      sound::SoundState heard;
      for (std::uint64_t tick = 500; tick < 700; tick += step) {
        const double t = static_cast<double>(tick) / rate;
        heard = tracker.update(row(tick, 3 * t, 0.4 * 3 * t));
        if (tick == 500) {
          EXPECT_EQ(heard.removal_m3_s, 0) << "nothing to compare with yet";
        }
      }
      EXPECT_NEAR(heard.removal_m3_s, 3e-9, 1e-15) << rate << " " << step;
      EXPECT_NEAR(heard.hardness_j_m3, 0.4e9, 1) << rate << " " << step;
    }
  }
}

TEST(SoundTracker, AReturnToTheStartIsNoRemoval) {
  SoundTracker tracker({});
  static_cast<void>(tracker.update(row(1'000, 50, 50)));
  EXPECT_EQ(tracker.update(row(1'100, 20, 20)).removal_m3_s, 0) << "less than before";
  EXPECT_EQ(tracker.update(row(10, 0, 0)).removal_m3_s, 0) << "an earlier row";
  EXPECT_NEAR(tracker.update(row(110, 1, 1)).removal_m3_s, 10e-9, 1e-15);
  EXPECT_EQ(tracker.update(row(210, 1, 1)).removal_m3_s, 0) << "no more";
  EXPECT_NEAR(tracker.update(row(210, 1, 1)).hardness_j_m3, 1e9, 1) << "it was that bone last";
}

TEST(SoundTracker, TellsWhatTheRowTells) {
  tick::ServoSettings settings;
  settings.burr.teeth = 6;
  math::Vec3 asked = math::Vec3::Zero();
  SoundTracker tracker(settings, [&asked](const math::Vec3& p) {
    asked = p;
    return 5e-3;
  });
  tick::TickRow one = row(0, 0, 0);
  one.tool.radius = 2e-3;
  one.spindle_rad_s = -1'234;
  one.cutting_nm = 1e-3;
  one.contact.touching = true;
  one.contact.proxy = {1, 2, 3};
  sound::SoundState heard = tracker.update(one);
  EXPECT_EQ(heard.spindle_rad_s, -1'234);
  EXPECT_EQ(heard.cutting_nm, 1e-3);
  EXPECT_EQ(heard.teeth, 6);
  EXPECT_TRUE(heard.touching);
  EXPECT_FALSE(heard.irrigated);
  EXPECT_EQ(asked, math::Vec3(1, 2, 3)) << "where the burr is";
  EXPECT_NEAR(heard.to_spare, 3e-3, 1e-15) << "from its surface";

  one.tool.irrigated = true;
  one.tool.radius = 1e-3;
  heard = tracker.update(one);
  EXPECT_TRUE(heard.irrigated);
  EXPECT_NEAR(heard.to_spare, 4e-3, 1e-15);
  one.tool.irrigated = false;
  EXPECT_FALSE(tracker.update(one).irrigated);

  one.tool.kind = tool::BurrKind::diamond;
  EXPECT_EQ(tracker.update(one).teeth, 0) << "it grinds";
  one.tool.kind = tool::BurrKind::cutting;
  EXPECT_EQ(tracker.update(one).teeth, 6);

  SoundTracker without(settings);
  EXPECT_EQ(without.update(one).to_spare, std::numeric_limits<double>::infinity());
}

TEST(SoundTracker, AToolOfTheRackSoundsAsItMoves) {
  tick::ServoSettings settings;
  for (const char* name : {"flame", "sagittal-saw", "osteotome"}) {
    const scenario::RackTool& tool = *scenario::built_in_rack().find(name);
    settings.tools.push_back({tool.name, tool.tool, tool.cutter});
  }
  // a plane to be spared at z = -10 mm
  SoundTracker tracker(settings, [](const math::Vec3& p) { return p.z() + 10e-3; });
  tick::TickRow one = row(0, 0, 0);
  one.tool.number = 0;
  one.cutting_w = 1;
  sound::SoundState heard = tracker.update(one);
  EXPECT_EQ(heard.teeth, 10);
  EXPECT_FALSE(heard.strokes);
  EXPECT_FALSE(heard.struck);
  EXPECT_NEAR(heard.to_spare, 6e-3, 0.1e-3) << "from the tip of the flame";
  one.hand.world_from_tool.q = Eigen::AngleAxisd(M_PI / 2, math::Vec3::UnitX());
  EXPECT_NEAR(tracker.update(one).to_spare, 8.5e-3, 0.2e-3) << "from its belly";
  one.tool.number = 1;
  heard = tracker.update(one);
  EXPECT_TRUE(heard.strokes);
  EXPECT_EQ(heard.teeth, 0);
  one.tool.number = 2;
  EXPECT_TRUE(tracker.update(one).struck);
  one.cutting_w = 0;
  EXPECT_FALSE(tracker.update(one).struck);
  one.tool.number = -1;
  one.tool.radius = 3e-3;
  EXPECT_NEAR(tracker.update(one).to_spare, 7e-3, 1e-12);
}

// By the spectrum of the samples: a bur's tone is at its turns per second, a saw's at its strokes per
// second. The loudness of a saw's cut rises and falls twice in a stroke. The tool in the second hand
// sounds like its own kind, and its sound is added to that of the first tool.
TEST(SoundTracker, TheOtherHandsToolIsHeardAsItself) {
  for (const char* name : {"fissure-bur", "sagittal-saw"}) {
    const scenario::RackTool& rack = *scenario::built_in_rack().find(name);
    const tool::ShapedTool other{rack.name, rack.tool, rack.cutter};
    const bool saw = rack.cutter.drive == tool::Drive::oscillating;
    SoundTracker tracker(
        {}, [](const math::Vec3& p) { return p.z(); }, &other);
    EXPECT_EQ(tracker.second(), nullptr) << "nothing known of it yet";
    sound::SoundState first;
    for (std::uint64_t tick = 0; tick <= 100; tick += 20) {
      const double t = 1e-3 * static_cast<double>(tick);
      tick::TickRow one = row(tick, 5 * t, 2 * t), two = row(tick, 2 * t, 1 * t);
      one.contact.proxy = {0, 0, 9e-3};
      two.hand.world_from_tool.p = two.contact.proxy = {0, 0, 4e-3};
      two.tool.number = 0;
      two.contact.touching = true;
      two.spindle_rad_s = tool::full_speed(other.cutter);
      first = tracker.update(one, &two);
    }
    // each of them only what it removes itself, and one warning, for the nearer tool
    EXPECT_NEAR(first.removal_m3_s, 3e-9, 1e-13);
    EXPECT_EQ(first.spindle_rad_s, 0);
    EXPECT_LT(first.to_spare, 4.1e-3);
    ASSERT_NE(tracker.second(), nullptr);
    EXPECT_NEAR(tracker.second()->removal_m3_s, 2e-9, 1e-13);
    EXPECT_EQ(tracker.second()->to_spare, std::numeric_limits<double>::infinity());
    EXPECT_EQ(tracker.second()->strokes, saw);

    const double turns = tool::full_speed(other.cutter) / (2 * M_PI);
    if (saw) {
      EXPECT_NEAR(turns, rack.cutter.cycles_hz, 1e-6);
    }
    sound::SoundState idle = *tracker.second();
    idle.removal_m3_s = 0;
    idle.touching = false;
    sound::Synth synth;
    synth.update(idle);
    std::vector<float> samples(1 << 17);
    synth.make(samples);
    synth.make(samples);
    EXPECT_NEAR(test::peak_hz(samples), turns, 0.01 * turns) << name;

    // of what it cuts alone: how loud it is, as a signal
    sound::Synth cuts({.spindle = 0, .tooth = 0, .knock = 0});
    cuts.update(*tracker.second());
    cuts.make(samples);
    cuts.make(samples);
    double mean = 0;
    for (float& one : samples) mean += static_cast<double>(one *= one) / (1 << 17);
    for (float& one : samples) one -= static_cast<float>(mean);
    if (saw) {
      EXPECT_NEAR(test::peak_hz(samples), 2 * turns, 0.02 * turns) << "twice a stroke";
    }
  }
}

}  // namespace
}  // namespace burr::workshop
