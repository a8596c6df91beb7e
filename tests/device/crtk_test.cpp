// A CRTK arm as the hand, against an arm that the test plays on the same bus (fake/fake_crtk.h).
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "burr/device/crtk/bus.h"
#include "burr/device/crtk/leader.h"
#include "burr/device/crtk/reading.h"
#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "device/fake/fake_crtk.h"
#include "device/stand_in.h"
#include "device/wild_forces.h"

namespace burr::device::crtk {
namespace {

using math::Quat;
using math::Vec3;
using test::FakeCrtkArm;
using test::soon;
using Commands = FakeCrtkArm::Commands;

class LeaderTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { domain_ = test::quiet_domain(); }
  [[nodiscard]] static LeaderSettings here(const std::string& arm = "/arm", bool home = false) {
    return {.arm = arm, .domain = domain_, .home_allowed = home};
  }
  [[nodiscard]] static std::unique_ptr<WireDevice> device(
      const std::string& arm = "/arm", double loss_timeout = test::kStallsAllowed) {
    LinkSettings link;
    link.loss_timeout = loss_timeout;
    return std::make_unique<WireDevice>(std::make_unique<Leader>(here(arm)), link);
  }
  static HandState next(Leader& wire) {
    HandState hand;
    Wire::Read read = Wire::Read::nothing;
    EXPECT_TRUE(soon([&] { return (read = wire.read(hand)) != Wire::Read::nothing; }));
    EXPECT_EQ(read, Wire::Read::hand);
    return hand;
  }
  static std::string refusal(const LeaderSettings& settings) {
    Leader wire(settings);
    const auto found = wire.connect();
    return found.ok() ? "it connected" : found.error().text;
  }
  static int domain_;
};
int LeaderTest::domain_ = 0;

TEST_F(LeaderTest, SaysWhatItIsAndSetsTheArmUp) {
  FakeCrtkArm arm(domain_);
  const auto hand = device("arm/");
  const Status opened = hand->open();
  ASSERT_TRUE(opened.ok()) << opened.error().text;
  EXPECT_EQ(hand->spec().serial, "/arm");
  EXPECT_EQ(hand->spec().sensed, 6);
  EXPECT_EQ(hand->spec().peak_force, 3);
  EXPECT_EQ(hand->spec().loss_timeout, test::kStallsAllowed) << "as its link was told";
  EXPECT_TRUE(soon([&] {
    return arm.with([](Commands& w) { return w.weightless && !w.absolute; });
  })) << "its weight is carried, and forces are as its end is turned";
  EXPECT_EQ(hand->trouble(), "");
}

TEST_F(LeaderTest, TheOnlyArmIsFoundByItself) {
  FakeCrtkArm arm(domain_, "/lab/left_1");
  Leader wire(here(""));
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok()) << spec.error().text;
  EXPECT_EQ(spec->serial, "/lab/left_1");
}

TEST_F(LeaderTest, TenMillimetresAreThoseAlongEveryAxis) {
  FakeCrtkArm arm(domain_);
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = 0.01 * Vec3::Unit(axis);
    const Quat turn(Eigen::AngleAxisd(0.3 + axis, Vec3(1, 2, 3).normalized()));
    arm.with([&](Commands& w) {
      w.place = {way, turn};
      w.velocity = 20 * way;
    });
    HandState hand;
    ASSERT_TRUE(soon([&] {
      hand = next(wire);
      return (hand.world_from_tool.p - way).norm() < 1e-12 &&
             (hand.velocity - 20 * way).norm() < 1e-12;
    }));
    EXPECT_TRUE(hand.valid);
    EXPECT_NEAR(hand.world_from_tool.q.angularDistance(turn), 0, 1e-7);
  }
}

// The arm's end is rotated: it receives forces in its own frame and reports poses in that of its
// base.
TEST_F(LeaderTest, TheForceIsTurnedIntoTheFrameOfTheArmsEnd) {
  FakeCrtkArm arm(domain_);
  const Quat turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  arm.with([&](Commands& w) { w.place = {{0.1, 0.2, 0.3}, turn}; });
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(
      soon([&] { return (next(wire).world_from_tool.p - Vec3(0.1, 0.2, 0.3)).norm() < 1e-12; }));
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 wanted = 1.5 * Vec3::Unit(axis);
    ASSERT_TRUE(wire.write(wanted));
    Vec3 pushed = Vec3::Zero();
    EXPECT_TRUE(soon([&] {
      pushed = turn * arm.force();
      return (pushed - wanted).norm() < 1e-9;
    })) << pushed.transpose();
    EXPECT_EQ(arm.with([](Commands& w) { return w.torque; }), Vec3::Zero());
  }
}

// dVRK's spatial wrench is about the base: a force at the arm's end appears there with its moment.
TEST_F(LeaderTest, AnArmWithoutBodyForcesGetsTheWrenchAboutItsBase) {
  FakeCrtkArm arm(domain_, "/arm", {.body = false});
  const Vec3 place(0.1, 0.2, 0.3), force(1, -1, 0.5);
  arm.with([&](Commands& w) { w.place.p = place; });
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(soon([&] { return (next(wire).world_from_tool.p - place).norm() < 1e-12; }));
  ASSERT_TRUE(wire.write(force));
  EXPECT_TRUE(soon([&] { return (arm.force() - force).norm() < 1e-9; }));
  const Vec3 torque = arm.with([](Commands& w) { return w.torque; });
  EXPECT_NEAR(torque.x(), 0.2 * 0.5 - 0.3 * -1, 1e-12);
  EXPECT_NEAR(torque.y(), 0.3 * 1 - 0.1 * 0.5, 1e-12);
  EXPECT_NEAR(torque.z(), 0.1 * -1 - 0.2 * 1, 1e-12);
}

// Where the user says that the arm takes one: the torque is turned into the frame of the arm's end, or
// comes about the base with the moment of the force; and it never exceeds takes_torque_nm.
TEST_F(LeaderTest, ATorqueGoesOutInTheFrameThatTheArmTakes) {
  for (const bool body : {true, false}) {
    FakeCrtkArm arm(domain_, "/arm", {.body = body});
    const Quat turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
    const Vec3 place(0.1, 0.2, 0.3), force(1, -1, 0.5), torque(0.02, 0.05, -0.03);
    arm.with([&](Commands& w) { w.place = {place, turn}; });
    LeaderSettings settings = here();
    std::string asked;
    settings.takes_torque = [&asked](const std::string& name) {
      asked = name;
      return 0.1;
    };
    Leader wire(settings);
    const auto spec = wire.connect();
    ASSERT_TRUE(spec.ok()) << spec.error().text;
    EXPECT_EQ(asked, "/arm");
    EXPECT_EQ(spec->peak_torque, 0.1);
    EXPECT_EQ(spec->actuated, 6);
    ASSERT_TRUE(soon([&] { return (next(wire).world_from_tool.p - place).norm() < 1e-12; }));
    const auto arrives = [&](const Vec3& push, const Vec3& about_end) {
      const Vec3 seen_force = body ? Vec3(turn.conjugate() * push) : push;
      const Vec3 seen =
          body ? Vec3(turn.conjugate() * about_end) : Vec3(place.cross(push) + about_end);
      Vec3 came_force = Vec3::Zero(), came = Vec3::Zero();
      EXPECT_TRUE(soon([&] {
        arm.with([&](Commands& w) {
          came_force = w.force;
          came = w.torque;
          return 0;
        });
        return (came_force - seen_force).norm() < 1e-9 && (came - seen).norm() < 1e-9;
      })) << body
          << ": " << came_force.transpose() << ", " << came.transpose();
    };
    wire.write_torque(torque);
    ASSERT_TRUE(wire.write(force));
    arrives(force, torque);
    wire.write_torque(10 * torque);
    ASSERT_TRUE(wire.write(force));
    arrives(force, torque * (0.1 / torque.norm()));
    wire.write_torque(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    ASSERT_TRUE(wire.write(force));
    arrives(force, Vec3::Zero());
    wire.write_torque(torque);
    ASSERT_TRUE(wire.write(force));
    arrives(force, torque);
    wire.disconnect();
    arrives(Vec3::Zero(), Vec3::Zero());
  }
}

TEST_F(LeaderTest, AnArmOfWhichNothingIsSaidGetsNoTorque) {
  FakeCrtkArm arm(domain_);
  Leader wire(here());
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok());
  EXPECT_EQ(spec->peak_torque, 0);
  EXPECT_EQ(spec->actuated, 3);
  ASSERT_TRUE(soon([&] { return next(wire).valid; }));
  wire.write_torque({0.1, 0, 0});
  ASSERT_TRUE(wire.write({0, 1, 0}));
  EXPECT_TRUE(soon([&] { return (arm.force() - Vec3(0, 1, 0)).norm() < 1e-9; }));
  EXPECT_EQ(arm.with([](Commands& w) { return w.torque; }), Vec3::Zero());
}

TEST_F(LeaderTest, GripperAndPedalsMillAndLift) {
  FakeCrtkArm arm(domain_);
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_EQ(next(wire).buttons, 0U);
  arm.tread("gripper", true);
  EXPECT_TRUE(soon([&] { return next(wire).buttons == 1U; }));
  arm.tread("gripper", false);
  arm.tread("clutch", true);
  EXPECT_TRUE(soon([&] { return next(wire).buttons == 2U; }));
  arm.tread("clutch", false);
  arm.tread("coag", true);
  EXPECT_TRUE(soon([&] {
    const HandState hand = next(wire);
    return hand.buttons == 0U && hand.pedal == 1;
  }));
  arm.tread("present", false);
  EXPECT_TRUE(soon([&] { return (next(wire).buttons & kLifted) != 0; })) << "nobody is there";
  EXPECT_NE(wire.why().find("somebody"), std::string::npos);
  arm.tread("present", true);
  EXPECT_TRUE(soon([&] { return (next(wire).buttons & kLifted) == 0; }));
}

TEST_F(LeaderTest, WhatCannotServeAsAHandIsSaidWithItsRemedy) {
  EXPECT_NE(refusal(here()).find("no CRTK arm /arm was found on DDS domain"), std::string::npos);
  EXPECT_NE(refusal(here("1/x")).find("is not a valid name of an arm"), std::string::npos);
  {
    FakeCrtkArm one(domain_, "/one"), two(domain_, "/two");
    const std::string several = refusal(here(""));
    EXPECT_NE(several.find("/one, /two; choose one"), std::string::npos) << several;
    const std::string none = refusal(here("/three"));
    EXPECT_NE(none.find("there are /one, /two"), std::string::npos) << none;
  }
  {
    FakeCrtkArm arm(domain_, "/arm", {.body = false, .spatial = false});
    EXPECT_NE(refusal(here()).find("takes no force"), std::string::npos);
  }
  {
    FakeCrtkArm arm(domain_);
    arm.with([](Commands& w) { w.rate_hz = 100; });
    const std::string slow = refusal(here());
    EXPECT_NE(slow.find("times a second, but burr needs 400"), std::string::npos) << slow;
  }
  ::setenv("ROS_DOMAIN_ID", "three", 1);
  EXPECT_NE(refusal({}).find("ROS_DOMAIN_ID is \"three\""), std::string::npos);
  ::setenv("ROS_DOMAIN_ID", "233", 1);
  EXPECT_NE(refusal({}).find("0 to 232"), std::string::npos);
  ::unsetenv("ROS_DOMAIN_ID");
}

TEST_F(LeaderTest, AnOldPlaceOfAnotherTypeIsSaid) {
  auto bus = Bus::open(domain_);
  ASSERT_TRUE(bus.ok());
  const Writer<JointState> odd((*bus)->participant(), "/arm/measured_cp");
  const std::string old = refusal(here());
  EXPECT_NE(old.find("update the arm's node"), std::string::npos) << old;
}

TEST_F(LeaderTest, AnArmMovesByItselfOnlyWhereThatIsAllowed) {
  Commands rests;
  rests.state = "DISABLED";
  rests.homed = false;
  FakeCrtkArm arm(domain_, rests);
  const std::string said = refusal(here());
  EXPECT_NE(said.find("/arm is DISABLED and not homed; enable and home it"), std::string::npos)
      << said;
  EXPECT_TRUE(arm.with([](Commands& w) { return w.asked; }).empty()) << "left as it was";
  Leader wire(here("/arm", true));
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok()) << spec.error().text;
  EXPECT_EQ(arm.with([](Commands& w) { return w.asked; }),
            (std::vector<std::string>{"enable", "home"}));
  EXPECT_TRUE(next(wire).valid);
}

TEST_F(LeaderTest, AnArmThatFaultsWhileHomingIsSaid) {
  Commands lame;
  lame.homed = false;
  lame.home_ms = -1;
  FakeCrtkArm arm(domain_, lame);
  const std::string said = refusal(here("/arm", true));
  EXPECT_NE(said.find("is FAULT"), std::string::npos) << said;
  EXPECT_NE(refusal(here()).find("clear the fault"), std::string::npos);
}

TEST_F(LeaderTest, AnArmThatTellsNoStateIsTakenAsItIs) {
  FakeCrtkArm arm(domain_, "/arm", {.states = false});
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_TRUE(next(wire).valid);
}

TEST_F(LeaderTest, DisabledUnstampedOrImpossibleItIsNotBelieved) {
  FakeCrtkArm arm(domain_);
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  const auto good = [&] { return next(wire).valid; };
  const auto bad = [&] { return !next(wire).valid; };
  ASSERT_TRUE(soon(good));
  arm.with([](Commands& w) { w.state = "DISABLED"; });
  EXPECT_TRUE(soon(bad));
  EXPECT_NE(wire.why().find("disabled"), std::string::npos) << wire.why();
  arm.with([](Commands& w) { w.state = "ENABLED"; });
  EXPECT_TRUE(soon(good));
  EXPECT_EQ(wire.why(), "");
  arm.with([](Commands& w) { w.stamped = false; });
  EXPECT_TRUE(soon(bad));
  EXPECT_NE(wire.why().find("not valid"), std::string::npos);
  arm.with([](Commands& w) { w.stamped = true; });
  EXPECT_TRUE(soon(good));
  for (const double odd :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e6}) {
    arm.with([&](Commands& w) { w.place.p.y() = odd; });
    EXPECT_TRUE(soon(bad));
    arm.with([](Commands& w) { w.place.p.setZero(); });
    EXPECT_TRUE(soon(good));
    arm.with([&](Commands& w) { w.velocity.x() = odd == 1e6 ? 0 : odd; });
    if (odd != 1e6) {
      EXPECT_TRUE(soon(bad));
    }
    arm.with([](Commands& w) { w.velocity.setZero(); });
    EXPECT_TRUE(soon(good));
  }
  arm.with([](Commands& w) { w.place.q.coeffs().setZero(); });
  EXPECT_TRUE(soon(bad));
}

TEST_F(LeaderTest, ARunningSessionPushesAndLetsGo) {
  FakeCrtkArm arm(domain_);
  const auto hand = device();
  ASSERT_TRUE(hand->open().ok());
  test::StandIn tick(*hand, [](const HandState& state) {
    return Vec3(0, -400 * std::min(0.0, state.world_from_tool.p.y()), 0);
  });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  arm.with([](Commands& w) { w.place.p.y() = -4e-3; });
  EXPECT_TRUE(soon([&] { return arm.force().y() > 1.5; }));
  EXPECT_TRUE(soon([&] { return arm.with([](Commands& w) { return w.forces; }) > 500; }));
  tick.stop();
  hand->close();
  EXPECT_TRUE(soon([&] { return arm.force() == Vec3::Zero(); }));
}

TEST_F(LeaderTest, ANodeThatDiesInContactIsALostHandAndComesBackByTheRamp) {
  auto arm = std::make_unique<FakeCrtkArm>(domain_);
  const auto hand = device();
  ASSERT_TRUE(hand->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*hand, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(soon([&] { return arm->force().norm() > 1.9; }));
  arm.reset();
  ASSERT_TRUE(soon([&] { return tick.invalid() > 0; }));
  ASSERT_TRUE(soon([&] { return !hand->trouble().empty(); }));
  arm = std::make_unique<FakeCrtkArm>(domain_);
  ASSERT_TRUE(soon([&] { return hand->reconnections() == 1; })) << hand->trouble();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(arm->force(), Vec3::Zero()) << "the wall is still there: it waits for a small force";
  wall = false;
  EXPECT_TRUE(soon([&] { return tick.engaged(); }));
}

TEST_F(LeaderTest, AStallOf50MsIsALostHandAndNotALostArm) {
  FakeCrtkArm arm(domain_);
  const auto hand = device("/arm", 5e-3);
  ASSERT_TRUE(hand->open().ok());
  test::StandIn tick(*hand, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return arm.force().norm() > 0.03; }));
  arm.with([](Commands& w) { w.stall_ms = 50; });
  EXPECT_TRUE(soon([&] { return (tick.flags() & rt::kFlagHandLost) != 0; }));
  EXPECT_TRUE(soon([&] { return tick.hand().valid && arm.force().norm() > 0.03; }));
  EXPECT_EQ(hand->reconnections(), 0);
}

TEST_F(LeaderTest, ARateThatFallsLaterIsALostHandEachTime) {
  FakeCrtkArm arm(domain_);
  const auto hand = device("/arm", 5e-3);
  ASSERT_TRUE(hand->open().ok());
  test::StandIn tick(*hand, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return arm.force().norm() > 0.03; }));
  arm.with([](Commands& w) { w.rate_hz = 100; });
  EXPECT_TRUE(soon([&] { return tick.invalid() > 20; }));
  EXPECT_TRUE(soon([&] { return arm.force().norm() < 0.03; })) << "not held over";
}

TEST_F(LeaderTest, TwoAtOnceEachHasItsOwnForce) {
  FakeCrtkArm left(domain_, "/MTML"), right(domain_, "/MTMR");
  const auto one = device("/MTML"), two = device("/MTMR");
  ASSERT_TRUE(one->open().ok());
  ASSERT_TRUE(two->open().ok());
  test::StandIn first(*one, [](const HandState&) { return Vec3(0.04, 0, 0); });
  test::StandIn second(*two, [](const HandState&) { return Vec3(0, 0.03, 0); });
  EXPECT_TRUE(soon([&] {
    return std::abs(left.force().x() - 0.04) < 1e-9 && std::abs(right.force().y() - 0.03) < 1e-9;
  }));
  EXPECT_EQ(right.force().x(), 0);
}

TEST_F(LeaderTest, OfManyRandomForcesNonePassesTheLimit) {
  FakeCrtkArm arm(domain_);
  Leader wire(here());
  ASSERT_TRUE(wire.connect().ok());
  next(wire);
  const unsigned seed = std::random_device{}();
  test::WildForces forces(seed);
  // whatever comes: each message is read back on the bus, not only those the arm had time for
  auto bus = Bus::open(domain_);
  ASSERT_TRUE(bus.ok());
  Reader<WrenchStamped> wrenches((*bus)->participant(), "/arm/body/servo_cf", Keep::all);
  ASSERT_TRUE(soon([&] {
    static_cast<void>(wire.write(Vec3::Zero()));
    return wrenches.take() != nullptr;
  }));
  double largest = 0;
  for (int n = 0; n < 1'000'000; ++n) {
    static_cast<void>(wire.write(forces.next()));
    while (const WrenchStamped* wrench = wrenches.take())
      largest = std::max(largest, vector_of(wrench->wrench_.force_).norm());
  }
  EXPECT_GT(largest, 2.9) << "seed " << seed;
  EXPECT_LE(largest, 3 + 1e-9) << "seed " << seed;
}

// Puts any bits in place of a message's numbers.
class Odd {
 public:
  explicit Odd(unsigned seed) : random_(seed) {}
  double number() {
    static constexpr double kSome[] = {0.0,
                                       -0.0,
                                       1.0,
                                       -1.0,
                                       0.5,
                                       1e-310,
                                       -5e-324,
                                       1.7e308,
                                       -1.7e308,
                                       1e160,
                                       std::numeric_limits<double>::infinity(),
                                       -std::numeric_limits<double>::infinity(),
                                       std::numeric_limits<double>::quiet_NaN()};
    const auto bits = random_();
    if (bits % 4 == 0) return kSome[random_() % std::size(kSome)];
    if (bits % 4 == 1) return std::ldexp(static_cast<double>(random_() >> 1), -64);
    return std::bit_cast<double>(random_());
  }
  void spoil(PoseStamped& pose, TwistStamped& twist) {
    const auto which = random_();
    for (double* number :
         {&pose.pose_.position_.x_, &pose.pose_.position_.y_, &pose.pose_.position_.z_,
          &pose.pose_.orientation_.x_, &pose.pose_.orientation_.y_, &pose.pose_.orientation_.z_,
          &pose.pose_.orientation_.w_, &twist.twist_.linear_.x_, &twist.twist_.linear_.y_,
          &twist.twist_.linear_.z_})
      if ((which & random_()) % 4 == 1) *number = this->number();
    if (which % 16 == 0) pose.pose_.orientation_ = {0, 0, 0, 0};
    for (Stamp* stamp : {&pose.header_.stamp_, &twist.header_.stamp_})
      if (random_() % 8 == 0)
        *stamp = {static_cast<std::int32_t>(random_()), static_cast<std::uint32_t>(random_())};
  }

 private:
  std::mt19937_64 random_;
};

bool can_be(const HandState& hand) {
  return hand.world_from_tool.p.norm() < 5 && std::abs(hand.world_from_tool.q.norm() - 1) < 1e-9 &&
         hand.velocity.norm() < 100;
}

TEST(CrtkReading, WhateverNumbersAMessageHasTheHandCanBe) {
  const unsigned seed = std::random_device{}();
  Odd odd(seed);
  HandState hand;
  int taken = 0;
  for (int n = 0; n < 300'000; ++n) {
    PoseStamped pose{};
    TwistStamped twist{};
    pose.header_.stamp_.sec_ = twist.header_.stamp_.sec_ = 1;
    pose.pose_.orientation_.w_ = 1;
    odd.spoil(pose, twist);
    const HandState before = hand;
    const bool placed = take_place(pose, hand), moves = take_speed(twist, hand);
    taken += placed ? 1 : 0;
    ASSERT_TRUE(placed || hand.world_from_tool.p == before.world_from_tool.p) << "seed " << seed;
    ASSERT_TRUE(moves || hand.velocity == before.velocity) << "seed " << seed;
    ASSERT_TRUE(can_be(hand)) << "seed " << seed << ", message " << n;
  }
  EXPECT_GT(taken, 1000) << "seed " << seed;
  EXPECT_LT(taken, 299'000) << "seed " << seed;
}

TEST_F(LeaderTest, WhateverNumbersComeTheForceIsBoundedAndTheHandCanBe) {
  FakeCrtkArm arm(domain_);
  const auto hand = device();
  ASSERT_TRUE(hand->open().ok());
  std::atomic<int> odd_hands = 0, seen = 0;
  test::StandIn tick(*hand, [&](const HandState& state) {
    ++seen;
    if (!can_be(state)) ++odd_hands;
    return Vec3(-1e5 * state.world_from_tool.p - 1e4 * state.velocity);
  });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  const unsigned seed = std::random_device{}();
  auto odd = std::make_shared<Odd>(seed);
  const std::uint64_t before = arm.with([&](Commands& w) {
    w.place.p = {0.01, 0.02, 0.03};
    w.spoil = [odd](PoseStamped& pose, TwistStamped& twist) { odd->spoil(pose, twist); };
    return w.places;
  });
  ASSERT_TRUE(soon([&] {
    if (!can_be(tick.hand())) ++odd_hands;
    return arm.with([](Commands& w) { return w.places; }) > before + 5000;
  }));
  EXPECT_EQ(odd_hands, 0) << "seed " << seed;
  EXPECT_GT(seen, 100) << "some are believed";
  EXPECT_GT(tick.invalid(), 100U) << "and some are not";
  EXPECT_LE(arm.with([](Commands& w) { return w.largest; }), 3 + 1e-9) << "seed " << seed;
  arm.with([](Commands& w) { w.spoil = nullptr; });
  EXPECT_TRUE(soon([&] { return tick.hand().valid; })) << "and it goes on; seed " << seed;
}

// ---- other writers of forces

TEST_F(LeaderTest, AnArmThatAnotherPushesIsLeftToHim) {
  FakeCrtkArm arm(domain_);
  for (const char* route : {"/arm/body/servo_cf", "/arm/spatial/servo_cf"}) {
    auto bus = Bus::open(domain_);
    ASSERT_TRUE(bus.ok());
    const Writer<WrenchStamped> other((*bus)->participant(), route);
    const std::string said = refusal(here());
    EXPECT_NE(said.find("another program sends forces to /arm"), std::string::npos) << said;
    EXPECT_NE(said.find("end that program"), std::string::npos) << said;
  }
  EXPECT_EQ(arm.with([](Commands& w) { return w.forces; }), 0U);
  EXPECT_TRUE(soon([&] { return refusal(here()) == "it connected"; })) << "once he has ended";
}

TEST_F(LeaderTest, ASecondBurrIsRefusedAndTheFirstGoesOn) {
  FakeCrtkArm arm(domain_);
  Leader first(here());
  ASSERT_TRUE(first.connect().ok());
  std::atomic<bool> done = false;
  int invalid = 0;
  std::thread goes_on([&] {
    HandState hand;
    while (!done) {
      if (first.read(hand) == Wire::Read::hand && !hand.valid) ++invalid;
      static_cast<void>(first.write({0, 0.5, 0}));
    }
  });
  const std::string said = refusal(here());
  EXPECT_NE(said.find("another program sends forces to /arm"), std::string::npos) << said;
  EXPECT_TRUE(soon([&] { return arm.force().y() == 0.5; }));
  done = true;
  goes_on.join();
  // the second one has a writer of its own while it looks for others
  EXPECT_TRUE(soon([&] {
    static_cast<void>(first.write(Vec3::Zero()));
    return next(first).valid;
  }));
}

TEST_F(LeaderTest, WhoComesLaterMakesItLetGo) {
  FakeCrtkArm arm(domain_);
  const auto hand = device();
  ASSERT_TRUE(hand->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*hand, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(soon([&] { return arm.force().norm() > 1.9; }));
  {
    auto bus = Bus::open(domain_);
    ASSERT_TRUE(bus.ok());
    const Writer<WrenchStamped> other((*bus)->participant(), "/arm/spatial/servo_cf");
    EXPECT_TRUE(soon([&] { return !tick.hand().valid && arm.force() == Vec3::Zero(); }));
    EXPECT_TRUE(soon([&] { return hand->trouble().find("another program") != std::string::npos; }))
        << hand->trouble();
  }
  EXPECT_TRUE(soon([&] { return tick.hand().valid; }));
  EXPECT_FALSE(tick.engaged()) << "the wall is still there: it waits for a small force";
  wall = false;
  EXPECT_TRUE(soon([&] { return tick.engaged(); }));
  EXPECT_EQ(hand->reconnections(), 0);
}

TEST_F(LeaderTest, OpenedAndClosedManyTimesNothingIsLeft) {
  // a round takes an eighth of a second: the bus, a hundred readings for the rate, the guardian
  const int rounds = test::rounds();
  const std::vector<std::string> names{"/one", "/two", "/three",
                                       "/four"};  // four at once: each waits most of its time
  std::vector<std::unique_ptr<FakeCrtkArm>> arms;
  for (const std::string& name : names)
    arms.push_back(std::make_unique<FakeCrtkArm>(domain_, name));
  const auto once = [&](const std::string& name) {
    std::string trouble;
    static_cast<void>(soon([&] {  // on a busy machine the fake arm may be too slow
      Leader wire(here(name));
      const auto found = wire.connect();
      trouble = found.ok() ? "" : found.error().text;
      return trouble.find("times a second") == std::string::npos;
    }));
    return trouble;
  };
  const auto often = [&](int times) {
    std::vector<std::string> troubles(names.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < names.size(); ++i)
        threads.emplace_back([&, i] {
          for (int n = 0; n < times && troubles[i].empty(); ++n) troubles[i] = once(names[i]);
        });
    }
    for (const std::string& trouble : troubles) EXPECT_EQ(trouble, "");
  };
  often(4);  // what is kept for ever is allocated now
  const int files = test::open_files();
  const std::size_t memory = test::memory_in_use();
  often(rounds / 4);
  EXPECT_TRUE(soon([&] { return test::open_files() <= files; }))
      << test::open_files() << " open, " << files << " before";
  // Cyclone DDS itself keeps some kilobytes of every participant that has gone, without anything of
  // ours; a participant that was not closed has hundreds
  EXPECT_LT(test::memory_in_use(), memory + static_cast<std::size_t>(rounds) * 20'000);
}

// ---- names and bytes, compared with what ROS 2 specifies rather than with our own code

TEST_F(LeaderTest, NamesAndTypesAreThoseOfRos) {
  FakeCrtkArm arm(domain_);
  auto bus = Bus::open(domain_);
  ASSERT_TRUE(bus.ok());
  const dds_entity_t all =
      dds_create_reader((*bus)->participant(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  std::vector<std::string> seen;
  const auto look = [&] {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(all, &sample, &info, 1, 1) > 0) {
      const auto& point = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
      seen.push_back(std::string(point.topic_name) + " " + point.type_name);
      dds_return_loan(all, &sample, 1);
      sample = nullptr;
    }
    const auto has = [&](const char* what) {
      return std::find(seen.begin(), seen.end(), what) != seen.end();
    };
    return has("rt/arm/measured_cp geometry_msgs::msg::dds_::PoseStamped_") &&
           has("rt/arm/operating_state crtk_msgs::msg::dds_::OperatingState_") &&
           has("rt/footpedals/clutch sensor_msgs::msg::dds_::Joy_") &&
           has("rt/arm/gripper/closed std_msgs::msg::dds_::Bool_");
  };
  EXPECT_TRUE(soon(look));
}

// PoseStamped as common_interfaces defines it, in plain CDR, little-endian (RTPS 10.2): int32 sec,
// uint32 nanosec, string frame_id, 3 doubles of the position, 4 of the orientation (x y z w).
TEST_F(LeaderTest, APlaceOnTheWireIsThatOfRosByteForByte) {
  auto bus = Bus::open(domain_);
  ASSERT_TRUE(bus.ok());
  Writer<PoseStamped> writer((*bus)->participant(), "/bytes/measured_cp");
  Reader<PoseStamped> reader((*bus)->participant(), "/bytes/measured_cp", Keep::all);
  PoseStamped pose{};
  pose.header_.stamp_.sec_ = 7;
  pose.header_.stamp_.nanosec_ = 9;
  pose.header_.frame_id_ = as_sample_text("abc");
  auto& place = pose.pose_.position_;  // each by its name, in ROS' order below
  place.x_ = 1;
  place.y_ = 2;
  place.z_ = 3;
  auto& turn = pose.pose_.orientation_;
  turn.x_ = 0.1;
  turn.y_ = 0.2;
  turn.z_ = 0.3;
  turn.w_ = 0.4;
  ASSERT_TRUE(soon([&] { return writer.readers() > 0; }));
  writer.write(pose);
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  ASSERT_TRUE(
      soon([&] { return dds_takecdr(reader.entity(), &data, 1, &info, DDS_ANY_STATE) == 1; }));
  std::vector<unsigned char> bytes(ddsi_serdata_size(data));
  ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
  ddsi_serdata_unref(data);
  std::vector<unsigned char> expected = {0, 1, 0, 0, 7, 0, 0,   0,   9,   0,
                                         0, 0, 4, 0, 0, 0, 'a', 'b', 'c', 0};
  for (const double number : {1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.4}) {
    // doubles lie at multiples of eight after the four bytes of the header
    while ((expected.size() - 4) % 8 != 0) expected.push_back(0);
    unsigned char raw[8];
    std::memcpy(raw, &number, 8);
    expected.insert(expected.end(), raw, raw + 8);
  }
  ASSERT_GE(bytes.size(), expected.size());
  bytes.resize(expected.size());
  bytes[2] = bytes[3] = 0;  // options in the header: padding at the end
  EXPECT_EQ(bytes, expected);
}

TEST(CrtkNames, AreWrittenAsRosDoes) {
  EXPECT_EQ(arm_name("MTMR"), "/MTMR");
  EXPECT_EQ(arm_name("/lab/left_1/"), "/lab/left_1");
  for (const char* bad : {"", "/", "1arm", "a//b", "a b", "a/1", "\xc3\xa4"})
    EXPECT_EQ(arm_name(bad), "") << bad;
}

}  // namespace
}  // namespace burr::device::crtk
