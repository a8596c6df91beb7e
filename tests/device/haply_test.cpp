// Haply's arm against a service that the test plays (fake/fake_haply.h), over the loopback
// interface like the real one.
#include "burr/device/haply/inverse.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "burr/device/haply/message.h"
#include "burr/haptics/contact.h"
#include "burr/net/web_socket.h"
#include "burr/rt/flags.h"
#include "device/fake/fake_haply.h"
#include "device/stand_in.h"
#include "device/wild_forces.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using test::FakeHaply;
using test::soon;
using Commands = FakeHaply::Commands;

class InverseTest : public ::testing::Test {
 protected:
  [[nodiscard]] InverseSettings here(const std::string& id = {},
                                     const std::string& grip = {}) const {
    return {.host = "127.0.0.1",
            .port = service_.port,
            .id = id,
            .grip = grip,
            .events_port = service_.events_port};
  }
  [[nodiscard]] std::unique_ptr<WireDevice> device(
      const std::string& id = {}, double loss_timeout = test::kStallsAllowed) const {
    LinkSettings link;
    link.loss_timeout = loss_timeout;
    return std::make_unique<WireDevice>(std::make_unique<Inverse>(here(id)), link);
  }
  // One exchange on a wire without its thread; waits for the reading.
  static HandState exchange(Inverse& wire, const Vec3& force = Vec3::Zero()) {
    HandState hand;
    Wire::Read read = Wire::Read::nothing;
    EXPECT_TRUE(soon([&] { return (read = wire.read(hand)) != Wire::Read::nothing; }));
    EXPECT_EQ(read, Wire::Read::hand);
    EXPECT_TRUE(wire.write(force));
    return hand;
  }
  std::string refusal(const InverseSettings& settings) {
    Inverse wire(settings);
    const auto found = wire.connect();
    return found.ok() ? "it connected" : found.error().text;
  }
  Vec3 asked(std::size_t arm = 0) {
    return service_.with([&](Commands& w) { return w.arms[arm].force; });
  }

  FakeHaply service_;
};

TEST_F(InverseTest, SaysWhatItIsAndWhatItCanBear) {
  for (const auto& [type, peak] :
       {std::pair{"inverse3", 8.0}, {"inverse3x", 8.0}, {"minverse", 3.0}, {"new", 3.0}}) {
    service_.with([&, type = type](Commands& w) { w.arms[0].type = type; });
    const auto arm = device();
    const Status opened = arm->open();
    ASSERT_TRUE(opened.ok()) << opened.error().text;
    EXPECT_EQ(arm->spec().name, type);
    EXPECT_EQ(arm->spec().serial, "049D");
    EXPECT_EQ(arm->spec().peak_force, peak);
    EXPECT_EQ(arm->spec().software, "Inverse Service 3.5, firmware 7.4");
    EXPECT_EQ(arm->spec().sensed, 6);
    EXPECT_FALSE(arm->spec().simulated);
    EXPECT_EQ(arm->trouble(), "");
  }
}

// The service: x right, y forward, z up; ours: x right, y up, z to the user.
TEST_F(InverseTest, TenMillimetresAndANewtonAreThoseAlongEveryAxis) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  for (const auto& [theirs, ours] : {std::pair<Vec3, Vec3>{{1, 0, 0}, {1, 0, 0}},
                                     {{0, 1, 0}, {0, 0, -1}},
                                     {{0, 0, 1}, {0, 1, 0}}}) {
    service_.with([&, way = theirs](Commands& w) {
      w.arms[0].place = 0.01 * way;
      w.arms[0].velocity = 0.2 * way;
    });
    exchange(wire);
    const HandState hand = exchange(wire, ours);
    EXPECT_TRUE(hand.valid);
    EXPECT_NEAR((hand.world_from_tool.p - 0.01 * ours).norm(), 0, 1e-12);
    EXPECT_NEAR((hand.velocity - 0.2 * ours).norm(), 0, 1e-12);
    exchange(wire, Vec3::Zero());  // its answer shows that the previous force has arrived
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
  // it points forward, away from the user: the handle points to the user
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-12);
  // pointing down, a quarter turn about x: y becomes -z
  service_.with([](Commands& w) {
    w.orientation = Quat(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()));
    w.buttons = 5;
  });
  exchange(wire);
  hand = exchange(wire);
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-9)
      << "the handle stands up";
  EXPECT_EQ(hand.buttons, 5U);
  service_.with([](Commands& w) {
    w.names_of_buttons = "button_";
    w.buttons = 2;
  });
  exchange(wire);
  hand = exchange(wire);
  EXPECT_EQ(hand.buttons & 2U, 2U);
}

TEST_F(InverseTest, WithoutAGripTheToolStandsUpright) {
  service_.with([](Commands& w) { w.grip = false; });
  Inverse wire(here());
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok());
  EXPECT_EQ(spec->sensed, 3);
  const HandState hand = exchange(wire);
  EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-12);
}

// Since 3.5 the key is "vector", before it was "values". Where the version is wrong or missing, the
// force that is reported back decides.
TEST_F(InverseTest, TheSpellingOfAForceIsTheOneThatIsObeyed) {
  for (const auto& [version, key] : {std::pair{"3.5.0", "vector"},
                                     {"3.1.2", "values"},
                                     {"v3.4", "values"},
                                     {"4.0", "vector"},
                                     {"", "values"},
                                     {"", "vector"},
                                     {"3.5.1", "values"}}) {
    service_.with([&, version = version, key = key](Commands& w) {
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
  EXPECT_LE(service_.with([](Commands& w) { return w.arms[0].largest; }), 0.021);
}

TEST_F(InverseTest, WhatIsLeftOutIsAsItWas) {
  service_.with([](Commands& w) {
    w.leaves_out = true;
    w.arms[0].place = {0.02, 0, 0};
  });
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  EXPECT_NEAR(exchange(wire).world_from_tool.p.x(), 0.02, 1e-12);
  service_.with([](Commands& w) { w.arms[0].place.setZero(); });
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
  service_.with([](Commands& w) { w.arms.clear(); });
  Inverse wire(here());
  const auto found = wire.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("plug it in"), std::string::npos) << found.error().text;
}

TEST_F(InverseTest, AStrangersSocketIsNoService) {
  service_.with([](Commands& w) { w.silent = true; });
  Inverse wire(here());
  const auto found = wire.connect();
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("does not answer"), std::string::npos) << found.error().text;
}

TEST_F(InverseTest, FragmentsAndPingsChangeNothing) {
  service_.with([](Commands& w) {
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
  service_.with([](Commands& w) { w.arms[0].place.z() = -5e-3; });
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
  service_.with([&](Commands& w) {
    kept = w.arms[0];
    w.arms.clear();
  });
  ASSERT_TRUE(soon([&] { return tick.invalid() > 0; }));
  ASSERT_TRUE(soon([&] { return arm->trouble().find("plug") != std::string::npos; }))
      << arm->trouble();
  kept.force.setZero();
  service_.with([&](Commands& w) { w.arms = {kept}; });
  ASSERT_TRUE(soon([&] { return arm->reconnections() == 1; }));
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
  ASSERT_TRUE(soon([&] { return arm->reconnections() == 1; }));
  ASSERT_TRUE(soon([&] { return tick.hand().valid; }));
  service_.with([](Commands& w) { w.silent = true; });
  ASSERT_TRUE(soon([&] { return arm->trouble().find("Inverse Service") != std::string::npos; }));
  service_.with([](Commands& w) { w.silent = false; });
  EXPECT_TRUE(soon([&] { return arm->reconnections() == 2; }));
}

TEST_F(InverseTest, AServiceThatHangsUpIsNotTakenForOneThatSpeaksNonsense) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  service_.drop();
  HandState hand;
  Wire::Read read = Wire::Read::nothing;
  EXPECT_TRUE(soon([&] {
    read = wire.read(hand);
    EXPECT_EQ(wire.why().find("cannot read"), std::string::npos);
    return read == Wire::Read::lost;
  }));
  EXPECT_NE(wire.why().find("has gone silent"), std::string::npos) << wire.why();
}

TEST_F(InverseTest, AStallOf50MsIsALostHandAndNotALostService) {
  const auto arm = device({}, 5e-3);
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return asked().norm() > 0.03; }));
  service_.with([](Commands& w) { w.stall_ms = 50; });
  EXPECT_TRUE(soon([&] { return (tick.flags() & rt::kFlagHandLost) != 0; }));
  EXPECT_TRUE(soon([&] { return tick.hand().valid && asked().norm() > 0.03; }));
  EXPECT_EQ(arm->reconnections(), 0);
}

TEST_F(InverseTest, AnArmThatIsNotReadyIsNotBelievedAndSaysWhy) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3::Zero(); });
  ASSERT_TRUE(soon([&] { return tick.hand().valid; }));
  service_.with([](Commands& w) { w.arms[0].calibrated = false; });
  EXPECT_TRUE(soon([&] { return !tick.hand().valid; }));
  EXPECT_TRUE(soon([&] { return arm->trouble().find("calibrated") != std::string::npos; }));
  service_.with([](Commands& w) {
    w.arms[0].calibrated = true;
    w.arms[0].powered = false;
  });
  EXPECT_TRUE(soon([&] { return arm->trouble().find("power") != std::string::npos; }));
  service_.with([](Commands& w) { w.arms[0].powered = true; });
  EXPECT_TRUE(soon([&] { return tick.hand().valid && arm->trouble().empty(); }));
}

TEST_F(InverseTest, OneNonsenseIsBorneManyAreNot) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  service_.with([](Commands& w) {
    w.instead = {"{",
                 R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":"1"}}}]})",
                 R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999}}}]})"};
  });
  int nonsense = 0;
  for (int n = 0; n < 6; ++n) nonsense += exchange(wire).valid ? 0 : 1;
  EXPECT_EQ(nonsense, 3);
  EXPECT_TRUE(exchange(wire).valid);
  service_.with([](Commands& w) { w.instead.assign(200, "[]"); });
  HandState hand;
  Wire::Read read = Wire::Read::hand;
  for (int n = 0; n < 400 && read != Wire::Read::lost; ++n) {
    read = wire.read(hand);
    static_cast<void>(wire.write(Vec3::Zero()));
  }
  EXPECT_EQ(read, Wire::Read::lost);
  EXPECT_NE(wire.why().find("cannot read"), std::string::npos) << wire.why();
}

TEST_F(InverseTest, TwoAtOnceEachHasItsOwnForce) {
  service_.with([](Commands& w) {
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

TEST_F(InverseTest, TwoAtOnceEachHasItsOwnGrip) {
  service_.with([](Commands& w) {
    w.arms.push_back({});
    w.arms[1].id = "B2";
    w.more_grips = {{.id = "LEFT", .buttons = 2}};
    w.buttons = 1;
  });
  Inverse first(here("049D")), second(here("B2", "LEFT"));
  ASSERT_TRUE(first.connect().ok());
  ASSERT_TRUE(second.connect().ok());
  const Quat down(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()));
  service_.with([&](Commands& w) { w.more_grips[0].orientation = down; });
  exchange(first);
  exchange(second);
  const HandState one = exchange(first), two = exchange(second);
  EXPECT_EQ(one.buttons, 1U) << "the first grip, where none is named";
  EXPECT_EQ(two.buttons, 2U);
  EXPECT_NEAR((one.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-9);
  EXPECT_NEAR((two.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-9);
  const std::string none = refusal(here("", "RIGHT"));
  EXPECT_NE(none.find("finds no grip RIGHT; it finds GRIP, LEFT"), std::string::npos) << none;
}

// Its last message may have said that a button is pressed.
TEST_F(InverseTest, AGripThatIsGoneHoldsNoButton) {
  service_.with([](Commands& w) { w.more_grips = {{.id = "LEFT", .buttons = 1}}; });
  Inverse wire(here("", "LEFT"));
  ASSERT_TRUE(wire.connect().ok());
  exchange(wire);
  EXPECT_EQ(exchange(wire).buttons, 1U);
  service_.with([](Commands& w) { w.more_grips[0].connected = false; });
  exchange(wire);
  EXPECT_EQ(exchange(wire).buttons, 0U);
  service_.with([](Commands& w) { w.more_grips[0].connected = true; });
  exchange(wire);
  EXPECT_EQ(exchange(wire).buttons, 1U);
  service_.with([](Commands& w) { w.more_grips.clear(); });
  exchange(wire);
  EXPECT_EQ(exchange(wire).buttons, 0U);
}

TEST_F(InverseTest, ALeftHandIsNamed) {
  service_.with([](Commands& w) { w.arms[0].left = true; });
  Inverse wire(here());
  const auto spec = wire.connect();
  ASSERT_TRUE(spec.ok());
  EXPECT_EQ(spec->name, "inverse3 (left hand)");
}

TEST_F(InverseTest, AtAHundredHertzNothingIsPushed) {
  const auto arm = device({}, 5e-3);
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return asked().norm() > 0.03; }));
  service_.with([](Commands& w) { w.pace_ms = 10; });
  ASSERT_TRUE(soon([&] { return (tick.flags() & rt::kFlagHandLost) != 0; }));
  ASSERT_TRUE(soon([&] { return asked() == Vec3::Zero(); }));
  // a machine that stalls for long loses the service, which is then asked with a tiny force: try
  // again
  double most = 0;
  EXPECT_TRUE(soon([&] {
    const int before = service_.messages, returns = arm->reconnections();
    most = 0;
    while (service_.messages < before + 30) {
      most = std::max(most, asked().norm());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return arm->reconnections() == returns;
  })) << "slow, and not lost";
  EXPECT_EQ(most, 0);
}

// The service adds the forces of all sessions.
TEST_F(InverseTest, AnArmThatIsInUseIsLeftToItsProgram) {
  service_.with([](Commands& w) { w.arms[0].in_use = true; });
  const std::string said = refusal(here());
  EXPECT_NE(said.find("inverse3 049D is in use by another program; close that program"),
            std::string::npos)
      << said;
  EXPECT_EQ(service_.messages, 0) << "not a word to it";
  ::setenv("BURR_HAPLY_SHARED", "1", 1);
  EXPECT_EQ(refusal(here()), "it connected") << "its user knows better";
  ::unsetenv("BURR_HAPLY_SHARED");
}

TEST_F(InverseTest, ASecondBurrIsRefusedAndTheFirstGoesOn) {
  Inverse first(here());
  ASSERT_TRUE(first.connect().ok());
  std::atomic<bool> done = false;
  int invalid = 0;
  std::thread goes_on([&] {
    while (!done) invalid += exchange(first, {0.5, 0, 0}).valid ? 0 : 1;
  });
  EXPECT_NE(refusal(here()).find("in use by another program"), std::string::npos);
  done = true;
  goes_on.join();
  EXPECT_EQ(invalid, 0) << "that it is in use by ourselves is no trouble";
  EXPECT_NEAR(asked().x(), 0.5, 1e-4);
  first.disconnect();
  EXPECT_EQ(refusal(here()), "it connected") << "as soon as the first has ended";
}

TEST_F(InverseTest, AnOldServiceIsToldByItsVersion) {
  service_.with([](Commands& w) {
    w.version = "3.0.4";
    w.greets = R"({"devices":[{"device_id":"049D","cursor_position":{"x":0,"y":0,"z":0}}]})";
  });
  std::string said = refusal(here());
  EXPECT_NE(said.find("is version 3.0, which uses another protocol; install version 3.1 or later"),
            std::string::npos)
      << said;
  service_.with([](Commands& w) {
    w.web_socket = false;
    w.version = "2.2.1";
  });
  said = refusal(here());
  EXPECT_NE(said.find("is version 2.2, which uses another protocol"), std::string::npos) << said;
  service_.with([](Commands& w) { w.version = ""; });
  said = refusal(here());
  EXPECT_NE(said.find("is not an Inverse Service of version 3.1 or later; update"),
            std::string::npos)
      << said;
  service_.with([](Commands& w) {
    w.web_socket = true;
    w.greets = "hello";
  });
  said = refusal(here());
  EXPECT_NE(said.find("is not an Inverse Service of version 3.1 or later; update"),
            std::string::npos)
      << said;
  EXPECT_EQ(service_.messages, 0);
}

// ---- events

class InverseEventsTest : public InverseTest {
 protected:
  // With exchanges going on, so that the event is seen.
  bool says(Inverse& wire, const std::string& words) {
    return soon([&] {
      valid_ = exchange(wire).valid;
      return words.empty() ? wire.why().empty() : wire.why().find(words) != std::string::npos;
    });
  }
  bool listens() {
    return soon([&] { return service_.listeners == 1; });
  }
  bool valid_ = false;
};

TEST_F(InverseEventsTest, WhatMattersIsSaidInWords) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(listens());
  for (const auto& [name, words] : {std::pair{"device-disconnected", "was disconnected"},
                                    {"device-battery-low", "battery is low"},
                                    {"device-battery-critical", "battery is nearly empty"},
                                    {"device-sleep", "went to sleep"},
                                    {"device-busy", "is busy; close other programs"},
                                    {"device-connection-loop", "again and again"},
                                    {"device-calibration-failed", "could not be calibrated"}}) {
    service_.tell(name, "049D");
    EXPECT_TRUE(says(wire, words)) << name << ": " << wire.why();
    EXPECT_TRUE(wire.why().starts_with("inverse3 049D ")) << wire.why();
    EXPECT_TRUE(valid_) << name;
  }
  for (const auto& [type, words] :
       {std::pair{"fod_stage_changed", "stage of its own safety system"},
        {"stall_detected", "motors stalled"},
        {"stability_ceiling", "limit of stability"}}) {
    service_.tell_safety(type, "049D");
    EXPECT_TRUE(says(wire, words)) << type << ": " << wire.why();
    EXPECT_TRUE(valid_) << type;
  }
  service_.tell("device-meltdown", "049D", "critical");
  EXPECT_TRUE(says(wire, "reports a fault"));
  const auto told = std::chrono::steady_clock::now();
  service_.tell("device-connected", "049D", "info");
  EXPECT_TRUE(says(wire, "")) << wire.why();
  EXPECT_LT(std::chrono::steady_clock::now() - told, std::chrono::seconds(4))
      << "not only because it has been said long enough";
}

TEST_F(InverseEventsTest, WhatWasToldIsSaidForSomeSeconds) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(listens());
  service_.tell("device-battery-low", "GRIP");
  ASSERT_TRUE(says(wire, "battery is low")) << "of the grip that is held with it";
  const auto began = std::chrono::steady_clock::now();
  ASSERT_TRUE(says(wire, ""));
  EXPECT_GT(std::chrono::steady_clock::now() - began, std::chrono::seconds(3));
}

TEST_F(InverseEventsTest, OnlyItsOwnDevicesCount) {
  service_.with([](Commands& w) {
    w.arms.push_back({});
    w.arms[1].id = "B2";
    w.more_grips = {{.id = "LEFT"}};
  });
  Inverse wire(here("049D", "GRIP"));
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(listens());
  for (const char* other : {"B2", "LEFT"}) {
    service_.tell("device-battery-low", other);
    service_.tell_safety("ebrake_triggered", other);
  }
  service_.tell("device-busy", "049D");
  EXPECT_TRUE(soon([&] {  // in order: by then, what came before it has been ignored
    const bool valid = exchange(wire).valid;
    EXPECT_TRUE(valid);
    EXPECT_EQ(wire.why().find("battery"), std::string::npos) << wire.why();
    return !valid || wire.why().find("is busy") != std::string::npos;
  }));
  service_.tell("device-battery-low");
  EXPECT_TRUE(says(wire, "battery is low")) << "whose it is was not told";
}

TEST_F(InverseEventsTest, AnEmergencyBrakeLetsGoUntilItIsReleasedAndForceReturnsByTheRamp) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(*arm, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(soon([&] { return tick.engaged(); }));
  ASSERT_TRUE(listens());
  wall = true;
  ASSERT_TRUE(soon([&] { return asked().norm() > 1.9; }));
  service_.tell_safety("ebrake_triggered", "049D");
  ASSERT_TRUE(soon([&] { return asked() == Vec3::Zero(); }));
  EXPECT_FALSE(tick.hand().valid);
  EXPECT_TRUE(soon([&] { return arm->trouble().find("emergency brake") != std::string::npos; }));
  EXPECT_EQ(arm->reconnections(), 0);
  service_.tell("device-battery-low", "049D");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(asked(), Vec3::Zero());
  EXPECT_NE(arm->trouble().find("emergency brake"), std::string::npos) << "first of all";
  service_.tell_safety("ebrake_released", "049D");
  ASSERT_TRUE(soon([&] { return tick.hand().valid; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(tick.engaged()) << "the wall is still there: it waits for a small force";
  wall = false;
  EXPECT_TRUE(soon([&] { return tick.engaged(); }));
}

// Nobody has reported its release, so it counts as not released.
TEST_F(InverseEventsTest, ABrakeOutlivesItsChannelAndTheConnection) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  ASSERT_TRUE(listens());
  service_.tell_safety("ebrake_triggered");
  ASSERT_TRUE(says(wire, "is held by its emergency brake"));
  EXPECT_FALSE(valid_);
  service_.with([](Commands& w) { w.events_hang_up = true; });
  ASSERT_TRUE(says(wire, "when it last sent anything; release the brake, and begin again"));
  EXPECT_FALSE(valid_);
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_FALSE(exchange(wire).valid);
  ASSERT_TRUE(listens());
  service_.tell_safety("ebrake_released");
  EXPECT_TRUE(says(wire, ""));
  EXPECT_TRUE(valid_);
}

TEST_F(InverseEventsTest, GarbageHugeMessagesAndHangUpsDisturbNothing) {
  const auto arm = device();
  ASSERT_TRUE(arm->open().ok());
  test::StandIn tick(*arm, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(soon([&] { return asked().norm() > 0.03; }));
  ASSERT_TRUE(listens());
  const std::uint64_t invalid = tick.invalid();
  for (const char* odd : {"{", "[]", "{}", R"({"name":7})", R"({"name":"x","data":[]})",
                          R"({"name":"device-safety-triggered","data":{"safety_type":[1]}})"})
    service_.tell_text(odd);
  service_.tell("device-battery-low", "049D");
  EXPECT_TRUE(soon([&] { return arm->trouble().find("battery") != std::string::npos; }))
      << "after all that";
  std::string huge(10'000'000, 'x');
  huge.front() = huge.back() = '"';
  service_.tell_text(std::move(huge));
  EXPECT_TRUE(soon([&] { return service_.listened == 2; })) << "hung up on, and listened to again";
  service_.with([](Commands& w) { w.events_hang_up = true; });
  EXPECT_TRUE(soon([&] { return service_.listened == 3; }));
  for (int n = 0; n < 2000; ++n) service_.tell_text("nonsense");
  EXPECT_TRUE(soon([&] { return service_.listened == 4; })) << "it is another's channel";
  service_.tell_text("\xff\xfe");
  EXPECT_TRUE(soon([&] { return service_.listened == 5; })) << "no text at all";
  service_.tell("device-busy", "049D");
  EXPECT_TRUE(soon([&] { return arm->trouble().find("busy") != std::string::npos; }));
  EXPECT_EQ(arm->reconnections(), 0);
  EXPECT_EQ(tick.invalid(), invalid);
  EXPECT_GT(asked().norm(), 0.03);
}

TEST_F(InverseEventsTest, WithoutTheChannelItGoesOn) {
  InverseSettings settings = here();
  settings.events_port = 1;
  Inverse wire(settings);
  ASSERT_TRUE(wire.connect().ok());
  EXPECT_TRUE(exchange(wire).valid);
  EXPECT_EQ(wire.why(), "");
  wire.disconnect();
  ::setenv("HAPLY_EVENTS_PORT", "x", 1);
  settings.events_port = 0;
  EXPECT_NE(refusal(settings).find("HAPLY_EVENTS_PORT is \"x\"; give a port"), std::string::npos);
  ::setenv("HAPLY_EVENTS_PORT", std::to_string(service_.events_port).c_str(), 1);
  EXPECT_EQ(service_.listened, 0);
  Inverse told(settings);
  ASSERT_TRUE(told.connect().ok());
  EXPECT_TRUE(listens());
  ::unsetenv("HAPLY_EVENTS_PORT");
}

TEST_F(InverseTest, OfManyRandomForcesNonePassesTheLimit) {
  Inverse wire(here());
  ASSERT_TRUE(wire.connect().ok());
  const unsigned seed = std::random_device{}();
  test::WildForces forces(seed);
  test::push_wildly(wire, test::forces_on_a_wire(), forces);
  const double largest = service_.with([](Commands& w) { return w.arms[0].largest; });
  EXPECT_GT(largest, 7.9) << "seed " << seed;
  EXPECT_LE(largest, 8 + 1e-4) << "seed " << seed;
}

TEST_F(InverseTest, OpenedAndClosedManyTimesNothingIsLeft) {
  const int rounds = test::rounds();
  const auto once = [&] {
    Inverse wire(here());
    return wire.connect().ok();
  };
  const auto ended = [&] { return service_.listeners == 0; };
  for (int n = 0; n < 20; ++n) ASSERT_TRUE(once());  // what is kept for ever is allocated now
  ASSERT_TRUE(soon(ended));
  const int files = test::open_files();
  const std::size_t memory = test::memory_in_use();
  for (int n = 0; n < rounds; ++n) ASSERT_TRUE(once()) << n;
  EXPECT_TRUE(soon([&] { return ended() && test::open_files() <= files; }))
      << test::open_files() << " open, " << files << " before";
  EXPECT_GE(service_.sessions, rounds + 20);
  // the fake service keeps a few hundred bytes of each; a leaked connection has some kilobytes
  EXPECT_LT(test::memory_in_use(), memory + static_cast<std::size_t>(rounds) * 2000);
}

// ---- the connection

TEST_F(InverseTest, ALineThatIsNotConnectedTakesAndGivesNothing) {
  net::WebSocket line(1000);
  const auto is_none = [&line] {
    return !line.whole() && !line.send("{}") &&
           line.receive(std::chrono::milliseconds(1)) == net::WebSocket::Received::lost;
  };
  EXPECT_TRUE(is_none()) << "not yet";
  EXPECT_NE(line.connect("", service_.port), "");
  EXPECT_TRUE(is_none()) << "nowhere";
  EXPECT_NE(line.connect("127.0.0.1", 1), "");
  EXPECT_TRUE(is_none()) << "refused";
  ASSERT_EQ(line.connect("127.0.0.1", service_.port), "");
  EXPECT_TRUE(line.whole());
  EXPECT_EQ(line.peer(), "127.0.0.1");
  EXPECT_TRUE(soon([&] {
    return line.receive(std::chrono::milliseconds(1)) == net::WebSocket::Received::message;
  })) << "its greeting";
  line.close();
  EXPECT_TRUE(is_none()) << "no more";
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
  ASSERT_EQ(read_state(whole, "049D", "", known), Read::state);
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
    static_cast<void>(read_state(text, "049D", "", state));
    std::vector<Found> found;
    static_cast<void>(read_found(text, found));
    static_cast<void>(read_version(text));
    Event event;
    static_cast<void>(read_event(text, event));
    EXPECT_TRUE(state.place.allFinite() && state.velocity.allFinite() && state.force.allFinite())
        << "seed " << seed << ": " << text;
    EXPECT_NEAR(state.grip.norm(), 1, 1e-9) << "seed " << seed << ": " << text;
  }
}

TEST(HaplyMessage, EventsAreWhatTheServiceTells) {
  Event event;
  ASSERT_TRUE(
      read_event(R"({"name":"device-safety-triggered","category":"device","level":"critical",)"
                 R"("data":{"device_id":"049D","safety_type":"ebrake_triggered"}})",
                 event));
  EXPECT_EQ(event.what, EventKind::brake);
  EXPECT_EQ(event.device, "049D");
  ASSERT_TRUE(read_event(R"({"name":"http-route-deprecated","level":"warning","data":{}})", event));
  EXPECT_EQ(event.what, EventKind::nothing);
  EXPECT_EQ(event.device, "");
  ASSERT_TRUE(read_event(R"({"name":"device-sleep"})", event));
  EXPECT_EQ(event.what, EventKind::sleeps);
  EXPECT_FALSE(read_event(R"({"message":"x"})", event));
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
