// Whole sessions: a simulated hand, the tick, the recorder, the surface workers.
#include "burr/sim/session.h"
#include "burr/math/rotation.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <thread>

#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/simd.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::sim {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kMm3 = 1e-9;

std::unique_ptr<volume::Bone> slab(double h_mm, double half_mm = 8, std::size_t reserve = 256) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-half_mm * kMm), Vec3::Constant(half_mm * kMm), h_mm * kMm),
      {}, phantom::slab(), reserve);
}

struct Plan {
  std::string motion = "pocket";
  double seconds = 2, h_mm = 0.25, rate = 1000, burr_mm = 4;
  bool realtime = false;
};

std::unique_ptr<Session> make(const Plan& plan, SessionSettings settings = {},
                              device::ArmSettings arm = {}, const device::DeviceSpec& hand = {}) {
  NoProgress quiet;
  auto path = surgeon::motion(plan.motion, {}, 0.5 * plan.burr_mm * kMm, plan.seconds);
  EXPECT_TRUE(path.ok());
  settings.servo.rate_hz = plan.rate;
  settings.servo.burr.radius = 0.5 * plan.burr_mm * kMm;
  settings.realtime = plan.realtime;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  auto session = Session::make(
      slab(plan.h_mm), std::make_unique<device::SimulatedHand>(*path, arm, hand), settings, quiet);
  EXPECT_TRUE(session.ok()) << session.error().text;
  return std::move(*session);
}

TEST(Session, MillsAPocketAndTheAccountHolds) {
  const auto session = make({});
  NoProgress quiet;
  const double before = volume::volume_of(session->bone());
  session->run(2, quiet);
  const Outcome outcome = session->outcome();
  EXPECT_EQ(outcome.ticks, 2000U);
  EXPECT_GT(outcome.ledger.removed, 1 * kMm3);
  EXPECT_NEAR(outcome.ledger.asked,
              outcome.ledger.removed + outcome.ledger.debt + outcome.ledger.not_cut,
              1e-6 * outcome.ledger.asked);
  EXPECT_NEAR(before - volume::volume_of(session->bone()), outcome.ledger.removed,
              1e-6 * outcome.ledger.removed);
  EXPECT_GT(outcome.mean_force, 0.05);
  EXPECT_LE(outcome.peak_force, 3.3 + 1e-9);
  EXPECT_NEAR(volume::volume_of(*session->bone_before()), before, 1e-12 * before);
}

TEST(Session, ADiamondBurrByCommandIsTheOneOfTheSettings) {
  NoProgress quiet;
  std::vector<std::uint64_t> bones;
  std::vector<double> removed;
  for (const auto& [settled, requested] : {std::pair{0, 0}, {1, 1}, {0, 1}, {1, 0}}) {
    SessionSettings settings;
    settings.servo.burr.kind = settled > 0 ? tool::BurrKind::diamond : tool::BurrKind::cutting;
    const auto session = make({}, settings);
    if (requested != settled)
      session->command({tick::CommandKind::burr_kind, static_cast<double>(requested)});
    session->run(2, quiet);
    bones.push_back(session->bone().content_hash());
    removed.push_back(session->outcome().ledger.removed);
  }
  EXPECT_EQ(bones[2], bones[1]);
  EXPECT_EQ(bones[3], bones[0]);
  EXPECT_LT(removed[1], 0.5 * removed[0]);
  EXPECT_GT(removed[1], 0);
}

TEST(Session, TheSameSessionGivesTheSameBitsOnEveryInstructionSet) {
  NoProgress quiet;
  std::vector<std::uint64_t> bones, ticks;
  const rt::Simd best = rt::simd();
  for (const rt::Simd which : {best, best, rt::Simd::avx2, rt::Simd::scalar}) {
    rt::force_simd(which);
    const auto session = make({});
    session->run(2, quiet);
    tick::TickRow row;
    ASSERT_TRUE(session->view(row));
    bones.push_back(session->bone().content_hash());
    ticks.push_back(row.hash);
  }
  rt::force_simd(best);
  for (std::size_t n = 1; n < bones.size(); ++n) {
    EXPECT_EQ(bones[n], bones[0]);
    EXPECT_EQ(ticks[n], ticks[0]);
  }
}

// A hand that presses straight down with a constant force: the plunge of
// docs/understand/cutting.md.
struct Plunge {
  double removed = 0, depth = 0, mean_force = 0;
};
Plunge plunge(double h_mm, double rate, double seconds = 1.5, double drag = 1) {
  NoProgress quiet;
  const double r = 2 * kMm;
  // a soft spring from far away is a constant force: 200 N/m, 5 mm below the surface
  device::HandPath path;
  const math::Quat across = math::shortest_rotation(Vec3::UnitZ(), Vec3::UnitX());
  path.points = {{0, {{0, 0, r + 1 * kMm}, across}, 1},
                 {0.3, {{0, 0, r + 1 * kMm}, across}, 1},
                 {0.5, {{0, 0, r - 5 * kMm}, across}, 1},
                 {10, {{0, 0, r - 5 * kMm}, across}, 1}};
  SessionSettings settings;
  settings.servo.rate_hz = rate;
  settings.servo.burr.radius = r;
  settings.servo.spindle_rad_s = 8.4 / r;
  settings.servo.limit.ramp_time = 0.05;
  settings.servo.undo_bricks = 2048;
  settings.servo.drag_gain = drag;
  auto session = Session::make(
      slab(h_mm, 6),
      std::make_unique<device::SimulatedHand>(path, device::ArmSettings{0.1, 10, 200}), settings,
      quiet);
  EXPECT_TRUE(session.ok());
  (*session)->run(0.5 + seconds, quiet);
  tick::TickRow row;
  EXPECT_TRUE((*session)->view(row));
  const Outcome outcome = (*session)->outcome();
  return {outcome.ledger.removed, r - row.contact.proxy.z(), outcome.mean_force};
}

TEST(Session, CutsTheSameAtAnyTickRate) {
  const Plunge at_1000 = plunge(0.25, 1000);
  EXPECT_GT(at_1000.removed, 1 * kMm3);
  for (const double rate : {500.0, 4000.0}) {
    const Plunge other = plunge(0.25, rate);
    EXPECT_NEAR(other.removed, at_1000.removed, 0.005 * at_1000.removed) << rate;
    EXPECT_NEAR(other.depth, at_1000.depth, 0.005 * at_1000.depth) << rate;
    EXPECT_NEAR(other.mean_force, at_1000.mean_force, 0.01 * at_1000.mean_force) << rate;
  }
}

TEST(Session, CutsTheSameAtAnyResolution) {
  const Plunge fine = plunge(0.125, 1000);
  const Plunge middle = plunge(0.25, 1000);
  EXPECT_NEAR(middle.removed, fine.removed, 0.01 * fine.removed);
  EXPECT_NEAR(middle.mean_force, fine.mean_force, 0.02 * fine.mean_force);
  // pressed straight down; dragged sideways as well, voxels of half a millimetre differ by 2.3 %
  EXPECT_NEAR(plunge(0.5, 1000, 1.5, 0).removed, plunge(0.125, 1000, 1.5, 0).removed,
              0.02 * fine.removed);
}

TEST(Session,
     TheDepthOfAPlungeFollowsFromItsVolume) {  // V = pi d^2 (r - d/3), d to the cut surface
  const double r = 2 * kMm;
  for (const double h_mm : {0.25, 0.125}) {
    const Plunge one = plunge(h_mm, 1000);
    double lo = 0, hi = 2 * r;
    for (int n = 0; n < 60; ++n) {
      const double d = 0.5 * (lo + hi);
      (M_PI * d * d * (r - d / 3) < one.removed ? lo : hi) = d;
    }
    EXPECT_NEAR(one.depth, lo, 0.1 * h_mm * kMm + 0.01 * lo) << h_mm;
  }
}

TEST(Session, UndoAndResetBringTheBoneBackWhileTheHandPressesAndNeverJump) {
  const auto session = make({.motion = "plunge", .seconds = 30});
  const std::uint64_t start = session->bone().content_hash();
  tick::Servo& servo = session->servo();
  Vec3 last = Vec3::Zero();
  const auto tick = [&] {
    const tick::TickRow& row = servo.tick(false);
    servo.publish();
    const double square = last.squaredNorm();
    const Vec3 kept = square > 0
                          ? Vec3(std::clamp(row.contact.force.dot(last) / square, 0.0, 1.0) * last)
                          : Vec3::Zero();
    EXPECT_LE((row.contact.force - kept).norm(), 0.3 + 1e-9);
    EXPECT_LE(row.contact.force.norm(), 3.3 + 1e-9);
    last = row.contact.force;
    return row;
  };
  for (int n = 0; n < 3000; ++n) (void)tick();
  ASSERT_NE(session->bone().content_hash(), start);
  for (const auto kind : {tick::CommandKind::undo, tick::CommandKind::reset}) {
    session->command({kind, 0});
    session->command({tick::CommandKind::tool_mode, 2});  // and does not cut again meanwhile
    int ticks = 0;
    do {
      const tick::TickRow row = tick();
      EXPECT_LT(volume::sample(session->bone(),
                               session->bone().grid().grid_from_world(row.contact.proxy)),
                0.5)
          << "the burr's centre is never in bone";
      ASSERT_LT(++ticks, 5000);
    } while (servo.restoring() || ticks < 3);
    EXPECT_EQ(session->bone().content_hash(), start);
    // the hand is still deep: the burr rests on the bone again, one radius above
    for (int n = 0; n < 50; ++n) (void)tick();
    const tick::TickRow row = tick();
    EXPECT_TRUE(row.contact.touching);
    EXPECT_GT(row.contact.proxy.z(), 2 * kMm - 0.05 * kMm);
    session->command({tick::CommandKind::tool_mode, 0});
    for (int n = 0; n < 1000; ++n) (void)tick();
    ASSERT_NE(session->bone().content_hash(), start);
  }
}

TEST(Session, TheTickTakesNeitherMemoryNorLock) {
  const auto session = make({.motion = "pocket", .seconds = 10});
  tick::Servo& servo = session->servo();
  for (const auto& command :
       std::initializer_list<tick::Command>{{tick::CommandKind::stiffness, 800}})
    session->command(command);
  const burr::test::RtGuard guard;
  for (int n = 0; n < 4000; ++n) {
    if (n == 1500) session->command({tick::CommandKind::undo, 0});
    if (n == 2200) session->command({tick::CommandKind::burr_radius, 1.5 * kMm});
    if (n == 2500) session->command({tick::CommandKind::tool_mode, 1});
    if (n == 3000) session->command({tick::CommandKind::reset, 0});
    if (n == 3500) session->command({tick::CommandKind::spindle_speed, 0});
    (void)servo.tick(n == 2000);
    servo.note_timing(1, 0);
    servo.publish();
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

TEST(Session, FuzzedHandsNeverGetMoreThanTheLimitAndNoNaN) {
  constexpr unsigned kSeed = 31337;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  auto bone = slab(0.5);
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 1, quiet);
  device::ReplayedHand hand({});
  tick::ServoSettings settings;
  settings.undo_bricks = 1024;
  tick::Servo servo(*bone, surface, hand, settings);
  device::HandState state;
  state.world_from_tool.p = {0, 0, 6 * kMm};
  int touched = 0;
  for (int n = 0; n < 30'000; ++n) {
    device::HandState now = state;
    const auto odd = random() % 2000;
    if (odd == 0) now.world_from_tool.p.x() = NAN;
    if (odd == 1) now.world_from_tool.p.y() = INFINITY;
    if (odd == 2) now.velocity.z() = NAN;
    if (odd == 3) now.valid = false;
    if (odd == 4) state.world_from_tool.p = Vec3(any(random), any(random), any(random)) * 0.05;
    if (odd == 5) now.pedal = NAN;
    if (odd > 10) {
      state.world_from_tool.p += Vec3(any(random), any(random), any(random)) * 0.4e-3;
      state.world_from_tool.p -= 0.002 * (state.world_from_tool.p - Vec3(0, 0, 2.4 * kMm));
    }
    now.pedal = n / 3000 % 2;
    hand.set(now);
    const tick::TickRow& row = servo.tick(odd == 6);
    servo.publish();
    touched += row.contact.touching ? 1 : 0;
    ASSERT_TRUE(row.contact.force.allFinite()) << n;
    ASSERT_TRUE(row.contact.proxy.allFinite()) << n;
    ASSERT_LE(row.contact.force.norm(), 3.3 + 1e-9) << n;
  }
  EXPECT_GT(touched, 1000);
}

TEST(Session, RefusesABurrSmallerThanTheVoxelsCanCarryWithTheCure) {
  NoProgress quiet;
  SessionSettings settings;
  settings.servo.burr.radius = 0.4 * kMm;
  auto session =
      Session::make(slab(0.25),
                    std::make_unique<device::SimulatedHand>(
                        *surgeon::motion("stroke", {}, 0.4 * kMm, 2), device::ArmSettings{}),
                    settings, quiet);
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().trouble, Trouble::usage);
  EXPECT_NE(session.error().text.find("voxels of 0.2"), std::string::npos) << session.error().text;
}

// ---- recorded and simulated again

class Replay : public testing::Test {
 protected:
  const burr::test::Folder folder_;
  const std::string file = folder_ / "s.mcap";

  void record(Session& session, double seconds, const std::function<void()>& between = {}) {
    NoProgress quiet;
    record::SessionInfo info;
    describe(session.settings(), session.hand().spec(), info);
    info.volume.content_hash = session.bone().content_hash();
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.recipe.reserve_bricks = 256;
    record::Recorder recorder(session.settings().servo.rate_hz);
    ASSERT_TRUE(recorder.start(file, info, &session.bone()).ok());
    session.set_recorder(&recorder);
    session.run(seconds / 2, quiet);
    if (between) between();
    session.run(seconds / 2, quiet);
    session.set_recorder(nullptr);
    auto account = recorder.finish();
    ASSERT_TRUE(account.ok()) << account.error().text;
    EXPECT_TRUE(account->whole());
  }
};

TEST_F(Replay, ComesOutTheSameToTheBitWithCommandsAndUndo) {
  const auto session = make({.seconds = 6});
  record(*session, 4, [&] {
    session->command({tick::CommandKind::undo, 0});
    session->command({tick::CommandKind::stiffness, 700});
  });
  const std::uint64_t end = session->bone().content_hash();
  NoProgress quiet;
  const rt::Simd best = rt::simd();
  for (const rt::Simd which : {best, rt::Simd::scalar}) {
    rt::force_simd(which);
    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok());
    auto bone = (*player)->embedded_bone(256);
    ASSERT_TRUE(bone.ok());
    auto outcome = replay(**player, std::move(*bone), quiet);
    ASSERT_TRUE(outcome.ok()) << outcome.error().text;
    EXPECT_FALSE(outcome->first_different_tick)
        << "tick " << *outcome->first_different_tick << ": " << outcome->difference;
    EXPECT_EQ(outcome->ticks, 4000U);
    EXPECT_GT(outcome->bricks, 100U);
    EXPECT_EQ(outcome->bone->content_hash(), end);
  }
  rt::force_simd(best);
  // and the bone at the end, without simulating
  auto player = record::Player::open(file);
  auto bone = (*player)->embedded_bone(256);
  ASSERT_TRUE((*player)->bone_at(4, **bone).ok());
  EXPECT_EQ((*bone)->content_hash(), end);
}

// What turned the hand is recorded and replayed, with the flags it set.
TEST_F(Replay, AHandThatIsTurnedComesOutTheSame) {
  SessionSettings settings;
  settings.servo.torque_gain = 3;
  settings.servo.limit.user_force = 2;
  const auto session = make({.seconds = 3}, settings, {},
                            {.peak_force = 12, .continuous_force = 12, .peak_torque = 0.2});
  record(*session, 2);
  NoProgress quiet;
  auto player = record::Player::open(file);
  auto outcome = replay(**player, std::move(*(*player)->embedded_bone(256)), quiet);
  ASSERT_TRUE(outcome.ok());
  EXPECT_FALSE(outcome->first_different_tick)
      << *outcome->first_different_tick << ": " << outcome->difference;
  record::StepCursor steps = (*player)->steps();
  record::Step step;
  double most = 0;
  while (steps.next(step)) most = std::max(most, step.row.contact.torque.norm());
  EXPECT_NEAR(most, 0.2 * 2 / 12, 1e-12) << "as much as the user's share of the force allows";
}

TEST_F(Replay, NamesTheTickAtWhichItParts) {
  const auto session = make({.seconds = 3});
  record(*session, 2);
  NoProgress quiet;
  auto player = record::Player::open(file);
  auto bone = (*player)->embedded_bone(256);
  // another bone: one voxel under the work is missing
  volume::BrickField content;
  const math::Ijk at =
      ((*bone)->grid().grid_from_world({0, 0, -0.3 * kMm}).array() + 0.5).floor().cast<int>();
  const volume::BrickIndex brick = (*bone)->brick_at(at.x() / 8, at.y() / 8, at.z() / 8);
  std::copy_n((*bone)->brick_field(brick), volume::kBrickVoxels, content.voxel);
  for (volume::Field& voxel : content.voxel) voxel = static_cast<volume::Field>(voxel / 2);
  (*bone)->write_brick(brick, content);
  auto outcome = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(outcome.ok());
  ASSERT_TRUE(outcome->first_different_tick.has_value());
  EXPECT_GT(*outcome->first_different_tick, 100U);
  EXPECT_FALSE(outcome->difference.empty());
}

// ---- everything at once, for ThreadSanitizer

TEST_F(Replay, AWholeSessionInRealTimeBesideSurfaceRecorderAndViewer) {
  const auto session = make({.motion = "pocket", .seconds = 4, .h_mm = 0.5, .realtime = true});
  record::SessionInfo info;
  describe(session->settings(), session->hand().spec(), info);
  info.volume.grid = session->bone().grid();
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(file, info).ok());
  surface::Worker worker(session->bone(), 1);
  NoProgress quiet;
  int patches = 0;
  ASSERT_TRUE(worker.first(quiet, [&](const surface::Skin&) { ++patches; }).ok());
  session->set_recorder(&recorder);
  session->start();
  int views = 0;
  tick::TickRow row;
  for (int n = 0; n < 75; ++n) {
    surface::Skin skin;
    while (worker.take(skin)) {
      ++patches;
      worker.give_back(skin);
    }
    views += session->view(row) ? 1 : 0;
    if (n == 40) session->command({tick::CommandKind::undo, 0});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  session->stop();
  session->set_recorder(nullptr);
  EXPECT_TRUE(recorder.finish().ok());
  EXPECT_GT(views, 10);
  EXPECT_GT(patches, 0);
  EXPECT_GT(session->outcome().ticks, 300U);
  EXPECT_FALSE(session->outcome().scheduling.empty());
}

// ---- where work begins

TEST(Motion, FindsTheTopmostBoneUnderTheMiddleAlongItsNormal) {
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
      phantom::ball(5 * kMm, {1 * kMm, 0, 0}));
  auto place = surgeon::find_work_place(*bone, 1 * kMm, {}, {});
  ASSERT_TRUE(place.ok());
  EXPECT_NEAR(place->at.z(), std::sqrt(24.0) * kMm, 0.15 * kMm);
  const Vec3 inward = (Vec3(1 * kMm, 0, 0) - place->at).normalized();
  EXPECT_GT(place->into.dot(inward), 0.99);
  auto aside = surgeon::find_work_place(*bone, 1 * kMm, Vec3(6 * kMm, 0, 0), Vec3(-1, 0, 0));
  ASSERT_TRUE(aside.ok());
  EXPECT_NEAR(aside->at.x(), 6 * kMm, 0.15 * kMm);
  EXPECT_FALSE(
      surgeon::find_work_place(*bone, 1 * kMm, Vec3(0, 7.5 * kMm, 7.5 * kMm), Vec3(1, 0, 0)).ok());
}

}  // namespace
}  // namespace burr::sim
