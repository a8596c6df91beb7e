// A second device in the other hand: it feels the bone as its own law says, never changes it, and
// nothing of the first hand depends on it.
#include "burr/tick/second_hand.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <thread>

#include "burr/device/replayed_hand.h"
#include "burr/haptics/contact.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/flags.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

// A hand that is put somewhere, and remembers what it was pushed with.
class Pushed final : public device::Device {
 public:
  struct Log {
    device::HandState hand;
    Vec3 force = Vec3::Zero();
    double largest = 0;
    std::atomic<double> held_least = 1;  // by the guard, on its own thread
    bool open = false, follows = false;
  };
  Pushed(Log& log, device::DeviceSpec spec) : log_(log), spec_(std::move(spec)) {}
  Status open() override {
    log_.open = true;
    return fine();
  }
  void close() override { log_.open = false; }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double) BURR_RT override { return log_.hand; }
  void write_force(const Vec3& force) BURR_RT override {
    log_.force = force;
    log_.largest = std::max(log_.largest, force.norm());
  }
  void scale_force(double scale) BURR_RT override {
    log_.held_least = std::min(log_.held_least.load(), scale);
  }
  void stop_pacing() override { log_.follows = true; }

 private:
  Log& log_;
  device::DeviceSpec spec_;
};

struct Bench {
  std::unique_ptr<sim::Session> session;
  device::ReplayedHand* first = nullptr;
  Pushed::Log log;

  explicit Bench(bool joined = true, const SecondHandSettings& requested = {},
                 const device::DeviceSpec& spec = {}) {
    NoProgress quiet;
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    first = owned.get();
    sim::SessionSettings settings;
    settings.servo.burr.radius = 2 * kMm;
    settings.servo.undo_bricks = 2048;
    settings.surface.reserve_blocks = 1 << 14;
    // a slab whose top is z = 0
    auto made = sim::Session::make(
        phantom::bone_from_distance(phantom::box_grid({-12 * kMm, -8 * kMm, -8 * kMm},
                                                      {12 * kMm, 8 * kMm, 8 * kMm}, 0.25 * kMm),
                                    {}, phantom::slab(), 64),
        std::move(owned), settings, quiet);
    EXPECT_TRUE(made.ok());
    session = std::move(*made);
    if (joined) {
      EXPECT_TRUE(session->add_second_hand(std::make_unique<Pushed>(log, spec), requested).ok());
    }
    burr({0, 0, 6 * kMm}, 0);
    tube({0, 0, 5 * kMm});
    for (int n = 0; n < 700; ++n) tick();  // past the start ramps
  }
  void burr(const Vec3& p, double pedal) const {
    device::HandState now;
    now.world_from_tool.p = p;
    now.pedal = pedal;
    first->set(now);
  }
  void tube(const Vec3& p, std::uint32_t buttons = 0) {
    log.hand.world_from_tool.p = p;
    log.hand.buttons = buttons;
  }
  // As Session::loop() has it.
  const TickRow& tick(bool lost = false) const {
    Servo& servo = session->servo();
    const TickRow& row = servo.tick(lost);
    servo.publish();
    return row;
  }
  void ticks(int count) const {
    for (int n = 0; n < count; ++n) tick();
  }
  [[nodiscard]] const TickRow& second() const { return session->second_hand()->row(); }
};

TEST(SecondHand, FeelsAWallAsItsOwnSpringSays) {
  SecondHandSettings requested;
  requested.force.stiffness = 700;
  requested.friction = 0;
  Bench bench(true, requested);
  for (const double depth_mm : {0.5, 1.0, 2.0}) {
    bench.tube({3 * kMm, 1 * kMm, requested.radius - depth_mm * kMm});
    bench.ticks(200);
    const Vec3 force = bench.log.force;
    // the field's surface lies within a fiftieth of a voxel of the plane
    EXPECT_NEAR(force.z(), 700 * depth_mm * kMm, 700 * 0.005 * kMm) << depth_mm;
    EXPECT_LT(std::hypot(force.x(), force.y()), 0.01 * force.z()) << depth_mm;
    EXPECT_NEAR(bench.second().contact.proxy.z(), requested.radius, 0.01 * kMm);
    bench.tube({3 * kMm, 1 * kMm, 5 * kMm});
    bench.ticks(20);
    EXPECT_EQ(bench.log.force, Vec3::Zero());
  }
}

// Slid along, it is held back by its share of the push, and no more.
TEST(SecondHand, RubsAsItsFrictionSays) {
  SecondHandSettings requested;
  requested.friction = 0.2;
  Bench bench(true, requested);
  for (int n = 0; n < 300; ++n) {
    bench.tube({-3 * kMm + 0.02 * kMm * n, 0, 0.5 * kMm});
    bench.tick();
  }
  const Vec3 force = bench.log.force;
  ASSERT_GT(force.z(), 0.9);
  EXPECT_NEAR(-force.x() / force.z(), 0.2, 0.01);
}

TEST(SecondHand, NoWallIsStifferThanItsDeviceCanShow) {
  device::DeviceSpec weak;
  weak.max_stiffness = 150;
  Bench bench(true, {}, weak);
  bench.tube({0, 0, 0.5 * kMm});
  bench.ticks(200);
  EXPECT_NEAR(bench.log.force.z(), 150 * 1e-3, 0.003);
}

// The same way of the first hand with and without it, in the same hole: every tick has the same
// hash.
TEST(SecondHand, NeitherTheBoneNorTheFirstHandKnowsOfIt) {
  Bench with, alone(false);
  double removed = 0;
  for (int n = 0; n < 3000; ++n) {
    const double t = 1e-3 * n;
    const Vec3 way = {2 * kMm * std::sin(3 * t), 1 * kMm * std::cos(2 * t), (1.2 - 0.5 * t) * kMm};
    with.burr(way, 1);
    alone.burr(way, 1);
    with.tube(way + Vec3(1.5 * kMm * std::cos(9 * t), 0, 0.5 * kMm * std::sin(31 * t)),
              n % 700 > 650 ? device::kLifted : 0);
    const TickRow &one = with.tick(), &other = alone.tick();
    ASSERT_EQ(one.hash, other.hash) << "tick " << n;
    removed = one.ledger.removed;
  }
  EXPECT_GT(removed, 1e-9);
  EXPECT_EQ(with.session->bone().content_hash(), alone.session->bone().content_hash());
  EXPECT_GT(with.log.largest, 0.1) << "it did touch";
}

TEST(SecondHand, GoesDownWhereTheBurrTookTheBoneAway) {
  Bench bench;
  bench.tube({0, 0, 0});
  bench.ticks(100);
  const double before = bench.log.force.z();
  ASSERT_GT(before, 1);
  bench.tube({8 * kMm, 0, 4 * kMm});
  for (int n = 0; n < 4000; ++n) {
    bench.burr({0, 0, (2 - 1.5e-3 * n) * kMm}, 1);
    bench.tick();
  }
  bench.burr({0, 0, 6 * kMm}, 0);
  bench.ticks(50);
  bench.tube({0, 0, 4 * kMm});
  bench.ticks(50);
  bench.tube({0, 0, 0});
  bench.ticks(100);
  EXPECT_LT(bench.log.force.z(), 0.5 * before);
}

TEST(SecondHand, LostItFadesInFiveTicksIsKeptAndComesBackByTheRamp) {
  Bench bench;
  bench.tube({0, 0, 0});
  bench.ticks(300);
  const double force = bench.log.force.norm();
  ASSERT_GT(force, 1);
  bench.log.hand.valid = false;
  auto report = std::make_unique<FaultReport>();
  for (int n = 1; n <= 5; ++n) {
    EXPECT_FALSE(bench.session->second_hand()->faults().take(*report)) << "first it fades";
    bench.tick();
    EXPECT_NEAR(bench.log.force.norm(), force * (1 - n / 5.0), 1e-9);
  }
  bench.tick();
  ASSERT_TRUE(bench.session->second_hand()->faults().take(*report));
  EXPECT_EQ(report->flags, rt::kFlagHandLost);
  EXPECT_EQ(report->count, FaultReport::kTicks);
  EXPECT_NEAR(report->rows[100].contact.force.norm(), force, 1e-9);
  for (std::size_t n = 1; n < FaultReport::kTicks; ++n)
    ASSERT_EQ(report->rows[n].tick, report->rows[0].tick + n) << "oldest first";
  EXPECT_EQ(report->rows[199].tick, bench.second().tick);
  FaultReport& of_first = *report;
  EXPECT_FALSE(bench.session->fault(of_first)) << "the first hand has none";
  bench.log.hand.valid = true;
  bench.ticks(50);
  EXPECT_EQ(bench.log.force, Vec3::Zero()) << "the wall is still there";
  bench.tube({0, 0, 4 * kMm});
  bench.ticks(30);
  bench.tube({0, 0, 0});
  double last = 0;
  for (int n = 0; n < 20; ++n) {
    bench.tick();
    EXPECT_LE(bench.log.force.norm() - last, 0.06 + 1e-9) << "the start ramp";
    last = bench.log.force.norm();
  }
  EXPECT_GT(last, 0.5);
}

TEST(SecondHand, TicksThatWereLostLetItGoToo) {
  Bench bench;
  bench.tube({0, 0, 0});
  bench.ticks(300);
  ASSERT_GT(bench.log.force.norm(), 1);
  bench.tick(true);
  EXPECT_EQ(bench.log.force, Vec3::Zero()) << "the watchdog has faded it at the device";
  EXPECT_NE(bench.second().contact.flags & rt::kFlagWatchdog, 0U);
}

// Bone comes back where the tube is: it is let go and takes part again from free air.
TEST(SecondHand, AnUndoUnderItLetsItGo) {
  Bench bench;
  for (int n = 0; n < 1500; ++n) {
    bench.burr({0, 0, (2 - 3e-3 * n) * kMm}, 1);
    bench.tick();
  }
  bench.burr({0, 0, 6 * kMm}, 0);
  bench.ticks(500);
  bench.tube({0, 0, -0.5 * kMm});
  bench.ticks(50);
  bench.session->command({CommandKind::undo, 0});
  bench.tick();
  ASSERT_TRUE(bench.session->servo().restoring());
  double last = bench.log.force.norm();
  while (bench.session->servo().restoring()) {
    bench.tick();
    EXPECT_LE(bench.log.force.norm(), last + 1e-12);
    last = bench.log.force.norm();
  }
  bench.ticks(100);
  EXPECT_EQ(bench.log.force, Vec3::Zero()) << "bone is where it is";
  EXPECT_FALSE(bench.second().contact.touching);
  bench.tube({0, 0, 4 * kMm});
  bench.ticks(30);
  bench.tube({0, 0, 0.5 * kMm});
  bench.ticks(700);
  EXPECT_GT(bench.log.force.z(), 0.5);
}

TEST(SecondHand, WhateverItSaysItsLimitHolds) {
  device::DeviceSpec spec;
  spec.peak_force = 2;
  SecondHandSettings requested;
  requested.limit.user_force = 1.5;
  Bench bench(true, requested, spec);
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Vec3 at = {0, 0, 3 * kMm}, last = Vec3::Zero();
  for (int n = 0; n < 100'000; ++n) {
    at += 0.3 * kMm * Vec3(any(random), any(random), any(random));
    at = at.cwiseMin(Vec3(6, 6, 5) * kMm).cwiseMax(Vec3(-6, -6, -5) * kMm);
    bench.tube(at);
    bench.log.hand.velocity = 0.3 * Vec3(any(random), any(random), any(random));
    bench.log.hand.valid = n % 911 != 5;
    if (n % 1009 == 3)
      bench.log.hand.world_from_tool.p.x() = std::numeric_limits<double>::quiet_NaN();
    if (n % 1013 == 4) bench.log.hand.world_from_tool.p *= 1e6;
    if (n % 1019 == 6) bench.log.hand.velocity.y() = std::numeric_limits<double>::infinity();
    bench.tick();
    const Vec3& force = bench.log.force;
    ASSERT_TRUE(force.allFinite()) << "seed " << seed << " tick " << n;
    ASSERT_LE(force.norm(), 1.5 + 1e-12) << "seed " << seed << " tick " << n;
    const double square = last.squaredNorm();
    const Vec3 kept =
        square > 0 ? Vec3(std::clamp(force.dot(last) / square, 0.0, 1.0) * last) : Vec3(last);
    ASSERT_LE((force - kept).norm(), 0.3 + 1e-9) << "seed " << seed << " tick " << n;
    last = force;
  }
  EXPECT_GT(bench.log.largest, 1.4) << "seed " << seed;
}

TEST(SecondHand, TakesNoMemoryAndNoLock) {
  Bench bench;
  const burr::test::RtGuard guard;
  for (int n = 0; n < 500; ++n) {
    bench.tube({3 * kMm * std::sin(0.05 * n), 0, (1 + std::cos(0.03 * n)) * kMm});
    static_cast<void>(bench.session->servo().tick(false));
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

// A first hand in which the tick once stands for a quarter of a second.
class Stands final : public device::Device {
 public:
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double) BURR_RT override {
    if (++ticks_ == 300) std::this_thread::sleep_for(std::chrono::milliseconds(250));
    device::HandState hand;
    hand.world_from_tool.p = {0, 0, 6 * kMm};
    return hand;
  }
  void write_force(const Vec3&) BURR_RT override {}

 private:
  device::DeviceSpec spec_;
  int ticks_ = 0;
};

TEST(SecondHand, IsHeldBackByTheGuardWhileTheTickStands) {
  NoProgress quiet;
  sim::SessionSettings settings;
  settings.realtime = true;
  settings.servo.burr.radius = 2 * kMm;
  settings.servo.undo_bricks = 512;
  settings.surface.reserve_blocks = 1 << 12;
  auto made = sim::Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
          phantom::slab(), 64),
      std::make_unique<Stands>(), settings, quiet);
  ASSERT_TRUE(made.ok());
  Pushed::Log log;
  log.hand.world_from_tool.p = {0, 0, 5 * kMm};
  ASSERT_TRUE(
      (*made)->add_second_hand(std::make_unique<Pushed>(log, device::DeviceSpec{}), {}).ok());
  EXPECT_TRUE(log.follows) << "its wire does not wait for ticks that another one begins";
  (*made)->run(0.5, quiet);
  EXPECT_EQ(log.held_least, 0);
  auto report = std::make_unique<FaultReport>();
  ASSERT_TRUE((*made)->second_hand()->faults().take(*report));
  EXPECT_NE(report->flags & rt::kFlagWatchdog, 0U);
  EXPECT_NE((*made)->outcome().flags & rt::kFlagWatchdog, 0U);
}

TEST(SecondHand, GoesWithTheSessionAndIsLetGoWithIt) {
  Bench bench;
  bench.tube({0, 0, 0});
  NoProgress quiet;
  bench.session->run(0.3, quiet);
  EXPECT_GT(bench.log.largest, 1);
  EXPECT_EQ(bench.log.force, Vec3::Zero());
  EXPECT_TRUE(bench.log.open);
  bench.session.reset();
  EXPECT_FALSE(bench.log.open);
}

}  // namespace
}  // namespace burr::tick
