// A device that is tried by a hand that follows the instructions; the test plays the device.
#include "devices/trial.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

namespace burr::app {
namespace {

using math::Vec3;

// Moves as the last instruction says, tick by tick, without another clock. `axes`: a wrong mounting
// of the device.
class Obedient final : public device::Device {
 public:
  explicit Obedient(const math::Mat3& axes) : axes_(axes) {}
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }

  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    time_ += dt;
    const int now = asked.load();
    if (now != doing_) {
      doing_ = now;
      since_ = time_;
      from_ = at_;
    }
    const double t = time_ - since_;
    Vec3 to = from_;
    if (doing_ >= 1 && doing_ <= 3)
      to += std::min(0.04, 0.05 * std::max(0.0, t - 0.3)) * Vec3::Unit(doing_ - 1);
    if (doing_ == 4 && t > 1.5)  // slowly into the wall and out again
      to.y() -= 0.006 * (1 - std::cos(2 * std::numbers::pi * 0.8 * (t - 1.5)));
    device::HandState hand;
    hand.velocity = axes_ * ((to - at_) / dt);
    at_ = to;
    const double hum = 20e-6 * std::sin(2 * std::numbers::pi * 50 * time_);
    hand.world_from_tool.p = axes_ * (at_ + Vec3(hum, 0, 0));
    return hand;
  }
  void write_force(const Vec3& force) BURR_RT override {
    most = std::max(most, force.norm());
    last = force;
  }

  std::atomic<int> asked = 0;  // 0: rest, 1 to 3: an axis, 4: the wall
  double most = 0;
  Vec3 last = Vec3::Zero();

 private:
  math::Mat3 axes_;
  device::DeviceSpec spec_{
      .name = "obedient", .serial = "<7>", .peak_force = 3.3, .max_stiffness = 250};
  double time_ = 0, since_ = 0;
  int doing_ = 0;
  Vec3 at_ = Vec3::Zero(), from_ = Vec3::Zero();
};

TrialMeasurements tried(Obedient& device, const TrialSettings& settings = {.rest_s = 0.5}) {
  int told = 0;
  return try_device(
      device, settings, [&](const std::string&) { device.asked = told++; }, [] { return false; });
}

TEST(Trial, AGoodDeviceIsFoundGood) {
  Obedient device(math::Mat3::Identity());
  const TrialMeasurements seen = tried(device);
  EXPECT_TRUE(seen.left_out.empty()) << seen.left_out.front();
  for (const AxisMeasurement& axis : seen.axes) {
    EXPECT_TRUE(axis.done);
    EXPECT_LT(axis.off_deg, 1) << axis.asked;
  }
  EXPECT_NEAR(seen.noise.x(), 20e-6 / std::numbers::sqrt2, 3e-6);
  EXPECT_LT(seen.noise.y(), 1e-9);
  EXPECT_EQ(seen.presses, 3);
  EXPECT_NEAR(seen.deepest, 2e-3, 0.2e-3);
  EXPECT_NEAR(seen.stiffness, 250, 5) << "the device's own limit, not the 300 asked for";
  EXPECT_LE(device.most, 2);
  EXPECT_EQ(device.last, Vec3::Zero());
}

TEST(Trial, AMirroredAxisIsSeen) {
  math::Mat3 mirrored = math::Mat3::Identity();
  mirrored(2, 2) = -1;
  Obedient device(mirrored);
  const TrialMeasurements seen = tried(device);
  EXPECT_LT(seen.axes[0].off_deg, 1);
  EXPECT_LT(seen.axes[1].off_deg, 1);
  EXPECT_NEAR(seen.axes[2].off_deg, 180, 1);
  EXPECT_NE(trial_text(seen).find("mirrored"), std::string::npos);
}

TEST(Trial, WhatWasNotDoneIsNamed) {
  Obedient device(math::Mat3::Identity());
  const TrialMeasurements seen = try_device(
      device, {.rest_s = 0.05, .longest_s = 0.05}, [](const std::string&) {}, [] { return false; });
  EXPECT_EQ(seen.left_out.size(), 4U);
  EXPECT_FALSE(seen.axes[0].done);
  EXPECT_EQ(device.most, 0);
}

TEST(Trial, ThePageHoldsNoMarkupFromTheDevice) {
  TrialMeasurements seen;
  seen.spec.name = "<script>";
  EXPECT_EQ(trial_page(seen).find("<script>"), std::string::npos);
  EXPECT_NE(trial_page(seen).find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(trial_json(seen))["device"], "<script>");
}

}  // namespace
}  // namespace burr::app
