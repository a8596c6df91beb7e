// A whole session with all threads: the servo cuts, workers mesh what changed, the recorder writes,
// another thread reads and sends commands. It also runs under ThreadSanitizer, where silence is the
// test.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "support/folder.h"

namespace burr::sim {
namespace {

using namespace std::chrono_literals;

TEST(WholeSession, EveryThreadAtOnceEndsWithOneTruth) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  auto bone = phantom::bone_from_distance(phantom::cube_grid(24e-3, 60), {}, phantom::slab(), 64);
  SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  settings.realtime = true;
  const auto place = surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {});
  ASSERT_TRUE(place) << place.error().text;
  auto path = surgeon::motion("pocket", *place, settings.servo.burr.radius, 2.0);
  ASSERT_TRUE(path) << path.error().text;

  NoProgress quiet;
  auto made = Session::make(
      std::move(bone),
      std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{}), settings,
      quiet);
  ASSERT_TRUE(made) << made.error().text;
  Session& session = **made;
  surface::Worker worker(session.bone(), 2);
  std::size_t shown = 0;
  const auto show = [&shown](const surface::Skin&) { ++shown; };
  ASSERT_TRUE(worker.first(quiet, show));
  const std::size_t at_first = shown;

  record::Recorder recorder(settings.servo.rate_hz);
  record::SessionInfo info;
  info.rate_hz = settings.servo.rate_hz;
  info.volume.grid = session.bone().grid();
  info.volume.tissues = session.bone().tissues();
  info.volume.content_hash = session.bone().content_hash();
  const Status started = recorder.start(file, info, &session.bone());
  ASSERT_TRUE(started) << started.error().text;
  session.set_recorder(&recorder);

  // two seconds of reading and sending commands
  session.start();
  tick::TickRow row;
  std::uint64_t seen = 0;
  const auto end = std::chrono::steady_clock::now() + 2s;
  bool changed = false, undone = false;
  while (std::chrono::steady_clock::now() < end) {
    if (session.view(row)) {
      EXPECT_GE(row.tick, seen) << "time went back";
      seen = row.tick;
    }
    surface::Skin skin;
    while (worker.take(skin)) {
      ++shown;
      worker.give_back(skin);
    }
    if (!changed && seen > 500) {
      session.command({tick::CommandKind::stiffness, 300});
      session.command({tick::CommandKind::spindle_speed, 3000});
      changed = true;
    }
    if (!undone && seen > 1500) {
      session.command({tick::CommandKind::undo, 0});
      undone = true;
    }
    std::this_thread::sleep_for(1ms);
  }
  session.stop();
  worker.settle(show);
  session.set_recorder(nullptr);
  const auto account = recorder.finish();
  ASSERT_TRUE(account) << account.error().text;

  const Outcome outcome = session.outcome();
  EXPECT_GT(outcome.ticks, 100U);
  EXPECT_GT(shown, at_first) << "nothing that was cut was shown";
  EXPECT_TRUE(account->whole()) << account->dropped_ticks << " ticks dropped";
  EXPECT_EQ(account->ticks, outcome.ticks);

  // the recording equals the final state
  auto player = record::Player::open(file);
  ASSERT_TRUE(player) << player.error().text;
  auto again = (*player)->embedded_bone(64);
  ASSERT_TRUE(again) << again.error().text;
  const Status shown_at_end = (*player)->bone_at(1e9, **again);
  ASSERT_TRUE(shown_at_end) << shown_at_end.error().text;
  EXPECT_EQ((*again)->content_hash(), session.bone().content_hash());
}

}  // namespace
}  // namespace burr::sim
