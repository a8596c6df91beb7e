// Faults of the Touch's library that its driver must notice by itself.
#include <gtest/gtest.h>

#include <memory>
#include <mutex>

#include "device/players/touch_player.h"
#include "device/stand_in.h"

namespace burr::device {
namespace {

using test::soon;

class TouchDoubt : public ::testing::Test {
 protected:
  void SetUp() override {
    LinkSettings link;
    link.loss_timeout = test::kStallsAllowed;
    device_ = player_.device(link);
    ASSERT_TRUE(device_->open().ok());
  }
  void TearDown() override {
    device_.reset();
    EXPECT_EQ(player_.misuse(), "");
  }

  test::TouchPlayer player_;
  std::unique_ptr<Device> device_;
};

TEST_F(TouchDoubt, AButtonThatNoDeviceHasDoesNotLift) {
  player_.press(1 | static_cast<int>(0x8000'0000U), true);
  ASSERT_TRUE(soon([&] { return (device_->state(1e-3).buttons & 1U) != 0; }));
  EXPECT_EQ(device_->state(1e-3).buttons, 1U);
}

TEST_F(TouchDoubt, ALibraryThatCallsNoMoreIsOpenedAnew) {
  test::FakeHd& hd = player_.false_library();
  const auto with = [&](auto look) {
    const std::lock_guard lock(hd.mutex);
    return look(hd);
  };
  ASSERT_EQ(with([](test::FakeHd& one) { return one.touch[0].opened; }), 1U);
  with([](test::FakeHd& one) { return one.rate = 0; });
  // a second of silence, checked twice a second
  EXPECT_TRUE(soon([&] { return with([](test::FakeHd& one) { return one.touch[0].opened; }) > 1; },
                   std::chrono::seconds(6)));
  with([](test::FakeHd& one) { return one.rate = 1000; });
  EXPECT_TRUE(soon([&] { return device_->state(1e-3).valid; }));
}

TEST(TouchRefused, LeavesNoForcesOn) {
  test::TouchPlayer player;
  const auto room = [&](bool none) {
    const std::lock_guard lock(player.false_library().mutex);
    player.false_library().no_room = none;
  };
  room(true);
  EXPECT_FALSE(player.device({})->open().ok());
  room(false);
  EXPECT_EQ(player.misuse(), "");
}

}  // namespace
}  // namespace burr::device
