// Whole sessions with every device that burr knows: bone, tick, safety layer, wire, and a user that
// the test plays (players/).
#include "burr/sim/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "burr/device/mapping.h"
#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "burr/tick/fault_report.h"
#include "device/players/every.h"
#include "device/slab.h"
#include "device/stand_in.h"

namespace burr::device {
namespace {

using math::Quat;
using math::Vec3;
using test::soon;
constexpr double kMm = 1e-3;
constexpr double kWall = 400;      // stiffness that all of them can show [N/m]
constexpr double kUnfelt = 0.021;  // force by which Haply's service is asked for its spelling [N]

class WholeSession : public ::testing::TestWithParam<test::Driver> {
 protected:
  void TearDown() override {
    session_.reset();
    EXPECT_EQ(player_->misuse(), "");
    EXPECT_LE(player_->largest(), player_->limit() + 1e-3) << "a wire's last digit beyond";
  }

  // A slab whose top is z = 0, seen from above: the hand's up is world z. The burr is 2 mm above
  // it.
  void begin(double answer_timeout = LinkSettings().answer_timeout, double stiffness = kWall) {
    LinkSettings link;
    link.loss_timeout = test::kStallsAllowed;
    link.answer_timeout = answer_timeout;
    auto hand = std::make_unique<MappedHand>(player_->device(link),
                                             math::Pose{{0, 0, 4 * kMm}, Quat::Identity()},
                                             Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
    hand_ = hand.get();
    sim::SessionSettings requested = test::slab_settings();
    requested.servo.force.stiffness = stiffness;
    requested.servo.limit.user_force = 100;  // high, because the test is about the device's own
                                             // limit
    auto made = test::slab_session(std::move(hand), requested);
    ASSERT_TRUE(made.ok()) << made.error().text;
    session_ = std::move(*made);
    session_->start();
    ASSERT_TRUE(soon([&] { return row().tick > 600; })) << "the start ramp is over";
  }

  tick::TickRow row() {
    static_cast<void>(session_->view(row_));
    return row_;
  }
  // Moves the hand up or down at 50 mm/s; y_mm: from the start.
  void go(double y_mm) {
    const double step = y_mm > y_mm_ ? 0.05 : -0.05;
    const auto way = static_cast<int>(std::lround(std::abs(y_mm - y_mm_) / 0.05));
    for (int n = 0; n <= way; ++n) {
      const bool there = n == way;
      player_->hold({0, kMm * (there ? y_mm : y_mm_ + n * step), 0}, {0, there ? 0 : step, 0});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    y_mm_ = y_mm;
  }
  // To 2.5 mm inside the bone: one newton.
  [[nodiscard]] bool press() {
    go(-4.5);
    return soon([&] { return player_->force().y() > 0.9; });
  }
  [[nodiscard]] bool let_go() {
    return soon([&] { return player_->force() == Vec3::Zero(); });
  }
  // By its own button, or by a separate pedal.
  void mill(bool down) {
    if (!player_->mill(down)) hand_->press(down ? 1 : 0);
  }
  void clutch(bool down) {
    if (!player_->clutch(down)) hand_->lift(down);
  }
  // Waits for this number of ticks.
  [[nodiscard]] bool ticks(std::uint64_t count) {
    const std::uint64_t now = row().tick;
    return soon([&] { return row().tick > now + count; });
  }
  [[nodiscard]] bool raised(std::uint32_t flag) {
    return soon([&] { return (row().contact.flags & flag) != 0; });
  }

  std::unique_ptr<test::Player> player_ = GetParam().player();
  MappedHand* hand_ = nullptr;
  std::unique_ptr<sim::Session> session_;
  tick::TickRow row_;
  double y_mm_ = 0;
};

TEST_P(WholeSession, TheWallPushesUpAndTheMillButtonCuts) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(press()) << player_->force().transpose();
  const Vec3 force = player_->force();
  EXPECT_NEAR(force.y(), kWall * 2.5 * kMm, 0.1);
  EXPECT_NEAR(force.x(), 0, 0.05);
  EXPECT_NEAR(force.z(), 0, 0.05);
  EXPECT_EQ(row().ledger.removed, 0);
  mill(true);
  ASSERT_TRUE(soon([&] { return row().ledger.removed > 1e-9; }));
  session_->stop();
  EXPECT_TRUE(let_go()) << "with the session";
}

TEST_P(WholeSession, PulledOutInContactTheSessionTellsAndGoesOnWhenItIsBack) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(press());
  player_->unplug();
  ASSERT_TRUE(raised(rt::kFlagHandLost));
  tick::FaultReport fault;
  ASSERT_TRUE(soon([&] { return session_->fault(fault); }));
  EXPECT_TRUE((fault.flags & rt::kFlagHandLost) != 0);
  EXPECT_EQ(fault.count, tick::FaultReport::kTicks);
  double pushed = 0;
  for (const tick::TickRow& one : fault.rows) pushed = std::max(pushed, one.contact.force.norm());
  EXPECT_GT(pushed, 0.7) << "the ticks before it, still pushing";
  EXPECT_TRUE(let_go()) << player_->force().transpose();
  EXPECT_TRUE(soon([&] { return !session_->hand().trouble().empty(); }));
  ASSERT_TRUE(ticks(20)) << "the session goes on";
  EXPECT_EQ(row().contact.force, Vec3::Zero());

  static_cast<void>(player_->felt());
  player_->plug_in();
  ASSERT_TRUE(soon([&] { return row().hand.valid; }));
  ASSERT_TRUE(ticks(50));
  EXPECT_TRUE((row().contact.flags & rt::kFlagWaiting) != 0) << "it is still in the bone";
  for (const test::Felt& one : player_->felt()) ASSERT_LE(one.force.norm(), kUnfelt);
  go(4);
  ASSERT_TRUE(raised(rt::kFlagRamp));
  EXPECT_TRUE(soon([&] { return session_->hand().trouble().empty(); }));
  go(-6.5);
  EXPECT_TRUE(soon([&] { return player_->force().y() > 0.3; })) << "it pushes again";
}

TEST_P(WholeSession, LiftedItCanBeLaidElsewhere) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(press());
  clutch(true);
  ASSERT_TRUE(soon([&] { return (row().hand.buttons & kLifted) != 0; }));
  ASSERT_TRUE(let_go());
  const Vec3 tip = row().hand.world_from_tool.p;
  go(10);
  ASSERT_TRUE(ticks(20)) << "all of the way has been read";
  EXPECT_EQ(row().hand.world_from_tool.p, tip);
  clutch(false);
  ASSERT_TRUE(soon([&] { return (row().hand.buttons & kLifted) == 0; }));
  go(14);
  EXPECT_TRUE(soon([&] {
    return std::abs(row().hand.world_from_tool.p.z() - tip.z() - 4 * kMm) < 0.1 * kMm;
  })) << row().hand.world_from_tool.p.transpose();
}

TEST_P(WholeSession, AStopFromOutsideIsAsALift) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(press());
  hand_->lift(true);
  ASSERT_TRUE(let_go());
  mill(true);
  go(-5);
  ASSERT_TRUE(ticks(20));
  EXPECT_EQ(row().ledger.removed, 0);
  EXPECT_EQ(player_->force(), Vec3::Zero());
}

// Here the wire waits for its tick, so that only readings between two ticks have no force of their
// own: a force that is late for many readings is not the machine's fault.
TEST_P(WholeSession, AForceIsOfTheReadingItGoesWith) {
  ASSERT_NO_FATAL_FAILURE(begin(test::kStallsAllowed / 2));
  ASSERT_TRUE(press());
  std::vector<int> late;
  for (int step = 0; step < 41; ++step) {
    const double depth = (step % 2 == 0 ? 2.0 : 2.5) * kMm;
    const Vec3 place(0, -2 * kMm - depth, 0);
    const auto is_of_it = [&](const Vec3& force) {
      return std::abs(force.y() - kWall * depth) < 0.05;
    };
    static_cast<void>(player_->felt());
    player_->hold(place, Vec3::Zero());
    std::vector<test::Felt> felt;
    ASSERT_TRUE(soon([&] {
      for (const test::Felt& one : player_->felt())
        if ((one.told - place).norm() < 1e-6) felt.push_back(one);
      return std::any_of(felt.begin(), felt.end(),
                         [&](const test::Felt& one) { return is_of_it(one.force); });
    })) << player_->force().transpose();
    const auto first = std::find_if(felt.begin(), felt.end(),
                                    [&](const test::Felt& one) { return is_of_it(one.force); });
    late.push_back(static_cast<int>(first - felt.begin()));
  }
  std::nth_element(late.begin(), late.begin() + 20, late.end());
  EXPECT_LE(late[20], player_->most_late());
}

// As deep as a hand can go into the hardest wall that the device can show.
TEST_P(WholeSession, NothingPassesTheDevicesLimit) {
  ASSERT_NO_FATAL_FAILURE(begin(LinkSettings().answer_timeout, 1e6));
  go(-3);
  go(-11);
  ASSERT_TRUE(soon([&] { return player_->force().y() > 0.99 * player_->limit(); }))
      << player_->force().transpose();
  EXPECT_TRUE(raised(rt::kFlagForceLimited));
}

INSTANTIATE_TEST_SUITE_P(Every, WholeSession, test::every_driver(), test::name_of);

}  // namespace
}  // namespace burr::device
