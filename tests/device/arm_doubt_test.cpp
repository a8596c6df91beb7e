// Messages of a Polhem or a CRTK arm that must not be believed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "device/players/every.h"
#include "device/stand_in.h"
#include "support/folder.h"

namespace burr::device {
namespace {

using math::Vec3;
using test::soon;

TEST(PolhemDoubt, LinesThatAreNoneAreBorneForAMomentOnly) {
  test::FakePolhem arm;
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  ASSERT_TRUE(wire.connect().ok());
  arm.with([](test::FakePolhem::Commands& commands) { commands.instead.assign(100, "no\n"); });
  HandState hand;
  int good = 0;
  ASSERT_TRUE(soon([&] {
    const Wire::Read read = wire.read(hand);
    if (read == Wire::Read::hand) ++good;
    static_cast<void>(wire.write(Vec3::Zero()));
    return read == Wire::Read::lost || good > 10;
  }));
  EXPECT_NE(wire.why().find("cannot read"), std::string::npos) << wire.why();
}

// A field of the arm holds 16 bits of millinewtons; a larger number would wrap around.
TEST(PolhemDoubt, ALineAsksForNoMoreThanItsFieldsHold) {
  for (const double newton : {33.0, 1e6, 1e300, std::numeric_limits<double>::infinity()}) {
    const polhem::Line line = polhem::force_line({newton, -newton, 0.5});
    const std::string text(line.data(), line.size());
    const bool finite = std::isfinite(newton);
    EXPECT_TRUE(text.starts_with(finite ? "32000 -32000 500 2 0 0 0 " : "0 0 500 2 0 0 0 "))
        << text;
    EXPECT_EQ(text.find('\n'), text.size() - 1);
  }
}

// The arm reports no velocity; it is computed from the change of its position.
TEST(PolhemDoubt, ItsSpeedGoesTheWayItGoes) {
  test::FakePolhem arm;
  arm.with([](test::FakePolhem::Commands& commands) { commands.rate_hz = 1000; });
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  ASSERT_TRUE(wire.connect().ok());
  HandState hand;
  for (int axis = 0; axis < 3; ++axis)
    for (const double way : {1.0, -1.0}) {
      for (int readings = 0; readings < 20;) {
        const Wire::Read read = wire.read(hand);
        ASSERT_NE(read, Wire::Read::lost) << wire.why();
        if (read == Wire::Read::hand) ++readings;
        arm.with([&](test::FakePolhem::Commands& commands) { commands.mm[axis] += 0.1 * way; });
        ASSERT_TRUE(wire.write(Vec3::Zero()));
      }
      const int ours = (axis + 2) % 3;  // its x is our z, its y our x
      EXPECT_GT(way * hand.velocity[ours], 1e-3) << hand.velocity.transpose();
      EXPECT_LT(way * hand.velocity[ours], 1) << "some tenths of a millimetre in a millisecond";
    }
}

// burr and the arm stand still; meanwhile the guardian sends lines, and the arm answers late.
// burr's lines must not stay behind those of the guardian for ever. Returns how many readings a
// force took afterwards; nothing if the machine stood still for longer than that and the arm was
// lost.
std::optional<int> late_after_a_stall() {
  test::FakePolhem arm;
  arm.with([](test::FakePolhem::Commands& commands) { commands.rate_hz = 1000; });
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  if (!wire.connect()) return std::nullopt;
  HandState hand;
  const auto readings = [&](int count, const Vec3& force) {
    for (int n = 0; n < count;) {
      const Wire::Read read = wire.read(hand);
      if (read == Wire::Read::lost || !wire.write(force)) return false;
      if (read == Wire::Read::hand) ++n;
    }
    return true;
  };
  const auto lines = [&] {
    return arm.with([](test::FakePolhem::Commands& commands) { return commands.lines; });
  };
  if (!readings(20, Vec3::Zero())) return std::nullopt;
  const std::uint64_t before = lines();
  arm.with([](test::FakePolhem::Commands& commands) { commands.stall_ms = 150; });
  std::this_thread::sleep_for(std::chrono::milliseconds(140));
  if (!readings(20, Vec3::Zero())) return std::nullopt;
  EXPECT_TRUE(soon([&] { return lines() > before + 10; })) << "the guardian's";
  int late = 0;
  for (; late < 100 && arm.force().y() != 1; ++late)
    if (!readings(1, late < 60 ? Vec3(0.5, 0, 0) : Vec3(1, 0, 0))) return std::nullopt;
  return late - 60;
}

TEST(PolhemDoubt, AForceIsNotLateForEverAfterAStall) {
  std::optional<int> late;  // a busy machine may stand still in a try; a fault shows in all of them
  for (int tries = 0; tries < 10 && (!late || *late > 3); ++tries)
    if (const auto found = late_after_a_stall()) late = found;
  ASSERT_TRUE(late);
  EXPECT_GT(*late, 0);
  EXPECT_LE(*late, 3);
}

// The arm keeps its last force: that must not be the force of the moment when it fell silent.
TEST(PolhemDoubt, WithoutAnAnswerItIsToldNoForce) {
  test::FakePolhem arm;
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  ASSERT_TRUE(wire.connect().ok());
  HandState hand;
  const auto pushed_until = [&](double newton) {
    return soon([&] {
      static_cast<void>(wire.read(hand));
      static_cast<void>(wire.write(Vec3(1, 0, 0)));
      return arm.force() == Vec3(0, newton, 0);
    });
  };
  ASSERT_TRUE(pushed_until(1));
  arm.with([](test::FakePolhem::Commands& commands) { commands.silent = true; });
  EXPECT_TRUE(pushed_until(0));
  arm.with([](test::FakePolhem::Commands& commands) { commands.silent = false; });
  EXPECT_TRUE(pushed_until(1)) << "once it answers again";
}

// Its guardian has the port open too: if opening fails, both must close it.
TEST(PolhemDoubt, UnpluggedWhileItIsOpenedNothingIsLeftOpen) {
  const int before = test::open_files();
  const test::Folder folder;
  const std::filesystem::path slow = folder / "slow_guard.sh";
  std::ofstream(slow) << "#!/bin/sh\nsleep 0.3\nprintf +\ncat >&2\n";
  std::filesystem::permissions(slow, std::filesystem::perms::owner_all);
  ::setenv("BURR_GUARD", slow.c_str(), 1);
  test::FakePolhem arm;
  polhem::Polhem wire({.port = arm.path, .system = "/nowhere"});
  std::thread user([&] {
    static_cast<void>(
        soon([&] { return arm.with([](auto& commands) { return commands.lines; }) > 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    arm.unplug();
  });
  const auto connected = wire.connect();
  user.join();
  ::unsetenv("BURR_GUARD");
  EXPECT_FALSE(connected.ok());
  EXPECT_EQ(test::open_files(), before);
}

// An arm is lost when nobody reads the forces that are written to it.
TEST(CrtkDoubt, AnArmThatTakesForcesNoMoreIsNotBelieved) {
  const int domain = test::quiet_domain();
  test::FakeCrtkArm arm(domain);
  crtk::Leader wire({.arm = "/arm", .domain = domain});
  ASSERT_TRUE(wire.connect().ok());
  HandState hand;
  const auto next = [&] {
    const Wire::Read read = wire.read(hand);
    static_cast<void>(wire.write(Vec3::Zero()));
    return read == Wire::Read::hand;
  };
  ASSERT_TRUE(soon([&] { return next() && hand.valid; }));
  arm.with([](test::FakeCrtkArm::Commands& commands) { commands.deaf = true; });
  EXPECT_TRUE(soon([&] { return next() && !hand.valid; }));
  EXPECT_NE(wire.why().find("no longer takes forces"), std::string::npos) << wire.why();
}

}  // namespace
}  // namespace burr::device
