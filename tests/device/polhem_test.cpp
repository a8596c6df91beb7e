// A Polhem against one that the test plays on a pseudo terminal (fake/fake_polhem.h).
#include "burr/device/polhem/polhem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "device/fake/fake_polhem.h"
#include "device/stand_in.h"
#include "device/wild_forces.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::device::polhem {
namespace {

using math::Quat;
using math::Vec3;
using test::FakePolhem;
using test::soon;
using Commands = FakePolhem::Commands;

class PolhemTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<WireDevice> device(
      double loss_timeout = test::kStallsAllowed) const {
    LinkSettings link;
    link.loss_timeout = loss_timeout;
    return std::make_unique<WireDevice>(
        std::make_unique<Polhem>(PolhemSettings{.port = arm_.path, .system = "/nowhere"}), link);
  }
  [[nodiscard]] PolhemSettings here() const { return {.port = arm_.path, .system = "/nowhere"}; }
  static HandState next(Polhem& wire, const Vec3& force = Vec3::Zero()) {
    HandState hand;
    Wire::Read read = Wire::Read::nothing;
    EXPECT_TRUE(soon([&] {
      read = wire.read(hand);
      if (read == Wire::Read::nothing) static_cast<void>(wire.write(force));
      return read != Wire::Read::nothing;
    }));
    EXPECT_EQ(read, Wire::Read::hand) << wire.why();
    EXPECT_TRUE(wire.write(force));
    return hand;
  }
  FakePolhem arm_;
};

TEST_F(PolhemTest, SaysWhatItIsAndWhatItCanBear) {
  const auto arm = device();
  const Status opened = arm->open();
  ASSERT_TRUE(opened.ok()) << opened.error().text;
  EXPECT_EQ(arm->spec().name, "Polhem");
  EXPECT_EQ(arm->spec().serial, arm_.path);
  EXPECT_EQ(arm->spec().peak_force, 5);
  EXPECT_EQ(arm->spec().max_stiffness, 2000);
  EXPECT_EQ(arm->trouble(), "");
}

// The arm: x to the user, y right, z up; ours: x right, y up, z to the user.
TEST_F(PolhemTest, TenMillimetresAndANewtonAreThoseAlongEveryAxis) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  const Vec3 ways[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};  // ours, for its x, y, z
  for (int axis = 0; axis < 3; ++axis) {
    arm_.with([&](Commands& w) {
      for (int other = 0; other < 3; ++other) w.mm[other] = other == axis ? 10 : 0;
    });
    HandState hand;
    EXPECT_TRUE(soon([&] {
      hand = next(wire, 1.5 * ways[axis]);
      return (hand.world_from_tool.p - 0.01 * ways[axis]).norm() < 1e-12;
    })) << hand.world_from_tool.p.transpose();
    EXPECT_TRUE(soon([&] {
      next(wire, 1.5 * ways[axis]);
      return (arm_.force() - 1.5 * Vec3(Vec3::Unit(axis))).norm() < 1e-9;
    })) << arm_.force().transpose();
  }
  EXPECT_EQ(arm_.with([](Commands& w) { return w.odd; }), 0U) << "each line has 64 bytes";
}

TEST_F(PolhemTest, AForceIsOnTheWireWithTheNextLine) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  next(wire);
  const std::uint64_t before = arm_.with([](Commands& w) { return w.lines; });
  HandState hand;
  ASSERT_TRUE(soon([&] { return wire.read(hand) == Wire::Read::hand; }));
  ASSERT_TRUE(wire.write({0, 2, 0}));
  ASSERT_TRUE(soon([&] { return arm_.force().z() == 2; }));
  EXPECT_LE(arm_.with([](Commands& w) { return w.lines; }) - before, 2U);
}

TEST_F(PolhemTest, TheHandleIsTheStylus) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_NEAR((next(wire).world_from_tool.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-12)
      << "straight to the user";
  const auto handle = [&](double tA, double lambda, double tD, double tE) {
    arm_.with([&](Commands& w) {
      w.turns[0] = tA;
      w.turns[1] = lambda;
      w.turns[2] = tD;
      w.turns[3] = tE;
    });
    for (int n = 0; n < 3; ++n) next(wire);
    return Vec3(next(wire).world_from_tool.q * Vec3::UnitZ());
  };
  // a quarter turn about its z, up: from its x to its y, our right
  EXPECT_NEAR((handle(1.5708, 0, 0, 0) - Vec3::UnitX()).norm(), 0, 1e-4);
  // lambda lifts it: about y in the negative direction, its x to its z, our up
  EXPECT_NEAR((handle(0, 1.5708, 0, 0) - Vec3::UnitY()).norm(), 0, 1e-4);
  // tE lowers it, after tD has turned that to one side: -z rotated about x by a quarter is y, our
  // right
  EXPECT_NEAR((handle(0, 0, 0, 1.5708) + Vec3::UnitY()).norm(), 0, 1e-4);
  EXPECT_NEAR((handle(0, 0, 1.5708, 1.5708) - Vec3::UnitX()).norm(), 0, 1e-4);
}

TEST_F(PolhemTest, WhatIsNoArmIsSaidWithItsRemedy) {
  const auto refusal = [](const PolhemSettings& settings) {
    Polhem wire(settings);
    const auto found = wire.connect();
    return found.ok() ? "it connected" : found.error().text;
  };
  EXPECT_NE(refusal({.system = "/nowhere"}).find("no Polhem is plugged in"), std::string::npos);
  EXPECT_NE(refusal({.port = "/dev/none"}).find("cannot be opened"), std::string::npos);
  EXPECT_NE(refusal({.port = "/dev/zero"}).find("is not a serial port"), std::string::npos);
  arm_.with([](Commands& w) { w.silent = true; });
  EXPECT_NE(refusal(here()).find("does not answer"), std::string::npos);
  arm_.with([](Commands& w) {
    w.silent = false;
    w.instead.assign(1000, "hello, I am a thermometer: 21.5\n");
  });
  EXPECT_NE(refusal(here()).find("does not answer as a Polhem"), std::string::npos);
}

TEST_F(PolhemTest, OnlyOneMayHoldIt) {
  Polhem one(here());
  ASSERT_TRUE(one.connect().ok());
  Polhem two(here());
  const auto found = two.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("another program"), std::string::npos) << found.error().text;
  one.disconnect();
  EXPECT_TRUE(two.connect().ok());
}

TEST_F(PolhemTest, ARunningSessionPushesAndLetsGo) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState& hand) {
    return Vec3(0, -400 * std::min(0.0, hand.world_from_tool.p.y()), 0);
  });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  arm_.with([](Commands& w) { w.mm[2] = -5; });
  EXPECT_TRUE(soon([&] { return arm_.force().z() > 1.9; })) << "up in its frame";
  tick.stop();
  arm->close();
  EXPECT_TRUE(soon([&] { return arm_.force() == Vec3::Zero(); }));
  EXPECT_EQ(arm_.with([](Commands& w) { return w.odd; }), 0U);
}

TEST_F(PolhemTest, UnpluggedInContactItIsLostInWords) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*arm, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(soon([&] { return arm_.force().norm() > 1.9; }));
  arm_.unplug();
  ASSERT_TRUE(soon([&] { return tick.invalid() > 0; }));
  EXPECT_TRUE(soon([&] { return !arm->trouble().empty(); }));
  EXPECT_FALSE(tick.engaged());
}

TEST_F(PolhemTest, ASilentArmIsSoughtAgainAndComesBackByTheRamp) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*arm, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(soon([&] { return arm_.force().norm() > 1.9; }));
  arm_.with([](Commands& w) { w.silent = true; });
  ASSERT_TRUE(soon([&] {
    return arm->trouble().find("silent") != std::string::npos ||
           arm->trouble().find("answer") != std::string::npos;
  }));
  arm_.with([](Commands& w) { w.silent = false; });
  ASSERT_TRUE(soon([&] { return arm->reconnections() == 1; })) << arm->trouble();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(arm_.force(), Vec3::Zero()) << "the wall is still there: it waits for a small force";
  wall = false;
  EXPECT_TRUE(soon([&] { return tick.engaged(); }));
}

TEST_F(PolhemTest, AStallOf50MsIsALostHandAndNotALostArm) {
  const auto arm = device(5e-3);
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return arm_.force().norm() > 0.03; }));
  arm_.with([](Commands& w) { w.stall_ms = 50; });
  EXPECT_TRUE(soon([&] { return (tick.flags() & rt::kFlagHandLost) != 0; }));
  EXPECT_TRUE(soon([&] { return tick.hand().valid && arm_.force().norm() > 0.03; }));
  EXPECT_EQ(arm->reconnections(), 0);
}

TEST_F(PolhemTest, AtAHundredHertzNothingIsHeldOver) {
  const auto arm = device(5e-3);
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return arm_.force().norm() > 0.03; }));
  arm_.with([](Commands& w) { w.rate_hz = 100; });
  EXPECT_TRUE(soon([&] { return tick.invalid() > 20 && arm_.force().norm() < 0.03; }));
}

TEST_F(PolhemTest, ALineThatWasLostIsSaidAgain) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  next(wire);
  arm_.with([](Commands& w) { w.swallow = true; });
  for (int n = 0; n < 20; ++n) next(wire);
  EXPECT_EQ(wire.why(), "");
}

TEST_F(PolhemTest, PiecesAndNonsenseAreBorneALotOfItIsNot) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  arm_.with([](Commands& w) {
    w.pieces = true;
    w.mm[0] = 12;
  });
  for (int n = 0; n < 20; ++n) next(wire);
  EXPECT_NEAR(next(wire).world_from_tool.p.z(), 0.012, 1e-12);
  arm_.with([](Commands& w) {
    w.pieces = false;
    w.instead = {"nan 0 0 0 0 0 0 0\n",
                 "inf 0 0 0 0 0 0 0\n",
                 "1 2 3\n",
                 "\n",
                 "9999 0 0 0 0 0 0 0\n",
                 "0 0 0 99 0 0 0 0\n",
                 "0 0 0 0 0 0 0 0 0\n",
                 "0 0 0 0 0 0 0 x\n",
                 std::string(2000, '7'),
                 "\n"};
  });
  for (int n = 0; n < 20; ++n) {
    const HandState hand = next(wire);
    EXPECT_NEAR(hand.world_from_tool.p.z(), 0.012, 1e-12) << "only what was sound";
  }
  arm_.with([](Commands& w) { w.instead.assign(400, "no\n"); });
  HandState hand;
  Wire::Read read = Wire::Read::hand;
  ASSERT_TRUE(soon([&] {
    read = wire.read(hand);
    static_cast<void>(wire.write(Vec3::Zero()));
    return read == Wire::Read::lost;
  }));
}

TEST_F(PolhemTest, OfManyRandomForcesNonePassesTheLimit) {
  Polhem wire(here());
  ASSERT_TRUE(wire.connect().ok());
  const unsigned seed = std::random_device{}();
  test::WildForces forces(seed);
  test::push_wildly(wire, test::forces_on_a_wire(), forces);
  const double largest = arm_.with([](Commands& w) { return w.largest; });
  EXPECT_GT(largest, 4.9) << "seed " << seed;
  EXPECT_LE(largest, 5 + 1e-3) << "rounded to millinewtons; seed " << seed;
}

TEST_F(PolhemTest, OpenedAndClosedManyTimesNothingIsLeft) {
  const int rounds = test::rounds();
  const int before = test::open_files();
  for (int n = 0; n < rounds; ++n) {
    Polhem wire(here());
    const auto found = wire.connect();
    ASSERT_TRUE(found.ok()) << n << ": " << found.error().text;
  }
  EXPECT_EQ(test::open_files(), before);
  EXPECT_EQ(arm_.force(), Vec3::Zero());
}

TEST_F(PolhemTest, TwoAtOnceEachHasItsOwnForce) {
  FakePolhem other;
  Polhem one(here()), two({.port = other.path, .system = "/nowhere"});
  ASSERT_TRUE(one.connect().ok());
  ASSERT_TRUE(two.connect().ok());
  EXPECT_TRUE(soon([&] {
    next(one, {1, 0, 0});
    next(two, {0, 0, 1});
    return arm_.force() == Vec3(0, 1, 0) && other.force() == Vec3(1, 0, 0);
  }));
}

TEST(PolhemPorts, AreFoundByWhatTheirUsbSays) {
  namespace fs = std::filesystem;
  const test::Folder folder;
  const fs::path root = folder / "root";
  const auto put = [&](const char* name, const char* vendor, const char* product) {
    const fs::path device = root / "sys/devices/usb1" / name, face = device / "1-1:1.0";
    fs::create_directories(face / "tty" / name);
    fs::create_directories(root / "sys/class/tty");
    std::ofstream(device / "idVendor") << vendor << "\n";
    std::ofstream(device / "idProduct") << product << "\n";
    std::ofstream(device / "serial") << "S-" << name << "\n";
    fs::create_directory_symlink(face / "tty" / name, root / "sys/class/tty" / name);
    fs::create_directory_symlink(face, face / "tty" / name / "device");
  };
  put("ttyACM1", "16c0", "0483");
  put("ttyACM0", "2341", "0043");
  put("ttyACM3", "16c0", "05df");
  put("ttyACM2", "16c0", "0486");
  const auto ports = ports_of_arms(root.string());
  ASSERT_EQ(ports.size(), 2U);
  EXPECT_EQ(ports[0].path, (root / "dev/ttyACM1").string());
  EXPECT_EQ(ports[0].serial, "S-ttyACM1");
  EXPECT_EQ(ports[1].serial, "S-ttyACM2");
  fs::remove_all(root);
  EXPECT_TRUE(ports_of_arms(root.string()).empty());
}

// ---- lines

TEST(PolhemLine, IsTheMakersByteForByte) {
  const Line line = force_line({1.5, -0.25, 2});
  std::string expected = "1500 -250 2000 2 0 0 0";
  expected.resize(63, ' ');
  EXPECT_EQ(std::string(line.data(), line.size()), expected + "\n");
  State state;
  ASSERT_TRUE(read_line(" -59.276   13.383 -148.002   0.0919 -1.8483  1.0370 -1.9512 0", state));
  EXPECT_NEAR((state.place - Vec3(-0.059276, 0.013383, -0.148002)).norm(), 0, 1e-12);
  EXPECT_EQ(state.tA, 0.0919);
  EXPECT_EQ(state.lambda, -1.8483);
  EXPECT_EQ(state.tD, 1.0370);
  EXPECT_EQ(state.tE, -1.9512);
}

TEST(PolhemLine, WhateverComesInWhateverPiecesIsSoundOrNothing) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  const std::string good = "  10.000   20.000  -30.000  0.1000  0.2000 -0.3000  0.4000 0\n";
  Lines lines;
  State state;
  int nonsense = 0, found = 0;
  const test::RtGuard guard;
  for (int n = 0; n < 200'000; ++n) {
    char text[80];
    std::size_t size = std::min(good.size(), sizeof text);
    std::copy_n(good.data(), size, text);
    if (random() % 3 == 0)
      for (unsigned cuts = 1 + random() % 4; cuts > 0; --cuts)
        text[random() % size] = static_cast<char>(random() % 256);
    if (random() % 5 == 0) size = random() % size;
    const std::size_t part = std::min<std::size_t>(size, random() % 80);
    for (const auto& [from, count] :
         {std::pair<std::size_t, std::size_t>{0, part}, {part, size - part}}) {
      if (count > lines.left()) lines.clear();
      std::copy_n(text + from, count, lines.room());
      if (!lines.take(count, state, nonsense)) continue;
      ++found;
      ASSERT_TRUE(state.place.allFinite() && state.place.cwiseAbs().maxCoeff() <= 1 &&
                  std::isfinite(state.tA + state.lambda + state.tD + state.tE))
          << "seed " << seed;
    }
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_GT(found, 50'000) << "seed " << seed;
  EXPECT_GT(nonsense, 10'000) << "seed " << seed;
}

}  // namespace
}  // namespace burr::device::polhem
