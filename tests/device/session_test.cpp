// Whole sessions with a Touch that the test plays: bone, tick, safety layer, wire.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "burr/device/mapping.h"
#include "burr/device/openhaptics/touch.h"
#include "burr/haptics/contact.h"
#include "burr/sim/session.h"
#include "device/fake/fake_hd.h"
#include "device/stand_in.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace burr::device {
namespace {

using math::Quat;
using math::Vec3;
using test::soon;
constexpr double kMm = 1e-3;

const std::string kLibrary = BURR_BUILD_DIR "/fakes/libHD.so";

class WholeSession : public ::testing::Test {
 protected:
  void SetUp() override {
    void* library = dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_GLOBAL);
    ASSERT_NE(library, nullptr);
    hd_ = reinterpret_cast<test::FakeHdState>(dlsym(library, "fake_hd"))();
    {
      const std::lock_guard lock(hd_->mutex);
      hd_->touch = {};
      hd_->rate = 1000;
    }
    openhaptics::TouchSettings settings;
    settings.hd_file = kLibrary;
    settings.link.loss_timeout = test::kStallsAllowed;
    // a slab whose top is z = 0, seen from above: up is world z
    auto hand = std::make_unique<MappedHand>(std::make_unique<openhaptics::Touch>(settings),
                                             math::Pose{{0, 0, 4 * kMm}, Quat::Identity()},
                                             Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
    hand_ = hand.get();
    NoProgress quiet;
    sim::SessionSettings wished;
    wished.realtime = true;
    wished.servo.burr.radius = 2 * kMm;
    wished.servo.undo_bricks = 512;
    wished.surface.reserve_blocks = 1 << 12;
    auto made = sim::Session::make(
        scenes::bone_from_distance(
            scenes::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
            scenes::slab(), 64),
        std::move(hand), wished, quiet);
    ASSERT_TRUE(made.ok()) << made.error().text;
    session_ = std::move(*made);
    session_->start();
    ASSERT_TRUE(soon([&] { return row().tick > 600; })) << "the start ramp is over";
  }
  void TearDown() override {
    session_.reset();
    const std::lock_guard lock(hd_->mutex);
    EXPECT_FALSE(hd_->touch[0].open);
    EXPECT_LE(hd_->touch[0].largest_force, 3.3 + 1e-9);
  }

  record::TickRow row() {
    static_cast<void>(session_->view(row_));
    return row_;
  }
  template <class F>
  void set(F change) {
    const std::lock_guard lock(hd_->mutex);
    change(hd_->touch[0]);
  }
  // The stylus goes there as a hand would, at 50 mm/s; its y, since the last call.
  void go(double y_mm, int button = 0) {
    const double step = y_mm > y_mm_ ? 0.05 : -0.05;
    const auto way = static_cast<int>(std::lround(std::abs(y_mm - y_mm_) / 0.05));
    for (int n = 0; n <= way; ++n) {
      set([&](test::FakeTouch& touch) {
        touch.transform[13] = n == way ? y_mm : y_mm_ + n * step;
        touch.velocity[1] = n == way ? 0 : 1e3 * step;
        touch.buttons = button;
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    y_mm_ = y_mm;
  }
  Vec3 wire() {
    const std::lock_guard lock(hd_->mutex);
    const auto& forces = hd_->touch[0].forces;
    return forces.empty() ? Vec3(Vec3::Zero())
                          : Vec3(forces.back()[0], forces.back()[1], forces.back()[2]);
  }

  test::FakeHd* hd_ = nullptr;
  MappedHand* hand_ = nullptr;
  std::unique_ptr<sim::Session> session_;
  record::TickRow row_;
  double y_mm_ = 0;
};

TEST_F(WholeSession, TheWallPushesUpOnTheStylusAndTheMillButtonCuts) {
  go(-4.5);  // 2.5 mm into the bone, 400 N/m
  ASSERT_TRUE(soon([&] { return wire().y() > 0.8; })) << wire().transpose();
  EXPECT_NEAR(wire().y(), 1.0, 0.15);
  EXPECT_NEAR(wire().x(), 0, 0.05);
  EXPECT_NEAR(wire().z(), 0, 0.05);
  EXPECT_EQ(row().ledger.removed, 0);
  go(-4.5, 1);
  ASSERT_TRUE(soon([&] { return row().ledger.removed > 1e-9; }));
  session_->stop();
  EXPECT_TRUE(soon([&] { return wire() == Vec3::Zero(); })) << "let go with the session";
}

TEST_F(WholeSession, PulledOutInContactTheSessionTellsAndGoesOnWhenItIsBack) {
  go(-4.5);
  ASSERT_TRUE(soon([&] { return wire().y() > 0.8; }));
  set([](test::FakeTouch& touch) { touch.present = false; });
  ASSERT_TRUE(soon([&] { return (row().contact.flags & haptics::kFlagHandLost) != 0; }));
  sim::FaultReport fault;
  ASSERT_TRUE(soon([&] { return session_->fault(fault); }));
  EXPECT_TRUE((fault.flags & haptics::kFlagHandLost) != 0);
  EXPECT_EQ(fault.count, sim::FaultReport::kTicks);
  double pushed = 0;
  for (const record::TickRow& one : fault.rows) pushed = std::max(pushed, one.contact.force.norm());
  EXPECT_GT(pushed, 0.7) << "the ticks before it, still pushing";
  EXPECT_EQ(row().contact.force, Vec3::Zero());
  EXPECT_FALSE(session_->hand().trouble().empty());
  set([](test::FakeTouch& touch) { touch.present = true; });
  ASSERT_TRUE(soon([&] { return row().hand.valid; }));
  EXPECT_EQ(wire(), Vec3::Zero());
  go(4);
  ASSERT_TRUE(soon([&] { return (row().contact.flags & haptics::kFlagWaiting) == 0; }));
  go(-6.5);
  ASSERT_TRUE(soon([&] { return wire().y() > 0.3; })) << "it pushes again";
}

TEST_F(WholeSession, LiftedItCanBeLaidElsewhere) {
  go(-4.5);
  ASSERT_TRUE(soon([&] { return wire().y() > 0.8; }));
  go(-4.5, 2);
  ASSERT_TRUE(soon([&] { return (row().hand.buttons & kLifted) != 0; }));
  ASSERT_TRUE(soon([&] { return wire() == Vec3::Zero(); }));
  const Vec3 tip = row().hand.world_from_tool.p;
  go(10, 2);
  EXPECT_EQ(row().hand.world_from_tool.p, tip);
  go(10, 0);
  go(14);
  EXPECT_NEAR(row().hand.world_from_tool.p.z() - tip.z(), 4 * kMm, 0.1 * kMm);
}

TEST_F(WholeSession, AStopFromOutsideIsAsALift) {
  go(-4.5);
  ASSERT_TRUE(soon([&] { return wire().y() > 0.8; }));
  hand_->lift(true);
  ASSERT_TRUE(soon([&] { return wire() == Vec3::Zero(); }));
  go(-5, 1);
  EXPECT_EQ(row().ledger.removed, 0);
}

}  // namespace
}  // namespace burr::device
