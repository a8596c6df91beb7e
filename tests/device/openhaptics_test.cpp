// The Touch against a libHD.so that the test plays (fake/fake_hd.h), loaded like the real one.
#include "burr/device/openhaptics/touch.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "device/fake/fake_hd.h"
#include "device/stand_in.h"
#include "support/rt_guard.h"
#include "support/test_places.h"

namespace burr::device::openhaptics {
namespace {

using math::Vec3;

const std::string kFakes = test::build_dir() + "/fakes/";
const std::string kLibrary = kFakes + "libHD.so";

struct Symbols {
  test::FakeHd* hd = nullptr;
  test::FakeHdFrame frame = nullptr;
  Symbols() {
    void* library = dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) std::abort();
    hd = reinterpret_cast<test::FakeHdState>(dlsym(library, "fake_hd"))();
    frame = reinterpret_cast<test::FakeHdFrame>(dlsym(library, "fake_hd_frame"));
  }
};
Symbols& fake() {
  static Symbols one;
  return one;
}

std::int64_t virtual_ns = 0;
std::int64_t virtual_now() { return virtual_ns; }

class TouchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::lock_guard lock(fake().hd->mutex);
    fake().hd->touch = {};
    fake().hd->touch[1].name = "Second";
    fake().hd->touch[1].serial = "T-0002";
    fake().hd->rate = 1000;
    fake().hd->needs_name = fake().hd->no_room = false;
    fake().hd->misuse = 0;
    fake().hd->misused.clear();
  }
  void TearDown() override {
    const std::lock_guard lock(fake().hd->mutex);
    EXPECT_EQ(fake().hd->misuse, 0U) << fake().hd->misused;
    for (const test::FakeTouch& touch : fake().hd->touch) {
      EXPECT_FALSE(touch.open);
      EXPECT_FALSE(touch.force_on);
    }
    EXPECT_EQ(fake().hd->starts, fake().hd->stops);
  }

  template <class F>
  static auto with_hd(F look) {
    const std::lock_guard lock(fake().hd->mutex);
    return look(*fake().hd);
  }
  // The test makes each frame and advances time.
  static TouchSettings by_hand() {
    with_hd([](test::FakeHd& hd) { hd.rate = 0; });
    virtual_ns = 1'000'000'000;
    return {.hd_file = kLibrary, .link = {.answer_timeout = 0}, .now = &virtual_now};
  }
  static TouchSettings by_itself(double loss_timeout = test::kStallsAllowed) {
    TouchSettings settings;
    settings.hd_file = kLibrary;
    settings.link.loss_timeout = loss_timeout;
    return settings;
  }
  static bool is_open(std::size_t which) {
    return with_hd([which](test::FakeHd& hd) { return hd.touch[which].open; });
  }
  static std::uint64_t frames_now() {
    return with_hd([](test::FakeHd& hd) { return hd.touch[0].frames; });
  }
  template <class F>
  static void set(F change) {
    const std::lock_guard lock(fake().hd->mutex);
    change(fake().hd->touch[0]);
  }
  static void place(const Vec3& mm) {
    set([&](test::FakeTouch& touch) { std::copy_n(mm.data(), 3, touch.transform.begin() + 12); });
  }
  static Vec3 last_force(std::size_t which = 0) {
    const std::lock_guard lock(fake().hd->mutex);
    const auto& forces = fake().hd->touch[which].forces;
    return forces.empty() ? Vec3(Vec3::Zero())
                          : Vec3(forces.back()[0], forces.back()[1], forces.back()[2]);
  }
  // A millisecond: one frame of the library, then one tick.
  template <class F>
  static void step(Touch& touch, F tick) {
    virtual_ns += 1'000'000;
    fake().frame();
    touch.write_force(tick(touch.state(1e-3)));
  }
};

TEST_F(TouchTest, SaysWhatItIsAndWhatItCanBear) {
  struct {
    const char* model;
    double nominal, peak, stiffness;
  } const known[] = {{"Touch", 3.3, 3.3, 400},
                     {"Touch X", 7.9, 7.9, 1000},
                     {"Omni", 3.3, 3.3, 700},
                     {"Desktop", 7.9, 7.9, 1000},
                     {"Premium 1.5", 8.5, 8.5, 800},
                     {"Omni", 2.5, 2.5, 700},
                     {"Touch", 33, 3.3, 400},
                     {"Something new", 9, 3.3, 400},
                     {"Touch", std::numeric_limits<double>::quiet_NaN(), 3.3, 400}};
  for (const auto& one : known) {
    set([&](test::FakeTouch& touch) {
      touch.model = one.model;
      touch.nominal_force = one.nominal;
      touch.nominal_continuous = one.nominal;
    });
    Touch touch(by_itself(5e-3));
    ASSERT_TRUE(touch.open().ok());
    EXPECT_EQ(touch.spec().name, one.model);
    EXPECT_EQ(touch.spec().serial, "T-0001");
    EXPECT_EQ(touch.spec().peak_force, one.peak) << one.model;
    EXPECT_LE(touch.spec().continuous_force, touch.spec().peak_force);
    EXPECT_EQ(touch.spec().max_stiffness, one.stiffness);
    EXPECT_EQ(touch.spec().sensed, 6);
    EXPECT_EQ(touch.spec().actuated, 3);
    EXPECT_FALSE(touch.spec().simulated);
    EXPECT_EQ(touch.spec().loss_timeout, 5e-3);
    EXPECT_EQ(touch.spec().software, "HD API 3.0, driver 2019.2.15");
    EXPECT_EQ(touch.trouble(), "");
  }
  set([](test::FakeTouch& touch) { touch.tells_driver = false; });
  Touch touch(by_itself(5e-3));
  ASSERT_TRUE(touch.open().ok()) << "a library that does not know its driver's version";
  EXPECT_EQ(touch.spec().software, "HD API 3.0");
}

// Three movements of 10 mm, one along each axis, each with a force back along that axis.
TEST_F(TouchTest, TenMillimetresAndANewtonAreThoseAlongEveryAxis) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = Vec3::Unit(axis);
    place(10 * way);
    step(touch, [&](const HandState& hand) {
      EXPECT_TRUE(hand.valid);
      EXPECT_NEAR((hand.world_from_tool.p - 0.01 * way).norm(), 0, 1e-15);
      return way;
    });
    step(touch, [](const HandState&) { return Vec3::Zero(); });
    EXPECT_EQ(last_force(), way)
        << "the force of a tick is on the wire with the next frame at the latest";
  }
}

TEST_F(TouchTest, APremiumWithSixMotorsIsTurnedInMillinewtonMetres) {
  set([](test::FakeTouch& one) {
    one.model = "PHANToM Premium 1.5 6DOF";
    one.output_dof = 6;
  });
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  EXPECT_EQ(touch.spec().actuated, 6);
  EXPECT_EQ(touch.spec().peak_torque, 0.188);
  const auto twisted = [&](const Vec3& torque) {
    for (int n = 0; n < 2; ++n)
      step(touch, [&](const HandState& hand) {
        EXPECT_TRUE(hand.valid);
        touch.write_torque(torque);
        return Vec3::Zero();
      });
    return with_hd([](test::FakeHd& hd) { return Vec3(hd.touch[0].torque.data()); });
  };
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR((twisted(0.01 * Vec3::Unit(axis)) - 10 * Vec3::Unit(axis)).norm(), 0, 1e-12);
  EXPECT_NEAR(twisted({0, 3, 4}).norm(), 188, 1e-9);
  EXPECT_EQ(twisted(Vec3::Zero()), Vec3::Zero());

  // a device that reports six degrees of freedom but takes no torque works without
  set([](test::FakeTouch& one) {
    one.takes_torque = false;
    one.torques = 0;
  });
  static_cast<void>(twisted({0.01, 0, 0}));
  static_cast<void>(twisted({0.01, 0, 0}));
  EXPECT_EQ(with_hd([](test::FakeHd& hd) { return hd.touch[0].torques; }), 1);
  EXPECT_EQ(touch.trouble(), "");
}

TEST_F(TouchTest, WhatHasThreeMotorsOrDoesNotSayIsNotTurned) {
  for (const int dof : {3, -1}) {
    set([dof](test::FakeTouch& one) { one.output_dof = dof; });
    Touch touch(by_hand());
    ASSERT_TRUE(touch.open().ok());
    EXPECT_EQ(touch.spec().actuated, 3);
    EXPECT_EQ(touch.spec().peak_torque, 0);
    for (int n = 0; n < 3; ++n)
      step(touch, [&](const HandState& hand) {
        EXPECT_TRUE(hand.valid);
        touch.write_torque({0.1, 0, 0});
        return Vec3::Zero();
      });
    EXPECT_EQ(touch.trouble(), "");
  }
}

TEST_F(TouchTest, ReadsHowItIsTurnedItsSpeedAndItsButtons) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  // a quarter turn about y, column by column, with small errors as such a library has them
  set([](test::FakeTouch& one) {
    one.transform = {1e-4, 0, -1.0002, 0, 0, 0.9999, 0, 0, 1, 1e-4, 0, 0, 0, 0, 0, 1};
    one.velocity = {100, -50, 25};
    one.buttons = 3;
  });
  step(touch, [](const HandState& hand) {
    EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitX() + Vec3::UnitZ()).norm(), 0, 1e-3);
    EXPECT_NEAR((hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0, 1e-3);
    EXPECT_NEAR(hand.world_from_tool.q.norm(), 1, 1e-12);
    EXPECT_NEAR((hand.velocity - Vec3(0.1, -0.05, 0.025)).norm(), 0, 1e-15);
    EXPECT_EQ(hand.buttons, 3U);
    return Vec3::Zero();
  });
}

// A whole session on the library's own thread, with the force of a reading in the library's frame.
TEST_F(TouchTest, ARunningSessionPushesAndLetsGo) {
  Touch touch(by_itself());
  ASSERT_TRUE(touch.open().ok());
  {
    test::StandIn tick(touch, [](const HandState& hand) {
      return Vec3(0, -400 * std::min(0.0, hand.world_from_tool.p.y()), 0);
    });
    ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
    place({0, -5, 0});
    EXPECT_TRUE(test::soon([&] { return last_force().y() > 1.9; }));
    EXPECT_LE(last_force().y(), 2 + 1e-12);
    EXPECT_EQ(touch.trouble(), "");
    place({0, 5, 0});
    EXPECT_TRUE(test::soon([&] { return last_force() == Vec3::Zero(); }));
  }
  touch.close();
}

TEST_F(TouchTest, ALibraryThatIsMissingIsNamedWithTheLoadersWords) {
  Touch touch({.hd_file = kFakes + "nowhere/libHD.so"});
  const Status opened = touch.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().text.find("No such file"), std::string::npos) << opened.error().text;
  EXPECT_NE(opened.error().text.find("BURR_OPENHAPTICS"), std::string::npos);
}

TEST_F(TouchTest, ASymbolThatIsMissingIsNamed) {
  Touch touch({.hd_file = kFakes + "libHD_old.so"});
  const Status opened = touch.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().text.find("hdScheduleAsynchronous"), std::string::npos)
      << opened.error().text;
}

TEST_F(TouchTest, ADeviceThatIsAbsentOrTakenIsRefusedInWords) {
  set([](test::FakeTouch& one) { one.present = false; });
  Touch touch(by_itself());
  Status opened = touch.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().text.find("cable"), std::string::npos) << opened.error().text;
  set([](test::FakeTouch& one) {
    one.present = true;
    one.in_use = true;
  });
  opened = touch.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().text.find("another program"), std::string::npos) << opened.error().text;
}

TEST_F(TouchTest, AFullSchedulerIsRefusedAndAllIsGivenBack) {
  with_hd([](test::FakeHd& hd) { hd.no_room = true; });
  Touch touch(by_itself());
  const Status opened = touch.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().text.find("no room"), std::string::npos) << opened.error().text;
}

TEST_F(TouchTest, AnOldDriverWantsItsDeviceByName) {
  with_hd([](test::FakeHd& hd) { hd.needs_name = true; });
  Touch touch(by_itself());
  EXPECT_TRUE(touch.open().ok());
}

TEST_F(TouchTest, WhatIsNoReadingIsNotBelieved) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  const auto valid = [&] {
    bool was = true;
    step(touch, [&](const HandState& hand) {
      was = hand.valid;
      return Vec3::Zero();
    });
    return was;
  };
  EXPECT_TRUE(valid());
  const auto bad = [&](auto spoil) {
    set([&](test::FakeTouch& one) {
      one = {};
      spoil(one);
    });
    set([](test::FakeTouch& one) { one.open = one.force_on = true; });
    EXPECT_FALSE(valid());
  };
  bad([](test::FakeTouch& one) { one.transform[12] = std::numeric_limits<double>::quiet_NaN(); });
  bad([](test::FakeTouch& one) { one.transform[13] = std::numeric_limits<double>::infinity(); });
  bad([](test::FakeTouch& one) { one.transform[14] = 5e3; });
  bad([](test::FakeTouch& one) { one.transform[0] = std::numeric_limits<double>::quiet_NaN(); });
  bad([](test::FakeTouch& one) { one.transform[0] = one.transform[5] = one.transform[10] = 0; });
  bad([](test::FakeTouch& one) { one.transform[0] = -1; });
  bad([](test::FakeTouch& one) { one.velocity[1] = std::numeric_limits<double>::quiet_NaN(); });
}

// A force that the device switched off returns only through the start ramp.
TEST_F(TouchTest, AForceThatTheDeviceRefusedIsLetGo) {
  for (const unsigned code : {0x0201U, 0x0202U, 0x0203U, 0x0204U, 0x0300U, 0x0302U}) {
    Touch touch(by_hand());
    ASSERT_TRUE(touch.open().ok());
    const auto two = [](const HandState&) { return Vec3(0, 2, 0); };
    step(touch, two);
    step(touch, two);
    EXPECT_EQ(last_force().y(), 2);
    set([&](test::FakeTouch& one) { one.frame_error = code; });
    step(touch, two);
    EXPECT_FALSE(touch.trouble().empty());
    EXPECT_EQ(touch.trouble(), words(code));
    set([](test::FakeTouch& one) { one.frame_error = 0; });
    bool learnt = false;
    for (int n = 0; n < 10; ++n) {
      step(touch, [&](const HandState& hand) {
        learnt = learnt || !hand.valid;
        return Vec3(0, 2, 0);  // a tick that ignores it
      });
      EXPECT_EQ(last_force(), Vec3::Zero());
    }
    EXPECT_TRUE(learnt);
    step(touch, [](const HandState&) { return Vec3::Zero(); });
    step(touch, two);
    step(touch, two);
    EXPECT_EQ(last_force().y(), 2);
    EXPECT_EQ(touch.trouble(), "");
  }
}

TEST_F(TouchTest, WarmMotorsAreToldAndPushedOn) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  set([](test::FakeTouch& one) { one.frame_error = 0x0200; });
  const auto one = [](const HandState&) { return Vec3(0, 1, 0); };
  step(touch, one);
  step(touch, one);
  EXPECT_EQ(last_force().y(), 1);
  EXPECT_NE(touch.trouble().find("warm"), std::string::npos);
}

TEST_F(TouchTest, EveryErrorCodeHasWordsOfItsOwn) {
  for (const unsigned code : {0x0104U, 0x0200U, 0x0201U, 0x0202U, 0x0203U, 0x0204U, 0x0300U,
                              0x0301U, 0x0302U, 0x0303U, 0x0304U, 0x0600U})
    for (const unsigned other : {0x0104U, 0x0200U, 0x0201U, 0x0202U, 0x0203U, 0x0204U, 0x0300U,
                                 0x0301U, 0x0302U, 0x0303U, 0x0304U, 0x0600U}) {
      if (code != other) {
        EXPECT_NE(words(code), words(other));
      }
    }
  for (const unsigned code :
       {0x0100U, 0x0101U, 0x0102U, 0x0103U, 0x0400U, 0x0401U, 0x0402U, 0x0500U, 0x0501U, 0xABCDU})
    EXPECT_GT(words(code).size(), 20U);
  EXPECT_EQ(words(0), "");
}

// A library that reports errors without end must not block its own thread.
TEST_F(TouchTest, PulledOutInContactItLetsGoAndComesBackByTheRamp) {
  Touch touch(by_itself());
  ASSERT_TRUE(touch.open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(touch, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(test::soon([&] { return last_force().y() > 1.9; }));
  set([](test::FakeTouch& one) { one.present = false; });
  ASSERT_TRUE(test::soon([&] { return tick.invalid() > 0; }));
  ASSERT_TRUE(test::soon([&] { return !touch.trouble().empty(); }));
  // tried in vain, then found again
  ASSERT_TRUE(test::soon([&] { return !is_open(0); }));
  EXPECT_FALSE(tick.engaged());
  const auto frames = frames_now();
  set([](test::FakeTouch& one) { one.present = true; });
  ASSERT_TRUE(test::soon([&] { return frames_now() > frames + 50; }));
  EXPECT_FALSE(tick.engaged()) << "the wall is still there: it waits for a small force";
  EXPECT_EQ(last_force(), Vec3::Zero());
  wall = false;
  ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
  EXPECT_EQ(touch.trouble(), "");
  tick.stop();
  touch.close();
}

TEST_F(TouchTest, AnotherDeviceThanBeforeIsNotTaken) {
  Touch touch(by_itself());
  ASSERT_TRUE(touch.open().ok());
  set([](test::FakeTouch& one) { one.present = false; });
  ASSERT_TRUE(test::soon([&] { return !is_open(0); }));
  set([](test::FakeTouch& one) {
    one.present = true;
    one.serial = "T-0009";
  });
  EXPECT_TRUE(
      test::soon([&] { return touch.trouble().find("Another Touch") != std::string::npos; }));
}

TEST_F(TouchTest, AtAHundredHertzNothingIsPushed) {
  Touch touch(by_itself(5e-3));
  ASSERT_TRUE(touch.open().ok());
  test::StandIn tick(touch, [&](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(test::soon([&] { return last_force().y() > 0.03; }));
  fake().hd->mutex.lock();
  fake().hd->rate = 100;
  fake().hd->mutex.unlock();
  // the rate holds from the second frame on; on a busy machine the hand may have been lost before
  const auto before = frames_now();
  ASSERT_TRUE(test::soon([&] { return frames_now() > before + 2; }));
  ASSERT_TRUE(test::soon([&] { return (tick.flags() & rt::kFlagHandLost) != 0; }));
  ASSERT_TRUE(test::soon([&] { return last_force() == Vec3::Zero(); }));
  const auto frames = frames_now();
  double most = 0;
  while (frames_now() < frames + 30) {
    most = std::max(most, last_force().norm());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(most, 0);
  tick.stop();
  touch.close();
}

// The tick stops for 50 ms: the last force fades to zero, once, within 5 ms of the loss.
TEST_F(TouchTest, AStalledTickIsLetGoLinearly) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  const auto two = [](const HandState&) { return Vec3(0, 2, 0); };
  step(touch, two);
  step(touch, two);
  std::vector<double> sent;
  for (int n = 0; n < 50; ++n) {
    virtual_ns += 1'000'000;
    fake().frame();
    sent.push_back(last_force().y());
  }
  EXPECT_EQ(sent[0], 2);
  for (std::size_t n = 1; n < sent.size(); ++n) {
    EXPECT_LE(sent[n], sent[n - 1]);
    EXPECT_LE(sent[n - 1] - sent[n], 0.4 + 1e-9);
  }
  EXPECT_EQ(sent[4], 2);
  EXPECT_NEAR(sent[6], 1.6, 0.41);
  EXPECT_EQ(sent[11], 0);
  EXPECT_EQ(sent.back(), 0);
}

TEST_F(TouchTest, CalibrationIsDoneOrAskedFor) {
  set([](test::FakeTouch& one) { one.calibration = 0x5001; });
  {
    Touch touch(by_hand());
    ASSERT_TRUE(touch.open().ok());
    step(touch, [](const HandState& hand) {
      EXPECT_TRUE(hand.valid);
      return Vec3::Zero();
    });
    EXPECT_EQ(touch.trouble(), "");
  }
  set([](test::FakeTouch& one) {
    one.calibration = 0x5001;
    one.style = 4;
  });
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  const auto none = [](const HandState&) { return Vec3(0, 1, 0); };
  for (int n = 0; n < 5; ++n) step(touch, none);
  EXPECT_FALSE(touch.state(1e-3).valid);
  EXPECT_NE(touch.trouble().find("inkwell"), std::string::npos) << touch.trouble();
  set([](test::FakeTouch& one) { one.calibration = 0x5000; });
  for (int n = 0; n < 200; ++n) step(touch, [](const HandState&) { return Vec3::Zero(); });
  EXPECT_TRUE(touch.state(1e-3).valid);
  EXPECT_EQ(touch.trouble(), "");
}

TEST_F(TouchTest, TwoAtOnceEachHasItsOwnForce) {
  Touch first(by_itself());
  TouchSettings named = by_itself();
  named.name = "Second";
  Touch second(named);
  ASSERT_TRUE(first.open().ok());
  ASSERT_TRUE(second.open().ok());
  EXPECT_EQ(second.spec().serial, "T-0002");
  {
    test::StandIn one(first, [](const HandState&) { return Vec3(0.04, 0, 0); });
    test::StandIn two(second, [](const HandState&) { return Vec3(0, 0, 0.03); });
    EXPECT_TRUE(test::soon([&] { return last_force(0).x() == 0.04 && last_force(1).z() == 0.03; }));
    one.stop();
    two.stop();
  }
  first.close();
  EXPECT_TRUE(is_open(1));
  second.close();
}

// Whatever is requested and whatever the hand does, the force on the wire never exceeds the
// device's limit.
TEST_F(TouchTest, AMillionWildTicksNeverPassTheLimit) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  haptics::ForceLimit limit(touch.spec(), {.user_force = 100});
  double x = 0;
  Vec3 pull = Vec3::Zero();
  for (int n = 0; n < 1'000'000; ++n) {
    const auto dice = static_cast<unsigned>(random() % 2000);
    x = std::clamp(x + any(random), -70.0, 70.0);
    if (dice == 0) x = 200 * any(random);
    place({dice == 1 ? std::numeric_limits<double>::quiet_NaN() : x, 0, 0});
    if (dice == 2) set([](test::FakeTouch& one) { one.frame_error = 0x0202; });
    if (dice == 3) touch.scale_force(any(random));
    const int frames = dice < 6 ? static_cast<int>(dice) : 1;
    for (int k = 0; k < frames; ++k) {
      virtual_ns += 1'000'000;
      fake().frame();
    }
    set([](test::FakeTouch& one) { one.frame_error = 0; });
    const HandState hand = touch.state(1e-3);
    std::uint32_t flags = 0;
    if (dice < 20)  // for some fifty ticks, otherwise the force never grows
      pull = std::pow(10.0, 3 * any(random)) * Vec3(any(random), any(random), any(random));
    Vec3 wanted = pull;
    if (dice == 7) wanted.setConstant(std::numeric_limits<double>::infinity());
    if (dice == 8) wanted.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (n % 1000 < 20) wanted.setZero();
    if (!limit.accept_reading(hand, flags)) wanted.setZero();
    touch.write_force(limit.apply(wanted, 1e-3, flags));
  }
  const std::lock_guard lock(fake().hd->mutex);
  EXPECT_GT(fake().hd->touch[0].largest_force, 3.2) << "seed " << seed;
  EXPECT_LE(fake().hd->touch[0].largest_force, 3.3 + 1e-9) << "seed " << seed;
}

TEST_F(TouchTest, OpenedAndClosedManyTimesNothingIsLeft) {
  const int rounds = test::rounds();
  {
    Touch first(by_itself());
    ASSERT_TRUE(first.open().ok());
  }
  const int files = test::open_files();
  for (int n = 0; n < rounds; ++n) {
    Touch touch(by_itself());
    ASSERT_TRUE(touch.open().ok()) << n;
  }
  EXPECT_EQ(test::open_files(), files);
  const std::lock_guard lock(fake().hd->mutex);
  EXPECT_EQ(fake().hd->touch[0].opened, static_cast<std::uint64_t>(rounds) + 1);
  EXPECT_EQ(fake().hd->touch[0].closed, static_cast<std::uint64_t>(rounds) + 1);
}

TEST_F(TouchTest, TheExchangeTakesNoMemory) {
  Touch touch(by_hand());
  ASSERT_TRUE(touch.open().ok());
  const auto half = [](const HandState&) { return Vec3(0, 0.5, 0); };
  step(touch, half);
  set([](test::FakeTouch& one) { one.forces.reserve(8192); });
  const test::RtGuard guard;
  for (int n = 0; n < 100; ++n) {
    virtual_ns += 1'000'000;
    fake().frame();
    static_cast<void>(touch.state(1e-3));
    touch.write_force({0, 0.5, 0});
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace burr::device::openhaptics
