// Other methods of touch and another law of removal, in a whole session: chosen at its start,
// changed in its middle, known to the recording.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "burr/tick/touch_methods.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using haptics::Method;
using math::Vec3;
constexpr double kMm = 1e-3;

std::unique_ptr<volume::Bone> slab(double half_mm = 8) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-half_mm * kMm), Vec3::Constant(half_mm * kMm), 0.25 * kMm),
      {}, phantom::slab(), 256);
}

std::unique_ptr<sim::Session> session(sim::SessionSettings settings, const char* how = "pocket",
                                      double seconds = 2) {
  NoProgress quiet;
  settings.servo.burr.radius = 2 * kMm;
  settings.servo.undo_bricks = 1024;
  settings.surface.reserve_blocks = 1 << 13;
  auto path = surgeon::motion(how, {}, 2 * kMm, seconds);
  EXPECT_TRUE(path.ok());
  auto made = sim::Session::make(
      slab(), std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}), settings,
      quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return std::move(*made);
}

TEST(MethodsInASession, EachOfThemMillsAndNoForceIsBeyondTheLimit) {
  NoProgress quiet;
  for (int n = 0; n < haptics::kMethods; ++n) {
    sim::SessionSettings settings;
    settings.servo.touch = static_cast<Method>(n);
    const auto run = session(settings);
    run->run(2, quiet);
    const sim::Outcome outcome = run->outcome();
    EXPECT_GT(outcome.ledger.removed, 0.1 * kMm * kMm * kMm) << haptics::name(settings.servo.touch);
    EXPECT_LE(outcome.peak_force, settings.servo.limit.user_force + 1e-9);
  }
}

TEST(MethodsInASession, TakeNoMemoryInATickTheTrianglesOfThePictureNeither) {
  for (int n = 0; n < haptics::kMethods; ++n) {
    sim::SessionSettings settings;
    settings.servo.touch = static_cast<Method>(n);
    settings.servo.guarded = true;
    settings.servo.vibration_gain = 1;
    settings.servo.removal.law = static_cast<edit::RemovalLaw>(n % edit::kLaws);
    const auto run = session(settings, "slot");
    double removed = 0;
    const burr::test::RtGuard guard;
    for (int k = 0; k < 1500; ++k) {
      removed = run->servo().tick(false).ledger.removed;
      run->servo().publish();
    }
    EXPECT_EQ(guard.allocations(), 0) << n;
    EXPECT_EQ(guard.locks(), 0) << n;
    EXPECT_GT(removed, 0) << n;
  }
}

// In turn, every tenth of a second, in the middle of a cut.
TEST(MethodsInASession, AreChangedInItsMiddleAndTheForceGrowsNoFasterThanEver) {
  const auto run = session({}, "pocket", 4);
  Servo& servo = run->servo();
  double fastest = 0, last = 0;
  std::array<int, haptics::kMethods> touched{};
  for (int n = 0; n < 4000; ++n) {
    const int which = n / 100 % haptics::kMethods;
    if (n % 100 == 0)
      static_cast<void>(
          servo.commands().push({CommandKind::touch_method, static_cast<double>(which)}));
    const TickRow& row = servo.tick(false);
    const double now = row.contact.force.norm();
    fastest = std::max(fastest, (now - last) * 1e3);
    last = now;
    touched[static_cast<std::size_t>(which)] += row.contact.touching ? 1 : 0;
    servo.publish();
  }
  EXPECT_LE(fastest, run->settings().servo.limit.slew + 1e-6);
  for (int n = 0; n < haptics::kMethods; ++n)
    EXPECT_GT(touched[static_cast<std::size_t>(n)], 0) << haptics::name(static_cast<Method>(n));
}

TEST(MethodsInASession, TheRecordingKnowsAndSimulatesToTheSameBits) {
  NoProgress quiet;
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  sim::SessionSettings settings;
  settings.servo.touch = Method::thesis;
  settings.servo.vibration_gain = 1;
  settings.servo.guarded = true;
  const auto run = session(settings, "pocket", 3);
  record::SessionInfo info;
  sim::describe(run->settings(), run->hand().spec(), info);
  info.volume.content_hash = run->bone().content_hash();
  info.volume.grid = run->bone().grid();
  info.volume.tissues = run->bone().tissues();
  info.volume.recipe.reserve_bricks = 256;
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(file, info, &run->bone()).ok());
  run->set_recorder(&recorder);
  for (int n = 0; n < 14; ++n) {
    run->run(0.2, quiet);
    run->command({CommandKind::touch_method, static_cast<double>(n % haptics::kMethods)});
    run->command({CommandKind::removal_law, static_cast<double>(n % edit::kLaws)});
  }
  run->set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());
  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok());
  auto bone = (*player)->embedded_bone(256);
  ASSERT_TRUE(bone.ok());
  const auto again = sim::replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick)
      << "tick " << *again->first_different_tick << ": " << again->difference;
  EXPECT_EQ(again->ticks, 2800U);
  EXPECT_EQ(again->bone->content_hash(), run->bone().content_hash());
}

// Removal by the thesis: density falls with time wherever the mill is, at any speed of the spindle;
// 30 times a second only what is in the mill just then, which is less.
TEST(ThesisRemoval, GoesByTimeAloneAndTheLedgerKnows) {
  NoProgress quiet;
  double removed[3] = {};
  int n = 0;
  for (const int frame : {1, 1, 33}) {
    sim::SessionSettings settings;
    settings.servo.removal.law = edit::RemovalLaw::thesis;
    settings.servo.removal.thesis_frame_ticks = frame;
    if (n == 1) settings.servo.spindle_rad_s /= 4;
    const auto run = session(settings);
    const double before = volume::volume_of(run->bone());
    run->run(2, quiet);
    const edit::Ledger ledger = run->outcome().ledger;
    EXPECT_NEAR(before - volume::volume_of(run->bone()), ledger.removed, 1e-6 * ledger.removed);
    EXPECT_EQ(ledger.asked, ledger.removed);
    EXPECT_EQ(ledger.debt, 0);
    removed[n++] = ledger.removed;
  }
  EXPECT_GT(removed[0], kMm * kMm * kMm);
  EXPECT_NEAR(removed[1] / removed[0], 1, 0.05);
  EXPECT_GT(removed[2], 0.05 * removed[0]);
  EXPECT_LT(removed[2], removed[0]);
}

// The triangles' failure: while the bone is milled there are moments without any, when the burr is
// let into the bone and nothing is felt. Ours has none.
TEST(Triangles, AreMissingForAMomentOfEveryFrameWhileMilling) {
  int silent[2] = {};
  int n = 0;
  for (const Method which : {Method::constraint, Method::triangles}) {
    sim::SessionSettings settings;
    settings.servo.touch = which;
    const auto run = session(settings, "plunge", 3);
    bool pressed = false;
    for (int k = 0; k < 2500; ++k) {
      const TickRow& row = run->servo().tick(false);
      run->servo().publish();
      pressed |= row.contact.depth > 0.3 * kMm;
      silent[n] += pressed && !row.contact.touching ? 1 : 0;
    }
    EXPECT_TRUE(pressed);
    ++n;
  }
  EXPECT_EQ(silent[0], 0);
  EXPECT_GT(silent[1], 20);
}

}  // namespace
}  // namespace burr::tick
