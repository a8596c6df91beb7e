// The torque of a contact, in whole sessions whose device can turn the hand.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "burr/haptics/safety/coupling.h"
#include "burr/haptics/safety/lever.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/scenario/rack.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/controls.h"
#include "burr/tick/servo.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3;

device::DeviceSpec turning_device() {
  return {.peak_force = 12,
          .continuous_force = 12,
          .peak_torque = 0.2,
          .max_turn_stiffness = 0.3};  // with a stiffness of 1 N/mm: L^2 = 300 mm^2
}

// A hand that the test moves and that keeps what it is told.
class MovedHand final : public device::Device {
 public:
  explicit MovedHand(device::DeviceSpec spec) : spec_(std::move(spec)) {}
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double) BURR_RT override { return now; }
  void write_force(const Vec3& push) BURR_RT override {
    force = push;
    torque = next_;
    next_ = Vec3::Zero();
  }
  void write_torque(const Vec3& turn) BURR_RT override { next_ = turn; }
  device::HandState now;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();

 private:
  device::DeviceSpec spec_;
  Vec3 next_ = Vec3::Zero();
};

struct Bench {
  std::unique_ptr<sim::Session> session;
  MovedHand* hand = nullptr;
  TickRow row;
  Vec3 last = Vec3::Zero();

  Bench(const phantom::Depth& depth, sim::SessionSettings settings,
        const device::DeviceSpec& spec = turning_device()) {
    NoProgress quiet;
    auto owned = std::make_unique<MovedHand>(spec);
    hand = owned.get();
    settings.servo.undo_bricks = 512;
    settings.servo.limit.user_force = 12;
    settings.surface.reserve_blocks = 1 << 12;
    auto made = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-12 * kMm), Vec3::Constant(12 * kMm), 0.25 * kMm), {},
            depth, 64),
        std::move(owned), settings, quiet);
    EXPECT_TRUE(made.ok()) << made.error().text;
    session = std::move(*made);
  }
  const TickRow& at(const Pose& pose, double pedal = 0, bool lost = false) {
    hand->now.world_from_tool = pose;
    hand->now.velocity = row.tick == 0 ? Vec3(Vec3::Zero()) : Vec3((pose.p - last) * 1e3);
    hand->now.pedal = pedal;
    last = pose.p;
    row = session->servo().tick(lost);
    session->servo().publish();
    return row;
  }
};

sim::SessionSettings with_shaft() {
  sim::SessionSettings settings;
  settings.servo.touch = haptics::Method::shaft;
  settings.servo.burr.radius = 1.5 * kMm;
  return settings;
}

tool::ShapedTool of_rack(const std::string& name) {
  const scenario::RackTool* found = scenario::built_in_rack().find(name);
  EXPECT_NE(found, nullptr) << name;
  return {found->name, found->tool, found->cutter};
}

// A round ridge along y; the shaft lies across it, along x, and the head hangs in the air beside it.
// How far from the head's centre the shaft rests: l.
constexpr double kRidge = 2 * kMm;
phantom::Depth ridge() { return phantom::capsule({0, -40 * kMm, 0}, {0, 40 * kMm, 0}, kRidge); }
Quat along_x() { return Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY())); }
Pose across(double l, double height) { return {Vec3(-l, 0, height), along_x()}; }

// Comes down in the air and waits there for the ramp, then on to `height`.
void lower(Bench& bench, double l, double height, double from = 8 * kMm) {
  for (int n = 0; n < 600; ++n) bench.at(across(l, from));
  constexpr int kTicks = 400;
  for (int n = 0; n <= kTicks; ++n) bench.at(across(l, from + (height - from) * n / kTicks));
  for (int n = 0; n < 100; ++n) bench.at(across(l, height));
}

// The height at which the shaft just touches the ridge: found by the contact itself.
double height_of_contact(double l) {
  Bench bench(ridge(), with_shaft());
  for (int n = 0; n < 600; ++n) bench.at(across(l, 8 * kMm));
  double height = 8 * kMm;
  while (!bench.row.contact.touching && height > 0) {
    height -= 0.005 * kMm;
    bench.at(across(l, height));
  }
  EXPECT_GT(height, kRidge);
  return height;
}

// One contact at the lever l: N = delta / (1/k_t + l^2/k_r) and the torque N l, and both are sent.
TEST(TorqueOfAContact, GoesToTheHandThatCanBeTurned) {
  const double l = 9 * kMm, delta = 0.5 * kMm, k_t = 1000, k_r = 0.3;
  Bench bench(ridge(), with_shaft());
  lower(bench, l, height_of_contact(l) - delta);
  const haptics::Contact& contact = bench.row.contact;
  ASSERT_NE(contact.flags & rt::kFlagShaft, 0U) << "the shaft rests, the head does not";
  EXPECT_EQ(bench.hand->force, contact.force);
  EXPECT_EQ(bench.hand->torque, contact.torque);
  EXPECT_EQ(contact.unsent_torque, Vec3::Zero());
  const double truth = delta / (1 / k_t + l * l / k_r);
  EXPECT_NEAR(contact.force.z(), truth, 0.04 * truth);
  // up at +x of the head: it turns the hand about -y
  EXPECT_NEAR(-contact.torque.y() / contact.force.z(), l, 0.5 * kMm);
  EXPECT_NEAR((contact.torque - k_r * contact.turn).norm(), 0, 1e-9);

  // without torque the spring of turning is the virtual one of 60 mm, and the torque is not sent
  Bench pushes(ridge(), with_shaft(), {.peak_force = 12, .continuous_force = 12});
  lower(pushes, l, height_of_contact(l) - delta);
  EXPECT_EQ(pushes.hand->torque, Vec3::Zero());
  EXPECT_GT(pushes.row.contact.unsent_torque.norm(), 1e-3);
  EXPECT_GT(pushes.row.contact.force.z(), truth * 1.1);

  // a recording from before there was any, or a user who wants none
  sim::SessionSettings without = with_shaft();
  without.servo.turn_hand = false;
  Bench old(ridge(), without);
  lower(old, l, height_of_contact(l) - delta);
  EXPECT_EQ(old.hand->torque, Vec3::Zero());
  EXPECT_EQ(old.row.contact.force, pushes.row.contact.force);
}

TEST(TorqueOfAContact, IsLimitedWithTheForceByOneFactor) {
  const double l = 9 * kMm, height = height_of_contact(l) - 1 * kMm;
  Bench free(ridge(), with_shaft());
  lower(free, l, height);
  const Vec3 force = free.row.contact.force, torque = free.row.contact.torque;
  ASSERT_GT(torque.norm(), 5e-3);
  for (const bool by_torque : {true, false}) {
    device::DeviceSpec weak = turning_device();
    if (by_torque) weak.peak_torque = 0.4 * torque.norm();
    if (!by_torque) weak.peak_force = weak.continuous_force = 0.3 * force.norm();
    Bench bench(ridge(), with_shaft(), weak);
    lower(bench, l, height);
    const double share = by_torque ? 0.4 : 0.3;
    EXPECT_NEAR((bench.row.contact.force - share * force).norm(), 0, 1e-6) << by_torque;
    EXPECT_NEAR((bench.row.contact.torque - share * torque).norm(), 0, 1e-8) << by_torque;
    EXPECT_NE(bench.row.contact.flags & rt::kFlagForceLimited, 0U);
  }
}

TEST(TorqueOfAContact, IsReleasedWithTheForceAndStaysAway) {
  const double l = 9 * kMm, height = height_of_contact(l) - 1 * kMm;
  const auto lifted = [](Bench& bench) { bench.hand->now.buttons = device::kLifted; };
  const auto gone = [](Bench& bench) { bench.hand->now.valid = false; };
  const auto leaps = [&](Bench& bench) {
    bench.hand->now.world_from_tool.q = along_x() * Quat(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
  };
  int which = 0;
  for (const std::function<void(Bench&)>& trouble :
       std::vector<std::function<void(Bench&)>>{lifted, gone, leaps}) {
    Bench bench(ridge(), with_shaft());
    lower(bench, l, height);
    const Vec3 force = bench.hand->force, torque = bench.hand->torque;
    ASSERT_GT(torque.norm(), 5e-3);
    for (int n = 1; n <= 300; ++n) {
      bench.hand->now.world_from_tool = across(l, height);
      trouble(bench);
      bench.row = bench.session->servo().tick(false);
      bench.session->servo().publish();
      // linearly to zero in 5 ms, both alike
      const double left = std::max(0.0, 1 - 0.2 * n);
      ASSERT_NEAR((bench.hand->force - left * force).norm(), 0, 1e-9) << which << " " << n;
      ASSERT_NEAR((bench.hand->torque - left * torque).norm(), 0, 1e-9) << which << " " << n;
    }
    ++which;
  }
  // lost ticks: the guard has faded already, so both are zero at once, until the contact is light
  Bench bench(ridge(), with_shaft());
  lower(bench, l, height);
  bench.at(across(l, height), 0, true);
  for (int n = 0; n < 300; ++n) {
    bench.at(across(l, height));
    ASSERT_EQ(bench.hand->force, Vec3::Zero());
    ASSERT_EQ(bench.hand->torque, Vec3::Zero());
  }
}

// Down beside the ridge with a turning tool, leaning against it and cutting; recorded and replayed.
TEST(TorqueOfAContact, TakesNoMemoryAndReplaysToTheBit) {
  NoProgress quiet;
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  sim::SessionSettings settings;
  settings.servo.tools = {of_rack("fissure-bur")};
  settings.servo.tool = 0;
  device::DeviceSpec spec = turning_device();
  spec.turn_damping = 4e-4;
  spec.lever = 5 * kMm;
  spec.scale = 0.5;
  Bench bench(phantom::slab(), settings, spec);
  record::SessionInfo info;
  sim::describe(bench.session->settings(), spec, info);
  info.volume.content_hash = bench.session->bone().content_hash();
  info.volume.grid = bench.session->bone().grid();
  info.volume.tissues = bench.session->bone().tissues();
  info.volume.recipe.reserve_bricks = 64;
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(file, info, &bench.session->bone()).ok());
  bench.session->set_recorder(&recorder);
  double most = 0, moment = 0;
  long allocations = 0, locks = 0;
  for (int n = 0; n < 2000; ++n) {
    const double down = std::min(1.0, std::max(0, n - 600) / 600.0);
    const Pose pose{Vec3(std::sin(n * 2e-3) * kMm, 0, (6 - 5 * down) * kMm),
                    along_x() * Quat(Eigen::AngleAxisd(0.15 * std::sin(n * 3e-3), Vec3::UnitY()))};
    if (n == 1500) bench.session->command({CommandKind::stiffness, 300});
    {
      const burr::test::RtGuard guard;
      bench.at(pose, 1);
      allocations += guard.allocations();
      locks += guard.locks();
    }
    recorder.wait_for_room();
    most = std::max(most, bench.row.contact.torque.norm());
    // the drag on the side of a lying tool pulls along y, beside the tip: about z
    moment = std::max(moment, std::abs(bench.row.contact.torque.z()));
  }
  bench.session->set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(bench.row.ledger.removed, 1e-12);
  EXPECT_GT(most, 5e-3);
  EXPECT_GT(moment, 1e-4);
  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok());
  auto bone = (*player)->embedded_bone(64);
  ASSERT_TRUE(bone.ok());
  const auto again = sim::replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick)
      << "tick " << *again->first_different_tick << ": " << again->difference;
  EXPECT_EQ(again->ticks, 2000U);
}

// The springs of a session are below the border that the lever leaves, with the margin of lever.h, at
// the start and after any command.
TEST(TorqueOfAContact, SpringsStayBelowTheBorderOfTheLever) {
  for (const double lever : {0.0, 20 * kMm, 100 * kMm}) {
    device::DeviceSpec spec = turning_device();
    spec.max_turn_stiffness = 0;
    spec.turn_damping = 1e-3;
    spec.lever = lever;
    sim::SessionSettings settings = with_shaft();
    settings.servo.force.stiffness = 5000;
    Bench bench(ridge(), settings, spec);
    const auto check = [&] {
      const double k_t = bench.session->servo().settings().force.stiffness;
      const haptics::Coupling springs = coupling_of(spec, bench.session->servo().settings());
      const haptics::Wrist wrist = {.damping = 0.5e-3 * spec.max_stiffness / 0.7,
                                    .turn_damping = 1e-3,
                                    .delay = 0,
                                    .rate_hz = 1000};
      EXPECT_NEAR(springs.turn_stiffness, 0.3, 1e-12);
      EXPECT_NEAR(k_t, std::min(1000.0, 0.7 * haptics::stiffest_at_lever(wrist, 0.3, lever)), 1e-6)
          << lever;
      EXPECT_NEAR(springs.lever * springs.lever * k_t, 0.3, 1e-9);
    };
    check();
    bench.session->command({CommandKind::stiffness, 40});
    bench.at(across(0, 8 * kMm));
    EXPECT_EQ(bench.session->servo().settings().force.stiffness, 40);
    bench.session->command({CommandKind::stiffness, 9000});
    bench.at(across(0, 8 * kMm));
    check();
  }
}

}  // namespace
}  // namespace burr::tick
