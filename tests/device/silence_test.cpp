// A device that has fallen silent is lost within 0.2 s, whatever its wire. Counted in readings that
// did not come, each of which is awaited for 2 ms: a machine that stalls makes them fewer.
#include "burr/device/silence.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>

#include "device/players/every.h"
#include "device/stand_in.h"

namespace burr::device {
namespace {

constexpr int kReadings = 250;
constexpr std::int64_t kMs = 1'000'000;

TEST(Silence, IsWhatWasListenedToAndNotAMachineThatStoodStill) {
  Silence silence;
  std::int64_t now = 7'000 * kMs;
  silence.ended(now);
  const auto readings_until_lost = [&] {
    for (int nothing = 1;; ++nothing)
      if (silence.lasts(now += 2 * kMs)) return nothing;
  };
  EXPECT_EQ(readings_until_lost(), 100);
  silence.ended(now);
  now += 60'000 * kMs;
  EXPECT_FALSE(silence.lasts(now)) << "it stood still for a minute";
  EXPECT_EQ(readings_until_lost(), 95);
  for (int n = 0; n < 99; ++n) {
    silence.ended(now);
    EXPECT_FALSE(silence.lasts(now += 199 * kMs));
  }
}

// Runs until the device is lost; returns how many readings did not come.
int readings_until_lost(Wire& wire, const char* words) {
  HandState hand;
  for (int nothing = 0; nothing < 10 * kReadings;) {
    const Wire::Read read = wire.read(hand);
    if (read == Wire::Read::lost) {
      EXPECT_NE(wire.why().find(words), std::string::npos) << wire.why();
      return nothing;
    }
    if (read == Wire::Read::nothing) ++nothing;
    EXPECT_TRUE(wire.write(math::Vec3::Zero()));
  }
  return 10 * kReadings;
}

TEST(Silence, OfHaplysServiceIsALoss) {
  test::FakeHaply service;
  haply::Inverse wire({.host = "127.0.0.1", .port = service.port, .id = {}});
  ASSERT_TRUE(wire.connect().ok());
  service.with([](test::FakeHaply::Commands& commands) { commands.silent = true; });
  EXPECT_LE(readings_until_lost(wire, "silent"), kReadings);
}

TEST(Silence, OfAPolhemIsALoss) {
  test::FakePolhem arm;
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  ASSERT_TRUE(wire.connect().ok());
  arm.with([](test::FakePolhem::Commands& commands) { commands.silent = true; });
  EXPECT_LE(readings_until_lost(wire, "silent"), kReadings);
}

TEST(Silence, OfACrtkArmIsALoss) {
  const int domain = test::quiet_domain();
  test::FakeCrtkArm arm(domain);
  crtk::Leader wire({.arm = "/arm", .domain = domain});
  ASSERT_TRUE(wire.connect().ok());
  arm.with([](test::FakeCrtkArm::Commands& commands) { commands.silent = true; });
  EXPECT_LE(readings_until_lost(wire, "silent"), kReadings);
}

}  // namespace
}  // namespace burr::device
