// A faulty tick: whatever force it asks for, no driver gives its device more than the limit, and
// each driver releases the force when it is closed meanwhile.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <thread>

#include "device/players/every.h"
#include "device/stand_in.h"

namespace burr::device {
namespace {

using math::Vec3;
using test::soon;

// Ticks without a safety layer.
class Mistaken {
 public:
  Mistaken(Device& device, const Vec3& asks)
      : device_(device), asks_(asks), thread_([this] { run(); }) {}
  ~Mistaken() {
    stop_ = true;
    thread_.join();
  }
  Mistaken(const Mistaken&) = delete;
  Mistaken& operator=(const Mistaken&) = delete;

 private:
  void run() {
    rt::TickClock* clock = device_.clock(1000);
    // a hand that was lost at first gets a force only after the tick itself was at zero
    for (int tick = 0; !stop_; ++tick) {
      static_cast<void>(clock->wait());
      static_cast<void>(device_.state(1e-3));
      device_.write_force(tick < 20 ? Vec3(Vec3::Zero()) : asks_);
    }
  }

  Device& device_;
  const Vec3 asks_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class LastBound : public ::testing::TestWithParam<test::Driver> {
 protected:
  void SetUp() override {
    LinkSettings link;
    link.loss_timeout = test::kStallsAllowed;
    device_ = player_->device(link);
    const Status opened = device_->open();
    ASSERT_TRUE(opened.ok()) << opened.error().text;
  }

  std::unique_ptr<test::Player> player_ = GetParam().player();
  std::unique_ptr<Device> device_;
};

TEST_P(LastBound, ShortensWhatIsTooMuchAndLetsGoAtTheEnd) {
  {
    const Mistaken tick(*device_, {0, 1000, 0});
    EXPECT_TRUE(soon([&] { return player_->force().y() > 0.99 * player_->limit(); }))
        << player_->force().transpose();
    device_->close();
  }
  EXPECT_TRUE(soon([&] { return player_->force() == Vec3::Zero(); }))
      << player_->force().transpose();
  EXPECT_LE(player_->largest(), player_->limit() + 1e-3);
  device_.reset();
  EXPECT_EQ(player_->misuse(), "");
}

TEST_P(LastBound, WhatIsNoNumberIsNoForce) {
  static_cast<void>(player_->felt());
  {
    const Mistaken tick(*device_, Vec3(0, std::numeric_limits<double>::quiet_NaN(), 5));
    std::size_t felt = 0;
    EXPECT_TRUE(soon([&] {
      for (const test::Felt& one : player_->felt()) {
        ++felt;
        EXPECT_TRUE(one.force.norm() < 0.021) << one.force.transpose();
      }
      return felt > 100;
    }));
  }
  device_->close();
}

INSTANTIATE_TEST_SUITE_P(Every, LastBound, test::every_driver(), test::name_of);

}  // namespace
}  // namespace burr::device
