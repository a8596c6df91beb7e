// Haply's arm against a service that the test plays (fake/fake_haply.h), over the loopback as the
// real one.
#include "burr/device/haply/inverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "burr/device/haply/message.h"
#include "burr/haptics/contact.h"
#include "device/fake/fake_haply.h"
#include "device/stand_in.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using test::FakeHaply;
using test::soon;
using Wishes = FakeHaply::Wishes;

class InverseTest : public ::testing::Test {
 protected:
  [[nodiscard]] InverseSettings here(const std::string& id = {}) const {
    return {.host = "127.0.0.1", .port = service_.port, .id = id};
  }
  [[nodiscard]] std::unique_ptr<WireDevice> device(
      const std::string& id = {}, double loss_timeout = test::kStallsAllowed) const {
    LinkSettings link;
    link.loss_timeout = loss_timeout;
    return std::make_unique<WireDevice>(std::make_unique<Inverse>(here(id)), link);
  }
  // One exchange on a wire by hand; waits for the reading.
  static HandState exchange(Inverse& wire, const Vec3& force = Vec3::Zero()) {
    HandState hand;
    Wire::Read read = Wire::Read::nothing;
    EXPECT_TRUE(soon([&] { return (read = wire.read(hand)) != Wire::Read::nothing; }));
    EXPECT_EQ(read, Wire::Read::hand);
    EXPECT_TRUE(wire.write(force));
    return hand;
  }
  Vec3 asked(std::size_t arm = 0) {
    return service_.with([&](Wishes& w) { return w.arms[arm].force; });
  }

  FakeHaply service_;
};

TEST_F(InverseTest, SaysWhatItIsAndWhatItCanBear) {
  for (const auto& [type, peak] :
       {std::pair{"inverse3", 8.0}, {"inverse3x", 8.0}, {"minverse", 3.0}, {"new", 3.0}}) {
    service_.with([&, type = type](Wishes& w) { w.arms[0].type = type; });
    const auto arm = device();
    const Status opened = arm->open();
    ASSERT_TRUE(opened.ok()) << opened.error().text;
    EXPECT_EQ(arm->spec().name, type);
    EXPECT_EQ(arm->spec().serial, "049D");
    EXPECT_EQ(arm->spec().peak_force, peak);
    EXPECT_EQ(arm->spec().sensed, 6);
    EXPECT_FALSE(arm->spec().simulated);
    EXPECT_EQ(arm->trouble(), "");
  }
}

// Theirs is x right, y forward, z up; ours x right, y up, z to the user.
TEST_F(InverseTest, TenMillimetresAndANewtonAreThoseAlongEveryAxis) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  for (const auto& [theirs, ours] : {std::pair<Vec3, Vec3>{{1, 0, 0}, {1, 0, 0}},
                                     {{0, 1, 0}, {0, 0, -1}},
                                     {{0, 0, 1}, {0, 1, 0}}}) {
    service_.with([&, way = theirs](Wishes& w) {
      w.arms[0].place = 0.01 * way;
      w.arms[0].velocity = 0.2 * way;
    });
    exchange(wire);
    const HandState hand = exchange(wire, ours);
    EXPECT_TRUE(hand.valid);
    EXPECT_NEAR((hand.world_from_tool.p - 0.01 * ours).norm(), 0, 1e-12);
    EXPECT_NEAR((hand.velocity - 0.2 * ours).norm(), 0, 1e-12);
    exchange(wire, Vec3::Zero());  // its answer shows that the force before has come
  }
  exchange(wire, {0.5, 1, 2});
  ASSERT_TRUE(soon([&] { return asked().norm() > 1; }));
  EXPECT_NEAR((asked() - Vec3(0.5, -2, 1)).norm(), 0, 1e-4);
}

TEST_F(InverseTest, TheHandleIsTheGripsBackAndItsButtonsMillAndLift) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  HandState hand = exchange(wire);
  // it points forward, away from the user: the handle comes to the user
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-12);
  // pointing down, a quarter turn about x: y to -z
  service_.with([](Wishes& w) {
    w.orientation = Quat(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()));
    w.buttons = 5;
  });
  exchange(wire);
  hand = exchange(wire);
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-9)
      << "the handle stands up";
  EXPECT_EQ(hand.buttons, 5U);
  service_.with([](Wishes& w) {
    w.names_of_buttons = "button_";
    w.buttons = 2;
  });
  exchange(wire);
  hand = exchange(wire);
  EXPECT_EQ(hand.buttons & 2U, 2U);
}

TEST_F(InverseTest, WithoutAGripTheToolStandsUpright) {
  service_.with([](Wishes& w) { w.grip = false; });
  Inverse wire(here());
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok());
  EXPECT_EQ(spec->sensed, 3);
  const HandState hand = exchange(wire);
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-12);
}

// 3.5 takes "vector", before it was "values"; where the version lies, or is not told, what comes
// back decides.
TEST_F(InverseTest, TheSpellingOfAForceIsTheOneThatIsObeyed) {
  for (const auto& [version, key] : {std::pair{"3.5.0", "vector"},
                                     {"3.1.2", "values"},
                                     {"v3.4", "values"},
                                     {"4.0", "vector"},
                                     {"", "values"},
                                     {"", "vector"},
                                     {"3.5.1", "values"}}) {
    service_.with([&, version = version, key = key](Wishes& w) {
      w.version = version;
      w.key = key;
    });
    Inverse wire(here());
    ASSERT_TRUE(wire.connect().ok());
    exchange(wire, {1, 0, 0});
    EXPECT_TRUE(soon([&] { return asked().x() > 0.9; })) << version << " " << key;
  }
}

TEST_F(InverseTest, FindingTheSpellingIsNotFelt) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_LE(service_.with([](Wishes& w) { return w.arms[0].largest; }), 0.021);
}

TEST_F(InverseTest, WhatIsLeftOutIsAsItWas) {
  service_.with([](Wishes& w) {
    w.leaves_out = true;
    w.arms[0].place = {0.02, 0, 0};
  });
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  EXPECT_NEAR(exchange(wire).world_from_tool.p.x(), 0.02, 1e-12);
  service_.with([](Wishes& w) { w.arms[0].place.setZero(); });
  exchange(wire);
  EXPECT_NEAR(exchange(wire).world_from_tool.p.x(), 0.02, 1e-12);
}

TEST_F(InverseTest, AServiceThatIsNotThereIsSaidWithItsPlace) {
  Inverse wire({.host = "127.0.0.1", .port = 1});
  const auto found = wire.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("127.0.0.1:1"), std::string::npos) << found.error().text;
  EXPECT_NE(found.error().text.find("HAPLY_WS_PORT"), std::string::npos);
}

TEST_F(InverseTest, NoArmAndAnotherArmAreSaid) {
  {
    Inverse wire(here("AAAA"));
    const auto found = wire.connect();
    ASSERT_FALSE(found.ok());
    EXPECT_NE(found.error().text.find("AAAA"), std::string::npos);
    EXPECT_NE(found.error().text.find("049D"), std::string::npos);
  }
  service_.with([](Wishes& w) { w.arms.clear(); });
  Inverse wire(here());
  const auto found = wire.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("plug it in"), std::string::npos) << found.error().text;
}

TEST_F(InverseTest, AStrangersSocketIsNoService) {
  service_.with([](Wishes& w) { w.silent = true; });
  Inverse wire(here());
  const auto found = wire.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("does not answer"), std::string::npos) << found.error().text;
}

TEST_F(InverseTest, FragmentsAndPingsChangeNothing) {
  service_.with([](Wishes& w) {
    w.fragments = w.pings = true;
    w.arms[0].place = {0.01, 0.02, 0.03};
  });
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  EXPECT_TRUE(soon([&] { return tick.ticks() > 200 && asked().norm() > 0.03; }));
  EXPECT_NEAR((tick.hand().world_from_tool.p - Vec3(0.01, 0.03, -0.02)).norm(), 0, 1e-12);
}

TEST_F(InverseTest, ARunningSessionPushesAndLetsGo) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState& hand) {
    return Vec3(0, -400 * std::min(0.0, hand.world_from_tool.p.y()), 0);
  });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  service_.with([](Wishes& w) { w.arms[0].place.z() = -5e-3; });
  EXPECT_TRUE(soon([&] { return asked().z() > 1.9; })) << "up in its frame";
  tick.stop();
  arm->close();
  EXPECT_TRUE(soon([&] { return asked() == Vec3::Zero(); }));
  EXPECT_EQ(service_.unreadable, 0);
}

TEST_F(InverseTest, UnpluggedInContactItLetsGoAndComesBackByTheRamp) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*arm, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(soon([&] { return asked().norm() > 1.9; }));
  FakeHaply::Arm kept;
  service_.with([&](Wishes& w) {
    kept = w.arms[0];
    w.arms.clear();
  });
  ASSERT_TRUE(soon([&] { return tick.invalid() > 0; }));
  ASSERT_TRUE(soon([&] { return arm->trouble().find("plug") != std::string::npos; }))
      << arm->trouble();
  kept.force.setZero();
  service_.with([&](Wishes& w) { w.arms = {kept}; });
  ASSERT_TRUE(soon([&] { return arm->returns() == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_LE(asked().norm(), 0.021) << "the wall is still there: it waits for a small force";
  EXPECT_FALSE(tick.engaged());
  wall = false;
  EXPECT_TRUE(soon([&] { return tick.engaged(); }));
}

TEST_F(InverseTest, AServiceThatHangsUpOrFallsSilentIsSoughtAgain) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return asked().norm() > 0.03; }));
  service_.drop();
  ASSERT_TRUE(soon([&] { return arm->returns() == 1; }));
  ASSERT_TRUE(soon([&] { return tick.hand().valid; }));
  service_.with([](Wishes& w) { w.silent = true; });
  ASSERT_TRUE(soon([&] { return arm->trouble().find("Inverse Service") != std::string::npos; }));
  service_.with([](Wishes& w) { w.silent = false; });
  EXPECT_TRUE(soon([&] { return arm->returns() == 2; }));
}

TEST_F(InverseTest, AStallOf50MsIsALostHandAndNotALostService) {
  const auto arm = device({}, 5e-3);
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return asked().norm() > 0.03; }));
  service_.with([](Wishes& w) { w.stall_ms = 50; });
  EXPECT_TRUE(soon([&] { return (tick.flags() & haptics::kFlagHandLost) != 0; }));
  EXPECT_TRUE(soon([&] { return tick.hand().valid && asked().norm() > 0.03; }));
  EXPECT_EQ(arm->returns(), 0);
}

TEST_F(InverseTest, AnArmThatIsNotReadyIsNotBelievedAndSaysWhy) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3::Zero(); });
  ASSERT_TRUE(soon([&] { return tick.hand().valid; }));
  service_.with([](Wishes& w) { w.arms[0].calibrated = false; });
  EXPECT_TRUE(soon([&] { return !tick.hand().valid; }));
  EXPECT_TRUE(soon([&] { return arm->trouble().find("calibrated") != std::string::npos; }));
  service_.with([](Wishes& w) {
    w.arms[0].calibrated = true;
    w.arms[0].powered = false;
  });
  EXPECT_TRUE(soon([&] { return arm->trouble().find("power") != std::string::npos; }));
  service_.with([](Wishes& w) { w.arms[0].powered = true; });
  EXPECT_TRUE(soon([&] { return tick.hand().valid && arm->trouble().empty(); }));
}

TEST_F(InverseTest, OneNonsenseIsBorneManyAreNot) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  service_.with([](Wishes& w) {
    w.instead = {"{",
                 R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":"1"}}}]})",
                 R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999}}}]})"};
  });
  int nonsense = 0;
  for (int n = 0; n < 6; ++n) nonsense += exchange(wire).valid ? 0 : 1;
  EXPECT_EQ(nonsense, 3);
  EXPECT_TRUE(exchange(wire).valid);
  service_.with([](Wishes& w) { w.instead.assign(200, "[]"); });
  HandState hand;
  Wire::Read read = Wire::Read::hand;
  for (int n = 0; n < 400 && read != Wire::Read::lost; ++n) {
    read = wire.read(hand);
    static_cast<void>(wire.write(Vec3::Zero()));
  }
  EXPECT_EQ(read, Wire::Read::lost);
  EXPECT_NE(wire.why().find("cannot be read"), std::string::npos) << wire.why();
}

TEST_F(InverseTest, TwoAtOnceEachHasItsOwnForce) {
  service_.with([](Wishes& w) {
    w.arms.push_back({});
    w.arms[1].id = "B\"2";
  });
  const auto one = device("049D"), two = device("B\"2");
  ASSERT_TRUE(one->open().ok());
  ASSERT_TRUE(two->open().ok());
  test::StandIn first(*one, [](const HandState&) { return Vec3(0.04, 0, 0); });
  test::StandIn second(*two, [](const HandState&) { return Vec3(0, 0.03, 0); });
  EXPECT_TRUE(soon([&] {
    return std::abs(asked(0).x() - 0.04) < 1e-4 && std::abs(asked(1).z() - 0.03) < 1e-4;
  }));
  EXPECT_NEAR(asked(0).z(), 0, 1e-9);
}

TEST_F(InverseTest, AMillionForcesAndNonePassesTheLimit) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < test::kForcesOnAWire; ++n) {
    Vec3 force = std::pow(10, 4 * any(random)) * Vec3(any(random), any(random), any(random));
    if (n % 50 == 7) force.x() = std::numeric_limits<double>::quiet_NaN();
    if (n % 50 == 8) force.y() = std::numeric_limits<double>::infinity();
    exchange(wire, force);
  }
  const double largest = service_.with([](Wishes& w) { return w.arms[0].largest; });
  EXPECT_GT(largest, 7.9) << "seed " << seed;
  EXPECT_LE(largest, 8 + 1e-4) << "seed " << seed;
}

TEST_F(InverseTest, AThousandTimesOpenedAndClosedNothingIsLeft) {
  for (int n = 0; n < 1000; ++n) {
    Inverse wire(here());
    ASSERT_TRUE(wire.connect().ok()) << n;
  }
  EXPECT_EQ(service_.sessions, 1000);
}

// ---- messages

TEST(HaplyMessage, BrokenTextsAreNoStates) {
  FakeHaply service;
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::string whole =
      R"({"session_id":7,"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0.01,"y":-0.02,"z":0.03},)"
      R"("cursor_velocity":{"x":0,"y":0,"z":0}},"status":{"calibrated":true}}],"verse_grip":[{"state":{"orientation":)"
      R"({"w":1,"x":0,"y":0,"z":0},"buttons":{"a":true}}}]})";
  State known;
  ASSERT_EQ(read_state(whole, "049D", known), Read::state);
  EXPECT_EQ(known.place, Vec3(0.01, -0.02, 0.03));
  EXPECT_EQ(known.buttons, 1U);
  for (int n = 0; n < 20'000; ++n) {
    std::string text = whole;
    const auto cuts = 1 + random() % 4;
    for (unsigned k = 0; k < cuts; ++k) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0)
        text[at] = static_cast<char>(random() % 256);
      else
        text.erase(at, random() % 8);
      if (text.empty()) break;
    }
    State state;
    static_cast<void>(read_state(text, "049D", state));
    std::vector<Found> found;
    static_cast<void>(read_found(text, found));
    static_cast<void>(read_version(text));
    EXPECT_TRUE(state.place.allFinite() && state.velocity.allFinite() && state.force.allFinite())
        << "seed " << seed << ": " << text;
    EXPECT_NEAR(state.grip.norm(), 1, 1e-9) << "seed " << seed << ": " << text;
  }
}

TEST(HaplyMessage, VersionsAreToldApart) {
  EXPECT_EQ(read_version(R"({"project_version":"3.5.0"})"), 305);
  EXPECT_EQ(read_version(R"({"ok":true,"data":{"git_tag":"v3.10.2"}})"), 310);
  EXPECT_EQ(read_version(R"({"ok":false})"), 0);
  EXPECT_EQ(read_version("3.5"), 0);
  EXPECT_STREQ(key_of_force(305), "vector");
  EXPECT_STREQ(key_of_force(304), "values");
  EXPECT_STREQ(key_of_force(310), "vector");
}

}  // namespace
}  // namespace burr::device::haply
