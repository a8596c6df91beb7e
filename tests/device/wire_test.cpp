// What all devices on a wire of their own have in common (device/wire.h).
#include "burr/device/wire.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "device/players/every.h"
#include "device/stand_in.h"

namespace burr::device {
namespace {

using test::soon;

class EveryLoss : public ::testing::TestWithParam<test::Driver> {};

// With a timeout longer than any test: the driver itself must report the loss.
TEST_P(EveryLoss, IsToldAtOnceAndNotOnlyByTheTimeout) {
  const auto player = GetParam().player();
  LinkSettings link;
  link.loss_timeout = 300;
  const auto device = player->device(link);
  const Status opened = device->open();
  ASSERT_TRUE(opened.ok()) << opened.error().text;
  const auto valid = [&] { return device->state(1e-3).valid; };
  ASSERT_TRUE(soon(valid));
  player->unplug();
  EXPECT_TRUE(soon([&] { return !valid(); }));
}

INSTANTIATE_TEST_SUITE_P(Every, EveryLoss, test::every_driver(), test::name_of);

// A device whose write does not wait: the wire pauses all the same.
class Hurried final : public Wire {
 public:
  explicit Hurried(std::atomic<int>& readings) : readings_(readings) {}
  Result<DeviceSpec> connect() override { return DeviceSpec{}; }
  Read read(HandState&) BURR_RT override {
    ++readings_;
    return Read::hand;
  }
  bool write(const math::Vec3&) BURR_RT override { return true; }
  void disconnect() override {}

 private:
  std::atomic<int>& readings_;
};

TEST(WireDevice, ADeviceThatNeverWaitsIsAskedNoMoreThanFiveThousandTimesASecond) {
  std::atomic<int> readings = 0;
  WireDevice device(std::make_unique<Hurried>(readings));
  const auto began = std::chrono::steady_clock::now();
  ASSERT_TRUE(device.open().ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  device.close();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  EXPECT_GT(readings, 1);
  EXPECT_LE(readings, 5000 * took.count() + 2);
}

}  // namespace
}  // namespace burr::device
