// burr as a CRTK arm: another program on the bus drives it and reads what it publishes.
#include "burr/device/crtk/arm.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include "burr/device/crtk/bus.h"
#include "burr/math/rotation.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"
#include "device/fake/fake_crtk.h"
#include "device/slab.h"
#include "device/stand_in.h"

namespace burr::device::crtk {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using test::soon;
constexpr double kMm = 1e-3;

// The program that drives and watches, as a user's node would.
struct Driver {
  explicit Driver(int domain)
      : bus(std::move(*Bus::open(domain))),
        servo(bus->participant(), "/burr/servo_cp"),
        move(bus->participant(), "/burr/move_cp", Keep::all),
        command(bus->participant(), "/burr/state_command", Keep::all),
        spindle(bus->participant(), "/burr/spindle", Keep::all),
        measured(bus->participant(), "/burr/measured_cp", Keep::newest),
        setpoint(bus->participant(), "/burr/setpoint_cp", Keep::newest),
        body(bus->participant(), "/burr/body/measured_cf", Keep::newest),
        spatial(bus->participant(), "/burr/spatial/measured_cf", Keep::newest),
        state(bus->participant(), "/burr/operating_state", Keep::last) {}

  static PoseStamped goal(const Pose& pose) {
    return {{now_stamp(), as_sample_text("world")}, message_of(pose)};
  }
  void go(Writer<PoseStamped>& by, const Pose& pose) const { by.write(goal(pose)); }
  void ask(const char* word) {
    command.write({{now_stamp(), as_sample_text("")}, as_sample_text(word)});
  }
  void press(float pedal) {
    Joy joy{};
    joy.header_ = {now_stamp(), as_sample_text("")};
    joy.axes_._buffer = &pedal;
    joy.axes_._length = joy.axes_._maximum = 1;
    spindle.write(joy);
  }
  [[nodiscard]] bool heard() const {
    return servo.readers() > 0 && move.readers() > 0 && command.readers() > 0 &&
           spindle.readers() > 0;
  }

  std::unique_ptr<Bus> bus;
  Writer<PoseStamped> servo, move;
  Writer<StringStamped> command;
  Writer<Joy> spindle;
  Reader<PoseStamped> measured, setpoint;
  Reader<WrenchStamped> body, spatial;
  Reader<OperatingState> state;
};

class ArmTest : public ::testing::Test {
 protected:
  void SetUp() override {
    domain_ = test::quiet_domain();
    auto opened = Arm::open({.name = "burr", .domain = domain_});
    ASSERT_TRUE(opened.ok()) << opened.error().text;
    arm_ = std::move(*opened);
    hand_ = std::make_unique<DrivenHand>(*arm_, Pose{});
    driver_ = std::make_unique<Driver>(domain_);
    ASSERT_TRUE(soon([&] { return driver_->heard(); }));
  }
  // Runs ticks of a simulated clock until so() is true; returns their number, or -1.
  int ticks(const std::function<bool(const HandState&)>& so, int most = 200'000) {
    for (int n = 1; n <= most; ++n) {
      now_ = hand_->state(1e-3);
      if (so(now_)) return n;
      if (n % 100 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return -1;
  }
  int until_at(const Vec3& place) {
    return ticks([&](const HandState& hand) { return hand.world_from_tool.p == place; });
  }

  int domain_ = 0;
  std::unique_ptr<Arm> arm_;
  std::unique_ptr<DrivenHand> hand_;
  std::unique_ptr<Driver> driver_;
  HandState now_;
};

TEST_F(ArmTest, AServoGoalIsFollowedNoFasterThanItsSpeed) {
  const Quat turn(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  driver_->go(driver_->servo, {{10 * kMm, 0, 0}, turn});
  ASSERT_GT(ticks([](const HandState& hand) { return hand.world_from_tool.p.x() > 0; }), 0);
  const double first = now_.world_from_tool.p.x();
  EXPECT_NEAR(first, DrivenHand::kServoSpeed * 1e-3, 1e-12);
  EXPECT_NEAR(now_.velocity.x(), DrivenHand::kServoSpeed, 1e-9);
  // 10 mm at half a metre a second: 20 ticks in all
  EXPECT_EQ(until_at({10 * kMm, 0, 0}), 19);
  ASSERT_GT(ticks([&](const HandState& hand) {
              return hand.world_from_tool.q.angularDistance(turn) < 1e-9;
            }),
            0);
  EXPECT_FALSE(hand_->busy());
}

// A line that begins and ends at rest: distance, top speed and time of a trapezoid.
TEST_F(ArmTest, AMoveBeginsAndEndsAtRest) {
  const double way = 20 * kMm;
  driver_->go(driver_->move, {{0, 0, way}, Quat::Identity()});
  ASSERT_GT(ticks([](const HandState& hand) { return hand.world_from_tool.p.z() > 0; }), 0);
  EXPECT_TRUE(hand_->busy());
  double fastest = 0, hardest = 0, before = now_.velocity.z();
  const int took = 1 + ticks([&](const HandState& hand) {
                     fastest = std::max(fastest, hand.velocity.norm());
                     hardest = std::max(hardest, std::abs(hand.velocity.z() - before) / 1e-3);
                     before = hand.velocity.z();
                     return hand.world_from_tool.p.z() == way;
                   });
  EXPECT_NEAR(fastest, DrivenHand::kMoveSpeed, 1e-9);
  EXPECT_LT(hardest, 2 * DrivenHand::kMoveAcceleration);
  const double expected = way / DrivenHand::kMoveSpeed +
                          DrivenHand::kMoveSpeed / DrivenHand::kMoveAcceleration;  // = 0.5 s
  EXPECT_NEAR(took * 1e-3, expected, 0.02);
  static_cast<void>(hand_->state(1e-3));
  EXPECT_FALSE(hand_->busy());
}

TEST_F(ArmTest, StatesAreObeyed) {
  driver_->go(driver_->servo, {{5 * kMm, 0, 0}, Quat::Identity()});
  ASSERT_GT(until_at({5 * kMm, 0, 0}), 0);
  driver_->press(0.7F);
  ASSERT_GT(ticks([](const HandState& hand) { return hand.pedal > 0; }), 0);
  EXPECT_NEAR(now_.pedal, 0.7, 1e-6);

  driver_->ask("pause");
  ASSERT_GT(ticks([](const HandState& hand) { return hand.pedal == 0; }), 0) << "spindle off";
  EXPECT_EQ(now_.buttons & kLifted, 0U) << "it still touches";
  driver_->go(driver_->servo, {{0, 0, 0}, Quat::Identity()});
  ASSERT_TRUE(soon([&] { return arm_->ignored_goals() == 1; }));
  EXPECT_EQ(hand_->state(1e-3).world_from_tool.p.x(), 5 * kMm);
  EXPECT_FALSE(hand_->trouble().empty());

  driver_->ask("disable");
  ASSERT_GT(ticks([](const HandState& hand) { return (hand.buttons & kLifted) != 0; }), 0);
  driver_->ask("resume");  // is possible only from a pause
  ASSERT_TRUE(soon([&] { return arm_->ignored_goals() == 2; }));
  driver_->ask("enable");
  ASSERT_GT(ticks([](const HandState& hand) { return (hand.buttons & kLifted) == 0; }), 0);
  EXPECT_EQ(now_.pedal, 0) << "it does not begin to turn by itself";

  driver_->ask("unhome");
  driver_->ask("dance");
  ASSERT_TRUE(soon([&] { return arm_->ignored_goals() == 3; }));
  driver_->go(driver_->move, {{1 * kMm, 0, 0}, Quat::Identity()});
  ASSERT_TRUE(soon([&] { return arm_->ignored_goals() == 4; })) << "not homed";
  driver_->ask("home");
  EXPECT_GT(until_at(Vec3::Zero()), 0);
}

TEST_F(ArmTest, WhatCannotBeFollowedIsLeftAside) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto leave = [&](PoseStamped goal, std::uint64_t count) {
    driver_->servo.write(goal);
    EXPECT_TRUE(soon([&] { return arm_->ignored_goals() == count; }));
  };
  PoseStamped goal = Driver::goal({{kMm, 0, 0}, Quat::Identity()});
  goal.header_.stamp_ = {};
  leave(goal, 1);
  leave(Driver::goal({{kNan, 0, 0}, Quat::Identity()}), 2);
  leave(Driver::goal({{0, 1.01, 0}, Quat::Identity()}), 3);
  goal = Driver::goal({});
  goal.pose_.orientation_ = {0, 0, 0, 0};
  leave(goal, 4);
  driver_->press(static_cast<float>(kNan));
  EXPECT_TRUE(soon([&] { return arm_->ignored_goals() == 5; }));
  EXPECT_EQ(hand_->state(1e-3).world_from_tool.p, Vec3::Zero());
  EXPECT_EQ(hand_->state(1e-3).pedal, 0);
}

TEST_F(ArmTest, NoTwoArmsHaveOneName) {
  const auto second = Arm::open({.name = "/burr", .domain = domain_});
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().text.find("give this one another name"), std::string::npos)
      << second.error().text;
  EXPECT_TRUE(Arm::open({.name = "/other", .domain = domain_}).ok());
  EXPECT_FALSE(Arm::open({.name = "2 arms", .domain = domain_}).ok());
}

TEST_F(ArmTest, WhatIsToldIsReadByOthers) {
  ArmReport told;
  told.measured = {{1, 2, 3}, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()))};
  told.setpoint.p = {4, 5, 6};
  told.force = {2, 0, 0};
  told.busy = true;
  const OperatingState* state = nullptr;
  ASSERT_TRUE(soon([&] {
    arm_->publish(told);
    return state != nullptr || (state = driver_->state.take()) != nullptr;
  }));
  EXPECT_STREQ(state->state_, "ENABLED");
  EXPECT_TRUE(state->is_homed_ && state->is_busy_);
  const auto told_now = [&](auto& reader) {
    const auto* newest = reader.take();
    EXPECT_TRUE(soon([&] {
      arm_->publish(told);
      return newest != nullptr || (newest = reader.take()) != nullptr;
    }));
    return newest;
  };
  EXPECT_EQ(pose_of(told_now(driver_->measured)->pose_).p, Vec3(1, 2, 3));
  EXPECT_EQ(pose_of(told_now(driver_->setpoint)->pose_).p, Vec3(4, 5, 6));
  // the burr's x is the world's y: a push along world x is along its -y
  EXPECT_NEAR((vector_of(told_now(driver_->body)->wrench_.force_) - Vec3(0, -2, 0)).norm(), 0,
              1e-12);
  const WrenchStamped* spatial = told_now(driver_->spatial);
  EXPECT_EQ(vector_of(spatial->wrench_.force_), Vec3(2, 0, 0));
  EXPECT_NEAR((vector_of(spatial->wrench_.torque_) - Vec3(0, 6, -4)).norm(), 0, 1e-12);
}

TEST_F(ArmTest, OneThatWasLetGoSaysFaultWhileItIsEnabled) {
  ArmReport told;
  const auto says = [&](const std::string& word) {
    std::string said;
    return soon([&] {
      arm_->publish(told);
      if (const OperatingState* state = driver_->state.take()) said = state->state_;
      return said == word;
    });
  };
  EXPECT_TRUE(says("ENABLED"));
  told.released = true;
  EXPECT_TRUE(says("FAULT"));
  driver_->ask("pause");
  EXPECT_TRUE(says("PAUSED"));
  driver_->ask("resume");
  EXPECT_TRUE(says("FAULT"));
  driver_->ask("disable");
  EXPECT_TRUE(says("DISABLED"));
  driver_->ask("enable");
  told.released = false;
  EXPECT_TRUE(says("ENABLED"));
}

// A driven hand that does not release the force when the machine stands still now and then; it
// stands still once for longer when asked to.
class Unhurried final : public Device {
 public:
  Unhurried(std::unique_ptr<DrivenHand> hand, std::atomic<int>& stall_ms)
      : hand_(std::move(hand)), spec_(hand_->spec()), stall_ms_(stall_ms) {
    spec_.loss_timeout = test::kStallsAllowed;
  }
  Status open() override { return hand_->open(); }
  void close() override { hand_->close(); }
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override {
    if (const int stall = stall_ms_.exchange(0); stall > 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(stall));
    return hand_->state(dt);
  }
  void write_force(const Vec3& force) BURR_RT override { hand_->write_force(force); }

 private:
  std::unique_ptr<DrivenHand> hand_;
  DeviceSpec spec_;
  std::atomic<int>& stall_ms_;
};

// The whole system: a program drives the burr into a slab whose top is z = 0. Like a real program,
// it waits only for what is published.
class DrivenArm : public ArmTest {
 protected:
  static constexpr double kFree = 5 * kMm, kDeep = 1 * kMm;  // centre of a ball of 2 mm

  void SetUp() override {
    ArmTest::SetUp();
    hand_.reset();
    auto made = test::slab_session(std::make_unique<Unhurried>(
        std::make_unique<DrivenHand>(*arm_, Pose{{0, 0, kFree}, Quat::Identity()}), stall_ms_));
    ASSERT_TRUE(made.ok()) << made.error().text;
    session_ = std::move(*made);
    session_->set_watch(&rows_);
    session_->start();
    ASSERT_TRUE(heard([&] { return row_.tick > 600 && state_ == "ENABLED"; }));
  }
  void TearDown() override {
    if (session_ == nullptr) return;
    session_->stop();
    session_->set_watch(nullptr);
  }
  bool heard(const std::function<bool()>& so) {
    return soon([&] {
      if (rows_.take(row_))
        arm_->publish({{row_.contact.proxy, row_.hand.world_from_tool.q},
                       row_.hand.world_from_tool,
                       row_.hand.velocity,
                       row_.contact.force,
                       false,
                       session_->servo().released()});
      if (const PoseStamped* newest = driver_->measured.take())
        measured_ = pose_of(newest->pose_).p;
      if (const PoseStamped* newest = driver_->setpoint.take())
        setpoint_ = pose_of(newest->pose_).p;
      if (const WrenchStamped* newest = driver_->body.take())
        force_ = vector_of(newest->wrench_.force_);
      if (const OperatingState* newest = driver_->state.take()) state_ = newest->state_;
      return so();
    });
  }
  void go(double z) { driver_->go(driver_->move, {{0, 0, z}, Quat::Identity()}); }
  bool there(double z) {
    return heard([&] { return std::abs(setpoint_.z() - z) < 1e-6; });
  }

  std::atomic<int> stall_ms_ = 0;
  std::unique_ptr<sim::Session> session_;
  rt::Latest<tick::TickRow> rows_;
  tick::TickRow row_;
  Vec3 measured_ = Vec3::Zero(), setpoint_ = Vec3::Zero(), force_ = Vec3::Zero();
  std::string state_;
};

TEST_F(DrivenArm, StaysOnTheBonePushesBackAndMills) {
  go(kDeep);
  ASSERT_TRUE(there(kDeep));
  ASSERT_TRUE(heard([&] { return force_.z() > 0.5; }));
  EXPECT_NEAR(measured_.z(), 2 * kMm, 0.1 * kMm) << "the burr's radius above the slab";
  EXPECT_EQ(row_.ledger.removed, 0);
  driver_->press(1);
  ASSERT_TRUE(heard([&] { return row_.ledger.removed > 1e-9; }));
  ASSERT_TRUE(heard([&] { return measured_.z() < 1.6 * kMm; })) << measured_.transpose();
  driver_->ask("disable");
  EXPECT_TRUE(heard([&] { return force_ == Vec3::Zero() && state_ == "DISABLED"; }));
}

TEST_F(DrivenArm, LetGoInBoneItSaysSoAndBeginsAgainInFreeAir) {
  go(kDeep);
  ASSERT_TRUE(heard([&] { return force_.z() > 0.5; }));
  stall_ms_ = static_cast<int>(2e3 * test::kStallsAllowed);
  ASSERT_TRUE(heard([&] { return state_ == "FAULT" && force_ == Vec3::Zero(); }));
  driver_->press(1);
  const std::uint64_t then = row_.tick;
  ASSERT_TRUE(heard([&] { return row_.tick > then + 300; }));
  EXPECT_EQ(row_.ledger.removed, 0);
  EXPECT_EQ(state_, "FAULT");
  driver_->press(0);
  go(kFree);  // meanwhile it follows its goals
  ASSERT_TRUE(there(kFree));
  ASSERT_TRUE(heard([&] { return state_ == "ENABLED"; }));
  go(kDeep);
  EXPECT_TRUE(heard([&] { return force_.z() > 0.5; }));

  driver_->ask("disable");
  ASSERT_TRUE(heard([&] { return state_ == "DISABLED" && force_ == Vec3::Zero(); }));
  driver_->ask("enable");
  ASSERT_TRUE(heard([&] { return state_ == "FAULT"; })) << "enabled in the bone";
  EXPECT_EQ(force_, Vec3::Zero());
  go(kFree);
  EXPECT_TRUE(heard([&] { return state_ == "ENABLED"; }));
}

}  // namespace
}  // namespace burr::device::crtk
