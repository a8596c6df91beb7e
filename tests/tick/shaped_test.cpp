// Tools that are more than a ball, in whole sessions: a burr whose shaft touches, and every tool of
// the rack; what they cut, what they never cut, and that a recording holds them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <vector>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/scenario/rack.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3;

Quat about(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis)); }

// A session whose hand the test moves.
struct Bench {
  std::unique_ptr<sim::Session> session;
  device::ReplayedHand* hand = nullptr;
  TickRow row;
  Vec3 last = Vec3::Zero();

  Bench(const phantom::Depth& depth, sim::SessionSettings settings) {
    NoProgress quiet;
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    hand = owned.get();
    settings.servo.undo_bricks = 512;
    settings.surface.reserve_blocks = 1 << 12;
    auto made = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
            depth, 64),
        std::move(owned), settings, quiet);
    EXPECT_TRUE(made.ok()) << made.error().text;
    session = std::move(*made);
  }
  const TickRow& at(const Pose& pose, double pedal = 1) {
    device::HandState state;
    state.world_from_tool = pose;
    state.velocity = row.tick == 0 ? Vec3(Vec3::Zero()) : Vec3((pose.p - last) * 1e3);
    state.pedal = pedal;
    state.valid = true;
    last = pose.p;
    hand->set(state);
    row = session->servo().tick(false);
    session->servo().publish();
    return row;
  }
};

// In a hole of 4 mm radius the burr hangs free; its shaft is leant against the rim, turning all the
// time.
TEST(ShaftInASession, TouchesAndNeverCutsAndTheRecordingSaysSo) {
  sim::SessionSettings settings;
  settings.servo.touch = haptics::Method::shaft;
  settings.servo.burr.radius = 1.5 * kMm;
  Bench bench(phantom::without(phantom::slab(), phantom::cylinder(4 * kMm, 40 * kMm)), settings);
  const Vec3 deep(0, 0, -6 * kMm);
  int rests = 0;
  double force = 0, torque = 0, turn = 0;
  for (int n = 0; n < 700; ++n) {
    const double lean = n < 300 ? 0.0 : 0.75 * std::sin(std::numbers::pi * (n - 300) / 400);
    const Vec3 from(0, 0, 2 * kMm);
    const Vec3 p = n < 300 ? Vec3(from + (deep - from) * (n / 300.0)) : deep;
    bench.at({p, about(Vec3::UnitY(), lean)});
    if ((bench.row.contact.flags & rt::kFlagShaft) == 0) continue;
    ++rests;
    force = std::max(force, bench.row.contact.force.norm());
    torque = std::max(torque, bench.row.contact.unsent_torque.norm());
    turn = std::max(turn, bench.row.contact.turn.norm());
  }
  EXPECT_GT(rests, 100);
  EXPECT_GT(force, 0.2);
  EXPECT_GT(torque, 1e-3);
  EXPECT_GT(turn, 1e-3);
  EXPECT_EQ(bench.row.ledger.asked, 0);
  EXPECT_EQ(bench.row.ledger.removed, 0);
}

// As constraint, to the bit, where nothing but the head touches.
TEST(ShaftInASession, IsTheBallToTheBitWhereTheShaftIsFree) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2 * kMm;
  Bench ball(phantom::slab(), settings);
  settings.servo.touch = haptics::Method::shaft;
  Bench shaft(phantom::slab(), settings);
  for (int n = 0; n < 600; ++n) {
    const double z = 2 * kMm + (n < 200 ? 1 - n * 5e-3 : 0) * kMm - (n < 200 ? 0 : 0.4 * kMm);
    const Pose pose{Vec3((n < 300 ? 0 : (n - 300) * 5e-3) * kMm, 0, z),
                    about(Vec3::UnitY(), 0.3 * std::sin(n * 1e-2))};
    ball.at(pose);
    shaft.at(pose);
    ASSERT_EQ(ball.row.contact.force, shaft.row.contact.force) << n;
    ASSERT_EQ(ball.row.ledger.removed, shaft.row.ledger.removed) << n;
  }
  EXPECT_GT(ball.row.ledger.removed, 0.05e-9);
}

tool::ShapedTool of_rack(const std::string& name) {
  const scenario::RackTool* found = scenario::built_in_rack().find(name);
  EXPECT_NE(found, nullptr) << name;
  return {found->name, found->tool, found->cutter};
}

// How each tool is held to cut the top of a slab, and the way it then goes along it.
Quat held(const std::string& name) {
  const std::set<std::string> lying = {"fissure-bur", "lindemann", "flame", "wheel"};
  if (lying.contains(name)) return about(Vec3::UnitY(), std::numbers::pi / 2);
  if (name == "reciprocating-saw") return about(Vec3::UnitY(), -std::numbers::pi / 2);
  return Quat::Identity();
}

struct Done {
  edit::Ledger ledger;
  double volume = 0;       // gone from the bone  [m^3]
  double force = 0;        // largest             [N]
  std::uint64_t hash = 0;  // of the last tick
  long allocations = 0, locks = 0;
};

// Comes down until the tool is 1 mm deep, then goes 2 mm along x.
Done work(Bench& bench, const std::string& name, int ticks = 500) {
  Done done;
  const double before = volume::volume_of(bench.session->bone());
  const Quat turn = held(name);
  const tool::ShapedTool& tool = bench.session->settings().servo.tools.front();
  double low = 0;  // of the tool below its origin
  for (int p = 0; p < tool.tool.count; ++p) {
    const tool::Part& part = tool.tool.parts[static_cast<std::size_t>(p)];
    if (part.role != tool::Role::cuts) continue;
    const Vec3 down = (turn * part.tool_from_part.q).conjugate() * Vec3(-Vec3::UnitZ());
    low = std::max(low, tool::support(part.shape, down) - (turn * part.tool_from_part.p).z());
  }
  {
    const burr::test::RtGuard guard;
    for (int n = 0; n < ticks; ++n) {
      const double t = n / static_cast<double>(ticks);
      const double z = t < 0.5 ? 0.3 - 2.6 * t : -1, x = t < 0.5 ? 0 : 4 * (t - 0.5);
      bench.at({Vec3(x * kMm, 0.06 * kMm, low + z * kMm), turn});
      done.force = std::max(done.force, bench.row.contact.force.norm());
    }
    done.allocations = guard.allocations();
    done.locks = guard.locks();
  }
  done.ledger = bench.row.ledger;
  done.volume = before - volume::volume_of(bench.session->bone());
  done.hash = bench.row.hash;
  return done;
}

sim::SessionSettings with_tool(const tool::ShapedTool& tool) {
  sim::SessionSettings settings;
  settings.servo.tools = {tool};
  settings.servo.tool = 0;
  return settings;
}

TEST(RackInASession, EveryToolCutsAndItsLedgerIsExact) {
  for (const scenario::RackTool& tool : scenario::built_in_rack().all) {
    Bench bench(phantom::slab(), with_tool({tool.name, tool.tool, tool.cutter}));
    // the mallet strikes every half second; a slow drill and a curette take little of hard bone
    const bool struck = tool.cutter.drive == tool::Drive::struck;
    const Done done = work(bench, tool.name, struck ? 1100 : 500);
    const bool slow = tool.name == "twist-drill" || tool.name == "curette" || tool.name == "gouge";
    EXPECT_GT(done.ledger.removed, slow ? 0.5e-12 : 20e-12) << tool.name;
    EXPECT_NEAR(done.volume, done.ledger.removed, 1e-6 * done.ledger.removed) << tool.name;
    EXPECT_NEAR(done.ledger.asked, done.ledger.removed + done.ledger.debt + done.ledger.not_cut,
                1e-9 * done.ledger.asked)
        << tool.name;
    EXPECT_GT(done.force, 0.05) << tool.name;
    EXPECT_EQ(done.allocations, 0) << tool.name;
    EXPECT_EQ(done.locks, 0) << tool.name;
    EXPECT_EQ(bench.row.tool.number, 0);
  }
}

TEST(RackInASession, ATurningToolThatStandsAndAStruckOneWithoutABlowCutNothing) {
  for (const char* name : {"fissure-bur", "sagittal-saw", "osteotome"}) {
    Bench bench(phantom::slab(), with_tool(of_rack(name)));
    for (int n = 0; n < 200; ++n) bench.at({Vec3(0, 0, (6 - 0.05 * n) * kMm), held(name)}, 0);
    EXPECT_GT(bench.row.contact.force.norm(), 0.5) << name;
    EXPECT_EQ(bench.row.ledger.asked, 0) << name;
  }
}

// The mallet strikes when the pedal goes down and every half second while it stays down. Each blow spends its energy
// within 10 ms, all of it on the bone that is in front of the edge, and nothing between two blows.
TEST(RackInASession, ABlowSpendsItsEnergyOnceAndAgainEveryHalfSecond) {
  const tool::ShapedTool osteotome = of_rack("osteotome");
  Bench bench(phantom::slab(), with_tool(osteotome));
  const Pose pressed{Vec3(0, 0, -1 * kMm), Quat::Identity()};
  for (int n = 0; n < 300; ++n) bench.at({Vec3(0, 0, (2 - 0.01 * n) * kMm), Quat::Identity()}, 0);
  ASSERT_EQ(bench.row.ledger.energy, 0);
  const double blow = osteotome.cutter.blow_j;
  std::vector<int> ticks;  // in which it cut, but for what rounding leaves of a blow
  for (int n = 0; n < 1200; ++n) {
    const double before = bench.row.ledger.energy;
    bench.at(pressed, 1);
    if (bench.row.ledger.energy > before + 1e-9 * blow) ticks.push_back(n);
  }
  ASSERT_EQ(ticks.size(), 30U) << "three blows of ten ticks";
  for (std::size_t n = 0; n < ticks.size(); ++n)
    EXPECT_NEAR(ticks[n], 500 * static_cast<int>(n / 10) + static_cast<int>(n % 10), 1);
  EXPECT_NEAR(bench.row.ledger.energy, 3 * blow, 1e-9);
  EXPECT_GT(bench.row.ledger.removed, 0.1e-9);
  // the pedal up and down again is a blow at once
  for (int n = 0; n < 5; ++n) bench.at(pressed, 0);
  for (int n = 0; n < 12; ++n) bench.at(pressed, 1);
  EXPECT_NEAR(bench.row.ledger.energy, 4 * blow, 1e-9);
}

// A shaft that turns about x and lies on bone: clockwise seen from the hand its lowest place runs along -y,
// so the bone drags it along y by mu N, and it removes nothing; a handle to the other side turns the other way. Half the difference
// is free of the slant of the bone's points. One that stands is not dragged.
TEST(RackInASession, AShaftThatTurnsOnBoneIsDraggedByFrictionAgainstItsTurn) {
  tool::ShapedTool tool;
  tool.name = "leaning";
  tool.cutter.drive = tool::Drive::turning;
  tool.cutter.speed_rad_s = 2000;
  const tool::Shape head = {tool::ShapeKind::ball, 0, 0, 0, 0.5 * kMm},
                    shaft = {tool::ShapeKind::capsule, 0, 0, 3 * kMm, 1 * kMm};
  const auto mean_force = [&](double side, double pedal) {
    const Quat turn = about(Vec3::UnitY(), side * std::numbers::pi / 2);  // the handle lies along x
    tool.tool = {};
    EXPECT_TRUE(tool::add_part(tool.tool, {shaft, {}, tool::Role::rubs}));
    EXPECT_TRUE(tool::add_part(
        tool.tool,
        {head, {turn.conjugate() * Vec3(0, 0, 4 * kMm), Quat::Identity()}, tool::Role::cuts}));
    Bench bench(phantom::slab(), with_tool(tool));
    Vec3 sum = Vec3::Zero();
    for (int n = 0; n < 1500; ++n) {
      const double z = std::max(0.6, 2.0 - 4e-3 * n);
      bench.at({Vec3(0, 0.06 * kMm, z * kMm), turn}, pedal);
      if (n >= 1000) sum += bench.row.contact.force / 500;
    }
    EXPECT_GT(sum.z(), 0.2);
    EXPECT_EQ(bench.row.ledger.asked, 0);
    return sum;
  };
  const double mu = sim::SessionSettings().servo.friction_turning;
  const Vec3 one = mean_force(1, 1), other = mean_force(-1, 1);
  EXPECT_NEAR(0.5 * (one.y() - other.y()), mu * one.z(), 0.05 * mu * one.z());
  EXPECT_NEAR(one.x(), 0, 0.2 * mu * one.z());
  const Vec3 stands = mean_force(1, 0), stands_too = mean_force(-1, 0);
  EXPECT_NEAR(0.5 * (stands.y() - stands_too.y()), 0, 0.05 * mu * stands.z());
}

TEST(RackInASession, ToolsAreTakenInItsMiddleAndAnUndoBringsTheBoneBack) {
  sim::SessionSettings settings = with_tool(of_rack("sagittal-saw"));
  settings.servo.tools.push_back(of_rack("flame"));
  Bench bench(phantom::slab(), settings);
  const std::uint64_t whole = bench.session->bone().content_hash();
  static_cast<void>(work(bench, "sagittal-saw"));
  const double sawn = bench.row.ledger.removed;
  const Pose above{Vec3(0, 0, 6 * kMm), Quat::Identity()};
  bench.session->command({CommandKind::tool, 1});
  for (int n = 0; n < 50; ++n) bench.at(above);
  EXPECT_EQ(bench.row.tool.number, 1);
  bench.session->command({CommandKind::tool, 7});  // there is none: nothing changes
  for (int n = 0; n < 250; ++n)
    bench.at({Vec3(0, 0, (6 - n * 0.02) * kMm), about(Vec3::UnitY(), std::numbers::pi / 2)});
  EXPECT_EQ(bench.row.tool.number, 1);
  EXPECT_GT(bench.row.ledger.removed, sawn);
  for (int n = 0; n < 400; ++n) bench.at(above, 0);
  for (int undo = 0; undo < 2; ++undo) {
    bench.session->command({CommandKind::undo, 0});
    for (int n = 0; n < 300; ++n) bench.at(above, 0);
  }
  EXPECT_EQ(bench.session->bone().content_hash(), whole);
  bench.session->command({CommandKind::tool, -1});
  for (int n = 0; n < 50; ++n) bench.at(above);
  EXPECT_EQ(bench.row.tool.number, -1);
}

// The recording holds the definition, so that no rack is needed.
TEST(RackInASession, IsRecordedByDefinitionAndReplaysToTheSameBits) {
  NoProgress quiet;
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  tool::ShapedTool own = of_rack("sagittal-saw");
  own.name = "nobodys-saw";
  Bench bench(phantom::slab(), with_tool(own));
  record::SessionInfo info;
  sim::describe(bench.session->settings(), bench.session->hand().spec(), info);
  info.volume.content_hash = bench.session->bone().content_hash();
  info.volume.grid = bench.session->bone().grid();
  info.volume.tissues = bench.session->bone().tissues();
  info.volume.recipe.reserve_bricks = 64;
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(file, info, &bench.session->bone()).ok());
  bench.session->set_recorder(&recorder);
  static_cast<void>(work(bench, "sagittal-saw", 400));
  bench.session->set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());
  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok());
  ASSERT_EQ((*player)->info().tools.size(), 1U);
  EXPECT_EQ((*player)->info().tools.front().name, "nobodys-saw");
  auto bone = (*player)->embedded_bone(64);
  ASSERT_TRUE(bone.ok());
  const auto again = sim::replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick)
      << "tick " << *again->first_different_tick << ": " << again->difference;
  EXPECT_EQ(again->ticks, 400U);
  EXPECT_EQ(again->bone->content_hash(), bench.session->bone().content_hash());
}

// Recordings from before tools had friction, rested on planes, or came to rest so closely lack the setting, and
// are replayed as they were made. older: puts it as it was then.
void expect_old_recordings_replay(const char* setting,
                                  const std::function<void(tick::ServoSettings&)>& older,
                                  double friction_scale = 1,
                                  const std::function<void(tick::ServoSettings&)>& newer = {}) {
  NoProgress quiet;
  const burr::test::Folder folder;
  std::uint64_t hashes[2] = {};
  for (const bool on : {true, false}) {
    const std::string file = folder / (on ? "new.mcap" : "old.mcap");
    sim::SessionSettings settings = with_tool(of_rack("osteotome"));
    settings.servo.friction_scale = friction_scale;
    if (on && newer) newer(settings.servo);
    if (!on) older(settings.servo);
    Bench bench(phantom::slab(), settings);
    record::SessionInfo info;
    sim::describe(bench.session->settings(), bench.session->hand().spec(), info);
    ASSERT_EQ(info.numbers.count(setting), 1U);
    if (!on) info.numbers.erase(setting);
    info.volume.content_hash = bench.session->bone().content_hash();
    info.volume.grid = bench.session->bone().grid();
    info.volume.tissues = bench.session->bone().tissues();
    info.volume.recipe.reserve_bricks = 64;
    record::Recorder recorder(1000);
    ASSERT_TRUE(recorder.start(file, info, &bench.session->bone()).ok());
    bench.session->set_recorder(&recorder);
    const Done done = work(bench, "osteotome", 600);
    hashes[on ? 1 : 0] = done.hash;
    bench.session->set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok());
    auto bone = (*player)->embedded_bone(64);
    ASSERT_TRUE(bone.ok());
    const auto again = sim::replay(**player, std::move(*bone), quiet);
    ASSERT_TRUE(again.ok()) << again.error().text;
    EXPECT_FALSE(again->first_different_tick)
        << "tick " << *again->first_different_tick << ": " << again->difference;
    EXPECT_EQ(again->ticks, 600U);
  }
  EXPECT_NE(hashes[0], hashes[1]) << "it is felt: the test shows nothing otherwise";
}

TEST(RackInASession, ARecordingWithoutTheSettingOfFrictionReplaysAsItWasMade) {
  expect_old_recordings_replay("tool_friction",
                               [](tick::ServoSettings& servo) { servo.tool_friction = false; });
}

TEST(RackInASession, ARecordingWithoutTheSettingOfPlanesReplaysAsItWasMade) {
  expect_old_recordings_replay(
      "tool_planes", [](tick::ServoSettings& servo) { servo.tool_planes = false; }, 0,
      [](tick::ServoSettings& servo) { servo.tool_planes = true; });
}

TEST(RackInASession, ARecordingWithoutTheSettingOfRestReplaysAsItWasMade) {
  expect_old_recordings_replay("tool_close_m",
                               [](tick::ServoSettings& servo) { servo.tool_close = 1e-6; });
}

// A saw vibrates along its stroke. The hand of the test does not give way, so the same session without
// vibration has the rest of the force.
TEST(RackInASession, ASawVibratesAlongItsStroke) {
  for (const char* name : {"sagittal-saw", "reciprocating-saw"}) {
    sim::SessionSettings settings = with_tool(of_rack(name));
    settings.servo.mode = ToolMode::touch;  // both feel the same bone
    Bench still(phantom::slab(), settings);
    settings.servo.vibration_gain = 1;
    Bench shakes(phantom::slab(), settings);
    const Quat turn = held(name);
    const Vec3 way = turn * settings.servo.tools.front().cutter.way;
    ASSERT_LT(std::abs(way.z()), 0.1) << "along the bone";
    double along = 0, all = 0, normal = 0;
    int touching = 0;
    for (int n = 0; n < 1200; ++n) {
      const Pose pose{Vec3(0, 0.06 * kMm, (16 - 0.02 * std::min(n, 800)) * kMm), turn};
      const Vec3 off = shakes.at(pose).contact.force - still.at(pose).contact.force;
      ASSERT_EQ(shakes.row.contact.proxy, still.row.contact.proxy) << n;
      if (!still.row.contact.touching || n < 900) continue;
      ++touching;
      all += off.squaredNorm();
      along += std::pow(off.dot(way), 2);
      normal += std::pow(off.dot(still.row.contact.normal), 2);
    }
    ASSERT_GT(touching, 200) << name;
    EXPECT_GT(std::sqrt(all / touching), 0.01) << name << ": it is felt";
    EXPECT_GT(along, 0.95 * all) << name;
    EXPECT_LT(normal, 0.01 * all) << name;
  }
}

// A hand of mass on the spring of the device, drawn over rough bone with a tool that stands, then held
// still: friction takes energy, so what is left of the motion dies away, and nothing trembles.
TEST(RackInASession, AHandWithMassComesToRestOnATool) {
  constexpr double kT = 1e-3, kMass = 0.1, kArm = 400, kDamping = 4;  // kg, N/m, N s/m
  for (const char* name : {"flame", "sagittal-saw", "osteotome", "wheel"}) {
    sim::SessionSettings settings = with_tool(of_rack(name));
    settings.servo.force.damping = 0;  // only friction and the arm take energy
    Bench bench(phantom::gyroid(8 * kMm), settings);
    const Quat turn = held(name);
    Vec3 x(0, 0, 20 * kMm), v = Vec3::Zero();
    double began = 0, most = 0, last = 0, fastest = 0, trembles = 0;
    Vec3 rest = Vec3::Zero();
    int stuck = 0;
    for (int n = 0; n < 5000; ++n) {           // later the device would get too warm
      const double t = std::min(n * kT, 3.0);  // the arm stops after three seconds
      const double down = std::min(1.0, t / 1.5), way = std::max(0.0, t - 1.5);
      const Vec3 arm(4 * kMm * std::sin(3 * way), 3 * kMm * std::sin(2 * way),
                     (20 - 22 * down) * kMm);
      const TickRow& row = bench.at({x, turn}, 0);
      const Vec3 force = row.contact.force;
      const double energy = 0.5 * kMass * v.squaredNorm() + 0.5 * kArm * (arm - x).squaredNorm() +
                            0.5 * force.squaredNorm() / settings.servo.force.stiffness;
      v += kT / kMass * (force + kArm * (arm - x) - kDamping * v);
      x += kT * v;
      ASSERT_TRUE(x.allFinite());
      if (n == 3000) began = energy;
      if (n >= 3000) most = std::max(most, energy);
      if (n >= 1500) fastest = std::max(fastest, v.norm());
      if (n == 4000) rest = x;
      if (n >= 4000) trembles = std::max(trembles, (x - rest).norm());
      last = energy;
      stuck += row.contact.touching ? 1 : 0;
    }
    EXPECT_GT(stuck, 2500) << name;
    EXPECT_LT(most, 1.01 * began) << name << ": energy does not grow once the arm is still";
    EXPECT_LT(last, 1.002 * began) << name;
    EXPECT_LT(trembles, 2e-6) << name;
    EXPECT_LT(fastest, 0.3) << name << ": it slips, but is not thrown";
  }
}

TEST(RackInASession, ATooCoarseBoneAndAnotherLawAreRefusedWithTheRemedy) {
  NoProgress quiet;
  const auto refused = [&](sim::SessionSettings settings, double voxel) {
    auto made = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), voxel), {},
            phantom::slab(), 64),
        std::make_unique<device::ReplayedHand>(device::DeviceSpec{}), settings, quiet);
    return made.ok() ? std::string() : made.error().text;
  };
  sim::SessionSettings settings = with_tool(of_rack("reciprocating-saw"));
  EXPECT_NE(refused(settings, 0.6 * kMm).find("voxels of 0.500 mm or finer"), std::string::npos);
  settings.servo.removal.law = edit::RemovalLaw::chips;
  EXPECT_NE(refused(settings, 0.25 * kMm).find("chips"), std::string::npos);
}

}  // namespace
}  // namespace burr::tick
