// The time of day may jump in any way while a session is milled and recorded: nothing reads it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "support/folder.h"
#include "support/wall_clock.h"

namespace burr::sim {
namespace {

using namespace std::chrono_literals;

TEST(TimeOfDay, MayJumpWhileASessionIsRecordedAndNobodyAsksForIt) {
  if (!burr::test::WallClock::watching()) GTEST_SKIP() << "sanitizers have clocks of their own";
  std::mt19937_64 random(11);
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  const auto slab = [] {
    return phantom::bone_from_distance(phantom::cube_grid(16e-3, 48), {}, phantom::slab(), 64, 1);
  };
  SessionSettings settings;
  settings.servo.burr.radius = 1.5e-3;
  settings.realtime = true;
  auto bone = slab();
  const auto place = surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {});
  ASSERT_TRUE(place);
  auto path = surgeon::motion("pocket", *place, settings.servo.burr.radius, 1.5);
  ASSERT_TRUE(path);
  NoProgress quiet;

  // the time of day is set meanwhile: back by hours, forward by years
  const burr::test::WallClock wall;
  std::atomic<bool> done = false;
  std::jthread somebody([&] {
    while (!done) {
      burr::test::WallClock::set_back(3600.0 * static_cast<double>(random() % 24));
      std::this_thread::sleep_for(7ms);
      burr::test::WallClock::set_back(-86400.0 * static_cast<double>(random() % 1000));
      std::this_thread::sleep_for(7ms);
    }
  });
  {
    auto made = Session::make(
        std::move(bone),
        std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{}), settings,
        quiet);
    ASSERT_TRUE(made) << made.error().text;
    Session& session = **made;
    record::SessionInfo info;
    describe(session.settings(), session.hand().spec(), info);
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.content_hash = session.bone().content_hash();
    record::Recorder recorder(settings.servo.rate_hz, 8192, true);
    const Status started = recorder.start(file, info);
    ASSERT_TRUE(started) << started.error().text;
    session.set_recorder(&recorder);
    session.run(1.5, quiet);
    session.set_recorder(nullptr);
    const auto account = recorder.finish();
    ASSERT_TRUE(account) << account.error().text;
    EXPECT_TRUE(account->whole());
    EXPECT_EQ(account->ticks, session.outcome().ticks);
    EXPECT_GT(session.outcome().ledger.removed, 0);
  }
  auto player = record::Player::open(file);
  ASSERT_TRUE(player) << player.error().text;
  const auto outcome = replay(**player, slab(), quiet);
  ASSERT_TRUE(outcome) << outcome.error().text;
  EXPECT_FALSE(outcome->first_different_tick.has_value()) << outcome->difference;
  EXPECT_GT(outcome->ticks, 100U);
  done = true;
  EXPECT_EQ(burr::test::WallClock::asked(), 0) << "somebody wants to know the time of day";
  // and the replacement of the clock works
  const auto before = std::chrono::system_clock::now();
  burr::test::WallClock::set_back(7200);
  EXPECT_LT(std::chrono::system_clock::now(), before - 1h);
}

}  // namespace
}  // namespace burr::sim
