// Two fake Touches in one session in real time: the burr, and a second hand that feels the bone.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "burr/device/mapping.h"
#include "burr/device/openhaptics/touch.h"
#include "burr/haptics/contact.h"
#include "burr/haptics/touch_method.h"
#include "burr/rt/flags.h"
#include "burr/sim/session.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/second_hand.h"
#include "device/fake/fake_hd.h"
#include "device/slab.h"
#include "device/stand_in.h"
#include "support/test_places.h"

namespace burr::device {
namespace {

using math::Quat;
using math::Vec3;
using test::soon;
constexpr double kMm = 1e-3;

const std::string kLibrary = test::build_dir() + "/fakes/libHD.so";

class TwoHands : public ::testing::Test {
 protected:
  void SetUp() override {
    void* library = dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_GLOBAL);
    ASSERT_NE(library, nullptr);
    hd_ = reinterpret_cast<test::FakeHdState>(dlsym(library, "fake_hd"))();
    {
      const std::lock_guard lock(hd_->mutex);
      hd_->touch = {};
      hd_->rate = 1000;
      hd_->touch[1].name = "Left";
      hd_->touch[1].serial = "T-0002";
      hd_->touch[1].present = true;
    }
    auto made = test::slab_session(hand("", {-3 * kMm, 0, 4 * kMm}));
    ASSERT_TRUE(made.ok()) << made.error().text;
    session_ = std::move(*made);
    const Status joined = session_->add_second_hand(hand("Left", {3 * kMm, 0, 4 * kMm}), {});
    ASSERT_TRUE(joined.ok()) << joined.error().text;
    session_->start();
    ASSERT_TRUE(soon([&] { return second().tick > 600; })) << "the start ramps are over";
  }
  void TearDown() override {
    session_.reset();
    const std::lock_guard lock(hd_->mutex);
    for (const std::size_t n : {0U, 1U}) {
      EXPECT_FALSE(hd_->touch[n].open);
      EXPECT_LE(hd_->touch[n].largest_force, 3.3 + 1e-9);
    }
  }
  static std::unique_ptr<Device> hand(const std::string& name, const Vec3& start) {
    openhaptics::TouchSettings settings;
    settings.hd_file = kLibrary;
    settings.name = name;
    settings.link.loss_timeout = test::kStallsAllowed;
    return std::make_unique<MappedHand>(std::make_unique<openhaptics::Touch>(settings),
                                        math::Pose{start, Quat::Identity()},
                                        Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
  }
  tick::TickRow first() {
    static_cast<void>(session_->view(first_));
    return first_;
  }
  tick::TickRow second() {
    static_cast<void>(session_->second_hand()->view().take(second_));
    return second_;
  }
  // Down by this distance, at 50 mm/s.
  void down(std::size_t which, double mm) {
    for (double at = 0; at <= mm; at += 0.05) {
      {
        const std::lock_guard lock(hd_->mutex);
        hd_->touch[which].transform[13] = -at;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  double up(std::size_t which) {
    const std::lock_guard lock(hd_->mutex);
    const auto& forces = hd_->touch[which].forces;
    return forces.empty() ? 0 : forces.back()[1];
  }

  test::FakeHd* hd_ = nullptr;
  std::unique_ptr<sim::Session> session_;
  tick::TickRow first_, second_;
};

TEST_F(TwoHands, EachFeelsTheBoneWhereItIs) {
  down(1, 4.5);  // a ball of 1.5 mm, 2 mm inside the bone, 400 N/m
  EXPECT_TRUE(soon([&] { return up(1) > 0.7 && up(1) < 0.9; })) << up(1);
  EXPECT_EQ(up(0), 0);
  down(0, 3.5);  // a ball of 2 mm, 1.5 mm inside
  EXPECT_TRUE(soon([&] { return up(0) > 0.5 && up(0) < 0.7; })) << up(0);
  EXPECT_TRUE(soon([&] { return up(1) > 0.7 && up(1) < 0.9; })) << up(1);
  EXPECT_EQ(first().ledger.removed, 0);
  session_->stop();
  EXPECT_TRUE(soon([&] { return up(0) == 0 && up(1) == 0; })) << "both are let go";
}

TEST_F(TwoHands, TheLossOfOneIsNotTheOthers) {
  down(1, 4.5);
  down(0, 3.5);
  ASSERT_TRUE(soon([&] { return up(0) > 0.5 && up(1) > 0.7; }));
  {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[1].present = false;
  }
  ASSERT_TRUE(soon([&] { return (second().contact.flags & rt::kFlagHandLost) != 0; }));
  EXPECT_TRUE(soon([&] { return second().contact.force == Vec3::Zero(); }));
  EXPECT_EQ(first().contact.flags & rt::kFlagHandLost, 0U);
  EXPECT_TRUE(soon([&] { return up(0) > 0.5; })) << "a frame begins with none";
  auto report = std::make_unique<tick::FaultReport>();
  EXPECT_TRUE(soon([&] { return session_->second_hand()->faults().take(*report); }));
  EXPECT_NE(report->flags & rt::kFlagHandLost, 0U);
  EXPECT_FALSE(session_->fault(*report));
}

}  // namespace
}  // namespace burr::device
