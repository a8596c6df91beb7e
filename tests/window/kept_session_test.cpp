// What the window keeps of a session beside its recording: the recipe to the bit, and older accounts.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "burr/base/progress.h"
#include "burr/record/player.h"
#include "burr/sim/replay.h"
#include "burr/workshop/recorded_bone.h"
#include "shared/window_session.h"
#include "shared/work.h"
#include "support/folder.h"
#include "window/parts/autosave.h"
#include "window/parts/kept_sessions.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using scenario::BoneRecipe;
using scenario::Region;

class Kept : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(state_ / "sessions"); }
  static Result<WindowSession> ready_ball(WorkOptions& ball) {
    ball.volume.source = "phantom:ball";
    ball.volume.voxel_mm = 1;
    NoProgress quiet;
    if (const Status taken = take_case(ball); !taken) return taken.error();
    auto work = open_work(ball, quiet);
    if (!work) return work.error();
    return make_window_session(ball, std::move(*work), quiet);
  }
  const test::Folder folder_;
  const fs::path state_ = folder_.path();
};

TEST_F(Kept, RecipesComeBackToTheBit) {
  constexpr std::uint64_t kSeed = 41;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> share(0, 1);
  const auto coin = [&] { return random() % 2 == 0; };
  WorkOptions ball;
  auto ready = ready_ball(ball);
  ASSERT_TRUE(ready) << ready.error().text;
  for (int n = 0; n < 12; ++n) {
    WorkOptions options = ball;
    BoneRecipe& recipe = options.volume;
    recipe = {};
    recipe.source = "/nowhere/å \"b\".nrrd";
    if (coin()) recipe.series = "1.2.840.113619";
    if (coin()) recipe.spacing_mm = {share(random), 0.3, 1.0 / 3};
    if (coin()) recipe.region = Region{{1, static_cast<int>(random() % 999)}, {0, 7}, {8, 9}};
    if (coin()) recipe.voxel_mm = share(random);
    if (coin()) recipe.iso = 3000 * (share(random) - 0.5);
    if (coin()) recipe.smooth = share(random);
    if (coin()) recipe.labels = "/nowhere/labels.toml";
    if (coin()) recipe.materials = "/nowhere/m.toml";
    if (coin()) recipe.memory_mb = 1000 * share(random);
    {
      Autosave autosave(state_, *ready, options, {});
      ASSERT_TRUE(autosave.keep()) << autosave.trouble();
      ASSERT_TRUE(autosave.finish());
      ASSERT_EQ(autosave.trouble(), "");
    }
    const std::vector<KeptSession> all = kept_sessions(state_);
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all[0].options.volume == recipe) << scenario::to_json(recipe);
    EXPECT_TRUE(all[0].clean && all[0].keep);
    fs::remove_all(state_ / "sessions");
  }
}

// Time, volume, burr, speed and coolant are those of the end, also over several sessions.
TEST_F(Kept, ASessionThatIsContinuedGoesOnWhereItEnded) {
  WorkOptions ball;
  NoProgress quiet;
  auto ready = ready_ball(ball);
  ASSERT_TRUE(ready) << ready.error().text;
  double seconds = 0, removed = 0;
  KeptSession before;
  for (int n = 0; n < 3; ++n) {
    Autosave autosave(state_, *ready, ball, {}, n > 0 ? &before : nullptr);
    ASSERT_EQ(autosave.trouble(), "");
    ASSERT_EQ(autosave.apart(), "");
    sim::Session& session = *ready->session;
    session.run(0.02, quiet);  // a larger burr is refused until the hand was in the air
    session.command({tick::CommandKind::burr_radius, 3e-3});
    session.command({tick::CommandKind::burr_kind, 1});
    session.command({tick::CommandKind::spindle_speed, 3000});
    session.command({tick::CommandKind::irrigation, 1});
    mouse::MouseHand::Aim aim;
    aim.world_from_tool = ready->scene.burr.world_from_tool;
    aim.world_from_tool.p = ready->scene.camera.target;  // on the surface: pressed in by a radius
    aim.pedal = 1;
    ready->hands.mouse->aim(aim);
    session.run(0.4, quiet);
    ASSERT_TRUE(autosave.finish()) << autosave.trouble();
    seconds += session.outcome().seconds;
    removed += session.outcome().ledger.removed;
    const auto kept = kept_sessions(state_);
    ASSERT_EQ(kept.size(), 1U) << "one session, one row";
    EXPECT_NEAR(kept.front().seconds, seconds, 1e-9);
    EXPECT_NEAR(kept.front().removed_mm3, 1e9 * removed, 1e-6);
    auto next = continue_session(kept.front(), quiet);
    ASSERT_TRUE(next) << next.error().text;
    EXPECT_NEAR(next->earlier.seconds, seconds, 1e-9);
    EXPECT_NEAR(next->earlier.removed, removed, 1e-15);
    const tick::ServoSettings& servo = next->session->settings().servo;
    EXPECT_NEAR(servo.burr.radius, 3e-3, 1e-12);
    EXPECT_EQ(servo.burr.kind, tool::BurrKind::diamond);
    EXPECT_NEAR(servo.spindle_rad_s, 3000, 1e-9);
    EXPECT_TRUE(servo.irrigated);
    ready = std::move(next);
    before = kept.front();
  }
  EXPECT_GT(removed, 0);

  // one recording, which replays to the bit and whose account is that of all parts
  auto player = record::Player::open(before.file.string());
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_EQ((*player)->continued().size(), 2U);
  EXPECT_TRUE((*player)->notices().empty()) << (*player)->notices().front();
  EXPECT_NEAR((*player)->seconds(), seconds, 1e-9);
  const auto last = (*player)->tick_at(1e9);
  ASSERT_TRUE(last) << last.error().text;
  EXPECT_NEAR(last->ledger.removed, removed, 1e-15);
  auto bone = workshop::bone_of(**player, {}, quiet);
  ASSERT_TRUE(bone) << bone.error().text;
  auto again = sim::replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->first_different_tick) << again->difference;
  EXPECT_EQ(again->ticks, (*player)->end_tick());
  EXPECT_EQ(again->gaps, 0U) << again->difference;
}

TEST_F(Kept, AnOlderAccountIsStillRead) {
  const fs::path folder = state_ / "sessions";
  std::ofstream(folder / "session_20261122_193145.mcap") << "x";
  std::ofstream(folder / "session_20261122_193145.toml")
      << "# A session of burr, kept so that one can go on with it.\n"
         "title = \"NRRD scan\"\nwhen = \"2026-11-22 19:31\"\nsource = \"/nowhere/a.nrrd\"\n"
         "series = \"#2\"\nspacing_mm = \"0.3,0.3,0.6\"\nroi = \"0,17,0,23,4,23\"\niso = \"1300\"\n"
         "tissues = \"/nowhere/l.toml\"\nmaterials = \"\"\nvoxel_mm = 0.25\nburr_mm = 4\n"
         "rpm = 30000\nseconds = 1.500\nremoved_mm3 = 2.250\nclean = true\nkeep = true\n";
  const std::vector<KeptSession> all = kept_sessions(state_);
  ASSERT_EQ(all.size(), 1U);
  BoneRecipe wanted;
  wanted.source = "/nowhere/a.nrrd";
  wanted.series = "#2";
  wanted.spacing_mm = {0.3, 0.3, 0.6};
  wanted.region = Region{{0, 17}, {0, 23}, {4, 23}};
  wanted.iso = 1300;
  wanted.labels = "/nowhere/l.toml";
  wanted.voxel_mm = 0.25;
  EXPECT_TRUE(all[0].options.volume == wanted) << scenario::to_json(all[0].options.volume);
  EXPECT_EQ(all[0].title, "NRRD scan");
  EXPECT_EQ(all[0].options.burr_mm, 4);
  EXPECT_TRUE(all[0].clean && all[0].keep);
  Settings settings;
  settings.sessions_kept = 0;
  settings.sessions_mb = 0;
  std::ofstream(folder / "session_20261123_193145.mcap") << "x";
  std::ofstream(folder / "session_20261123_193145.toml") << "source = \"/nowhere/b.nrrd\"\n";
  std::ofstream(folder / "session_20261121_193145.mcap") << "x";
  std::ofstream(folder / "session_20261121_193145.toml") << "source = \"/nowhere/c.nrrd\"\n";
  throw_old_away(state_, settings);
  EXPECT_EQ(kept_sessions(state_).size(), 2U) << "the newest and the one kept for good";
  EXPECT_FALSE(fs::exists(folder / "session_20261121_193145.toml"));
}

}  // namespace
}  // namespace burr::app
