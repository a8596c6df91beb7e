// From a recording of the simulator the cutting energy of its bone is found again.
#include "burr/fit/recorded_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "burr/device/simulated_hand.h"
#include "burr/fit/laws.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "record/made_up.h"
#include "sim/commanded.h"

namespace burr::fit {
namespace {

using math::Vec3;
using record::test::Folder;

struct Plan {
  std::string motion = "slot";
  double energy = 0.8e9;  // of the slab  [J/m^3]
  double seconds = 4;
  double stopped_after = 60;  // [s]
  tool::BurrKind kind = tool::BurrKind::cutting;
  int solid_tissues = 1;
};

void mill(const Plan& plan, const std::string& path) {
  NoProgress quiet;
  volume::TissueTable table;
  table.tissues[1].name = "slab";
  table.tissues[1].cutting_energy = plan.energy;
  while (static_cast<int>(table.tissues.size()) <= plan.solid_tissues)
    table.tissues.push_back({.name = "other"});
  auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), table,
      phantom::slab(), 256);
  auto hand_path = surgeon::motion(plan.motion, {}, 2e-3, plan.seconds);
  ASSERT_TRUE(hand_path.ok());
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  settings.servo.burr.kind = plan.kind;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  auto session = sim::Session::make(
      std::move(bone), std::make_unique<device::SimulatedHand>(*hand_path, device::ArmSettings{}),
      settings, quiet);
  ASSERT_TRUE(session.ok()) << session.error().text;
  record::SessionInfo info;
  sim::describe((*session)->settings(), (*session)->hand().spec(), info);
  info.volume.grid = (*session)->bone().grid();
  info.volume.tissues = (*session)->bone().tissues();
  record::Recorder recorder(info.rate_hz, 8192);
  const Status started = recorder.start(path, info, nullptr);
  ASSERT_TRUE(started.ok()) << started.error().text;
  (*session)->set_recorder(&recorder);
  (*session)->run(std::min(plan.seconds, plan.stopped_after), quiet);
  (*session)->set_recorder(nullptr);
  const auto account = recorder.finish();
  ASSERT_TRUE(account.ok()) << account.error().text;
  ASSERT_TRUE(account->whole());
}

TEST(RecordedLog, GivesBackWhatItsBoneCostsToCut) {
  const Folder folder;
  for (const char* motion : {"slot", "plunge"})
    for (const double energy : {0.4e9, 1.0e9, 3.0e9}) {
      SCOPED_TRACE(std::string(motion) + " at " + std::to_string(energy));
      mill({.motion = motion, .energy = energy}, folder / "s.mcap");
      auto player = record::Player::open(folder / "s.mcap");
      ASSERT_TRUE(player.ok()) << player.error().text;
      const auto log = log_of_recording(**player, 0.05, "");
      ASSERT_TRUE(log.ok()) << log.error().text;
      EXPECT_EQ(log->materials.at(0), "slab");
      const MaterialFit fit = fit_laws(*log).at(0);
      EXPECT_GT(fit.rows, 20U);
      bool told = false;
      for (const Fitted& one : fit.constants) {
        if (std::string(one.key) != "cutting_energy_J_mm3") continue;
        told = true;
        EXPECT_NEAR(one.value / energy, 1, 0.02);
        RecordProperty(std::string(motion) + std::to_string(energy * 1e-9),
                       std::to_string(one.value / energy - 1));
      }
      EXPECT_TRUE(told);
    }
}

TEST(RecordedLog, AsksWhatWasCutWhereTheBoneHasSeveralTissues) {
  const Folder folder;
  mill({.seconds = 1.5, .solid_tissues = 2}, folder / "s.mcap");
  auto player = record::Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok());
  const auto log = log_of_recording(**player, 0.05, "");
  ASSERT_FALSE(log.ok());
  EXPECT_EQ(log.error().trouble, Trouble::usage);
  EXPECT_NE(log.error().text.find("s.mcap: the bone has 2 solid tissues"), std::string::npos)
      << log.error().text;
  const auto named = log_of_recording(**player, 0.05, "dentine");
  ASSERT_TRUE(named.ok()) << named.error().text;
  EXPECT_EQ(named->materials.at(0), "dentine");
}

TEST(RecordedLog, AWindowIsAMeanAndHoldsOnlyCutting) {
  const Folder folder;
  mill({.seconds = 2}, folder / "s.mcap");
  auto player = record::Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok());
  const auto fine = log_of_recording(**player, 0.01, ""),
             rough = log_of_recording(**player, 0.1, "");
  ASSERT_TRUE(fine.ok() && rough.ok());
  EXPECT_GT(fine->rows.size(), 8 * rough->rows.size());
  ASSERT_FALSE(rough->rows.empty());
  // the mean of ten short windows equals one long window
  const ForceRow& one = rough->rows.back();
  double removal = 0, normal = 0;
  int found = 0;
  for (const ForceRow& row : fine->rows)
    if (std::abs(row.time - one.time) < 0.05) {
      removal += row.removal / 10;
      normal += row.normal / 10;
      ++found;
    }
  EXPECT_EQ(found, 10);
  EXPECT_NEAR(removal / one.removal, 1, 1e-6);
  EXPECT_NEAR(normal / one.normal, 1, 1e-6);
  for (const ForceRow& row : fine->rows) EXPECT_GT(row.normal, 0);
}

// The burr stays in its own hole: what is fitted is the burr that was there, not the one asked for.
TEST(RecordedLog, KnowsTheBurrThatTheServoHadNotTheOneItRefused) {
  const Folder folder;
  auto plan = sim::test::in_its_own_hole();
  ASSERT_EQ(sim::test::record_commanded(folder / "asked.mcap", plan), 2e-3) << "not refused";
  plan.commands.clear();
  sim::test::record_commanded(folder / "quiet.mcap", plan);
  double mean[2] = {}, last[2] = {};
  for (int n = 0; n < 2; ++n) {
    auto player = record::Player::open(folder / (n == 0 ? "asked.mcap" : "quiet.mcap"));
    ASSERT_TRUE(player.ok());
    const auto log = log_of_recording(**player, 0.05, "");
    ASSERT_TRUE(log.ok()) << log.error().text;
    ASSERT_GT(log->rows.size(), 10U);
    EXPECT_GT(log->rows.back().time, 1e-3 * static_cast<double>(sim::test::kAsked));
    for (const ForceRow& row : log->rows) {
      EXPECT_LE(row.radius, 2e-3) << row.time;
      mean[n] += row.radius / static_cast<double>(log->rows.size());
    }
    last[n] = log->rows.back().radius;
  }
  // the look whether there is room changes the touch by far less than a micrometre
  EXPECT_NEAR(mean[0], mean[1], 1e-6);
  EXPECT_NEAR(mean[0], 0.964e-3, 0.02e-3) << "of 3.5 mm it would be 1.7 mm";
  EXPECT_NEAR(last[0], last[1], 1e-6);
  RecordProperty("effective_radius_mm", std::to_string(1e3 * last[0]));
}

TEST(RecordedLog, RefusesAChangeBetweenCuttingAndDiamond) {
  const Folder folder;
  auto plan = sim::test::in_its_own_hole();
  plan.commands = {{1000, {tick::CommandKind::burr_kind, 0}}};
  sim::test::record_commanded(folder / "same.mcap", plan);
  plan.commands = {{1000, {tick::CommandKind::burr_kind, 1}}};
  sim::test::record_commanded(folder / "changed.mcap", plan);
  auto same = record::Player::open(folder / "same.mcap"),
       changed = record::Player::open(folder / "changed.mcap");
  ASSERT_TRUE(same.ok() && changed.ok());
  EXPECT_TRUE(log_of_recording(**same, 0.05, "").ok()) << "it was a cutting burr already";
  const auto log = log_of_recording(**changed, 0.05, "");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().text.find("between cutting and diamond"), std::string::npos);
}

TEST(RecordedLog, RefusesASessionThatMillsNothing) {
  const Folder folder;
  mill({.stopped_after = 0.1}, folder / "s.mcap");
  auto player = record::Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok());
  const auto log = log_of_recording(**player, 0.05, "");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().text.find("nothing was removed"), std::string::npos) << log.error().text;
}

}  // namespace
}  // namespace burr::fit
