// Force Dimension's arms against libraries that the test plays (fake/fake_dhd.h), loaded like the
// real ones.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "burr/device/forcedimension/omega.h"
#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "device/fake/fake_dhd.h"
#include "device/stand_in.h"
#include "support/folder.h"
#include "support/rt_guard.h"
#include "support/test_places.h"

namespace burr::device::forcedimension {
namespace {

using math::Vec3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

const std::string kFakes = test::build_dir() + "/fakes/";
const std::string kLibrary = kFakes + "libdrd.so";

test::FakeDhd& state_of(const std::string& library) {
  void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) std::abort();
  return *reinterpret_cast<test::FakeDhdState>(dlsym(loaded, "fake_dhd"))();
}
test::FakeDhd& fake() {
  static test::FakeDhd& one = state_of(kLibrary);
  return one;
}

// One arm is plugged in; two more may be.
void begin(test::FakeDhd& dhd) {
  dhd.arm = {};
  for (std::size_t n = 1; n < dhd.arm.size(); ++n) {
    dhd.arm[n].present = false;
    dhd.arm[n].serial = static_cast<unsigned short>(1001 + n);
  }
  dhd.misuse = 0;
  dhd.misused.clear();
}
void judge(const test::FakeDhd& dhd) {
  EXPECT_EQ(dhd.misuse, 0U) << dhd.misused;
  for (const test::FakeArm& arm : dhd.arm) {
    EXPECT_FALSE(arm.open);
    EXPECT_EQ(arm.opened, arm.closed);
  }
}

std::int64_t virtual_ns = 0;
std::int64_t virtual_now() { return virtual_ns; }

OmegaSettings by_itself() { return {.dhd_file = kLibrary}; }

template <class F>
void set(F change, std::size_t which = 0) {
  const std::lock_guard lock(fake().lock);
  change(fake().arm[which]);
}
template <class F>
auto of(F ask, std::size_t which = 0) {
  const std::lock_guard lock(fake().lock);
  return ask(fake().arm[which]);
}
void place(double x, double y, double z, std::size_t which = 0) {
  set([&](test::FakeArm& arm) { arm.place = {x, y, z}; }, which);
}
// In the library's frame.
Vec3 last_force(std::size_t which = 0) {
  return of(
      [](const test::FakeArm& arm) {
        return arm.forces.empty() ? Vec3(Vec3::Zero()) : Vec3(arm.forces.back().newton.data());
      },
      which);
}
double last_up(std::size_t which = 0) { return last_force(which).z(); }

// A wire and its link without threads; only the test advances time.
struct ByHand {
  Omega omega;
  Link link{{.answer_timeout = 0}, &virtual_now};
  DeviceSpec spec;
  HandState hand;     // as the tick read it last
  bool there = true;  // result of the last exchange

  explicit ByHand(OmegaSettings settings = by_itself()) : omega(at_a_clock(std::move(settings))) {
    const auto connected = omega.connect();
    EXPECT_TRUE(connected.ok()) << connected.error().text;
    if (connected) spec = *connected;
  }
  static OmegaSettings at_a_clock(OmegaSettings settings) {
    set([](test::FakeArm& arm) { arm.rate = 0; });
    virtual_ns = 1'000'000'000;
    settings.now = &virtual_now;
    return settings;
  }
  // a millisecond with one exchange
  bool frame() {
    virtual_ns += 1'000'000;
    return there = exchange(omega, link);
  }
  // the same and one tick
  void step(const Vec3& force = Vec3::Zero()) {
    frame();
    hand = link.state();
    link.write_force(force);
  }
  bool valid() {
    step();
    return hand.valid;
  }
};

class OmegaTest : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("BURR_FORCEDIMENSION");
    begin(fake());
  }
  void TearDown() override { judge(fake()); }

  static std::string refused(OmegaSettings settings) {
    Omega omega(std::move(settings));
    const auto connected = omega.connect();
    EXPECT_FALSE(connected.ok());
    return connected ? "" : connected.error().text;
  }
  static WireDevice& made(std::unique_ptr<WireDevice>& device, OmegaSettings settings) {
    LinkSettings link;
    link.loss_timeout = test::kStallsAllowed;
    device = std::make_unique<WireDevice>(std::make_unique<Omega>(std::move(settings)), link);
    return *device;
  }
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// ---- properties

TEST_F(OmegaTest, SaysWhatItIsAndWhatItCanBear) {
  struct {
    int type;
    double peak, stiffness, damping, radius;
  } const known[] = {
      {33, 12, 5000, 30, 75e-3},   {34, 12, 5000, 30, 75e-3},   {36, 12, 5000, 30, 75e-3},
      {35, 12, 5000, 30, 75e-3},   {37, 12, 5000, 30, 75e-3},   {63, 20, 5000, 30, 150e-3},
      {206, 12, 4000, 30, 75e-3},  {104, 12, 4000, 30, 75e-3},  {105, 12, 4000, 30, 75e-3},
      {203, 12, 8000, 30, 112e-3}, {131, 12, 8000, 30, 112e-3}, {132, 12, 8000, 30, 112e-3},
      {108, 12, 8000, 30, 112e-3}, {109, 12, 8000, 30, 112e-3}, {60, 8, 3000, 20, 40e-3},
      {81, 8, 3000, 20, 40e-3},    {91, 8, 3000, 20, 40e-3},    {999, 8, 3000, 20, 40e-3},
  };
  for (const auto& one : known) {
    set([&](test::FakeArm& arm) { arm.type = one.type; });
    Omega omega(by_itself());
    const auto spec = omega.connect();
    ASSERT_TRUE(spec.ok()) << spec.error().text;
    EXPECT_EQ(spec->name, "omega.6");
    EXPECT_EQ(spec->serial, "1001");
    EXPECT_TRUE(spec->software.starts_with("SDK 3.")) << spec->software;
    EXPECT_EQ(spec->peak_force, one.peak) << one.type;
    EXPECT_LE(spec->continuous_force, spec->peak_force);
    EXPECT_EQ(spec->max_stiffness, one.stiffness) << one.type;
    EXPECT_EQ(spec->max_damping, one.damping) << one.type;
    EXPECT_EQ(spec->workspace_radius, one.radius) << one.type;
    EXPECT_EQ(spec->sensed, 6);
    EXPECT_EQ(spec->actuated, 3);
    EXPECT_EQ(spec->peak_torque, 0);
    EXPECT_EQ(spec->native_rate, 1000);
    EXPECT_FALSE(spec->simulated);
    EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.most_force; }), one.peak)
        << "the library bounds it as well";
    EXPECT_TRUE(of([](const test::FakeArm& arm) { return arm.force_on && arm.gravity; }));
    EXPECT_EQ(omega.why(), "");
  }
}

TEST_F(OmegaTest, AnArmWithoutAWristIsReadWithoutOne) {
  set([](test::FakeArm& arm) {
    arm.wrist = false;
    arm.type = 33;
  });
  ByHand by;
  EXPECT_EQ(by.spec.sensed, 3);
  EXPECT_TRUE(by.valid());
  EXPECT_EQ(by.hand.world_from_tool.q.coeffs(), math::Quat::Identity().coeffs());
}

TEST_F(OmegaTest, ALeftHandIsNamed) {
  set([](test::FakeArm& arm) { arm.left = true; });
  {
    Omega omega(by_itself());
    EXPECT_EQ(omega.connect()->name, "omega.6 (left hand)");
  }
  set([](test::FakeArm& arm) { arm.name = "omega.6 (left-hand)"; });
  Omega omega(by_itself());
  EXPECT_EQ(omega.connect()->name, "omega.6 (left-hand)");
}

TEST_F(OmegaTest, ARateIsTakenAsRequestedOrRefused) {
  for (const double rate : {500.0, 2500.0, 4000.0}) {
    OmegaSettings settings = by_itself();
    settings.rate = rate;
    Omega omega(settings);
    EXPECT_EQ(omega.connect()->native_rate, rate);
  }
  for (const double rate : {0.0, 499.0, 4001.0, kNan}) {
    OmegaSettings settings = by_itself();
    settings.rate = rate;
    EXPECT_TRUE(has(refused(settings), "500 to 4000"));
  }
}

// ---- axes and units

// Three movements. The library: x to the user, y right, z up. Ours: x right, y up, z to the user.
TEST_F(OmegaTest, TenMillimetresAndANewtonAreThoseAlongEveryAxis) {
  ByHand by;
  const Vec3 ours[] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 theirs = Vec3::Unit(axis);
    for (const double sign : {1.0, -1.0}) {
      place(sign * 0.01 * theirs.x(), sign * 0.01 * theirs.y(), sign * 0.01 * theirs.z());
      set([&](test::FakeArm& arm) {
        for (int n = 0; n < 3; ++n)
          arm.velocity[static_cast<std::size_t>(n)] = sign * 0.1 * theirs[n];
      });
      by.step(sign * ours[axis]);
      EXPECT_TRUE(by.hand.valid);
      EXPECT_NEAR((by.hand.world_from_tool.p - sign * 0.01 * ours[axis]).norm(), 0, 1e-15);
      EXPECT_NEAR((by.hand.velocity - sign * 0.1 * ours[axis]).norm(), 0, 1e-15);
      by.step();
      EXPECT_EQ(last_force(), sign * theirs)
          << "the force of a tick is on the wire with the next reading at the latest";
    }
  }
}

TEST_F(OmegaTest, TheHandleLiesAlongTheToolsZ) {
  ByHand by;
  by.step();
  EXPECT_NEAR((by.hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-15)
      << "to the user while nothing is turned";
  // a quarter turn about the library's up axis, to the right, with small errors as the library has
  // them
  set([](test::FakeArm& arm) { arm.frame = {1e-4, -1.0002, 0, 0.9999, 0, 1e-4, 0, 0, 1.0001}; });
  by.step();
  EXPECT_TRUE(by.hand.valid);
  EXPECT_NEAR((by.hand.world_from_tool.q * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0, 1e-3);
  EXPECT_NEAR((by.hand.world_from_tool.q * Vec3::UnitY() - Vec3::UnitY()).norm(), 0, 1e-3);
  EXPECT_NEAR(by.hand.world_from_tool.q.norm(), 1, 1e-12);
  // about its right axis: from the user downwards
  set([](test::FakeArm& arm) { arm.frame = {0, 0, 1, 0, 1, 0, -1, 0, 0}; });
  by.step();
  EXPECT_NEAR((by.hand.world_from_tool.q * Vec3::UnitZ() + Vec3::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR((by.hand.world_from_tool.q * Vec3::UnitX() - Vec3::UnitX()).norm(), 0, 1e-12);
}

TEST_F(OmegaTest, ButtonsAreReadAndNoneIsTheClutch) {
  ByHand by;
  set([](test::FakeArm& arm) { arm.buttons = 0x80000005; });
  by.step();
  EXPECT_EQ(by.hand.buttons, 5U);
}

TEST_F(OmegaTest, AGripperIsThePedalOnceItWasSeenOpen) {
  for (const double side : {1.0, -1.0}) {
    set([&](test::FakeArm& arm) {
      arm.gripper = true;
      arm.left = side < 0;
      arm.apart = 0;
    });
    ByHand by;
    const auto pedal = [&](double apart) {
      set([&](test::FakeArm& arm) { arm.apart = side * apart; });
      by.step();
      EXPECT_TRUE(by.hand.valid);
      return by.hand.pedal;
    };
    EXPECT_EQ(pedal(0), 0) << "held closed from the start";
    EXPECT_EQ(pedal(0.1), 0);
    EXPECT_EQ(pedal(0.5), 0) << "open: it counts from now on";
    EXPECT_EQ(pedal(0), 1);
    EXPECT_NEAR(pedal(0.2), 0.5, 1e-12);
    EXPECT_EQ(pedal(0.4), 0);
    EXPECT_EQ(pedal(kNan), 0);
    EXPECT_EQ(pedal(1.0), 0);
    EXPECT_NEAR(pedal(0.4), 0.5, 1e-12) << "a wider one is learnt";
  }
}

TEST_F(OmegaTest, AnArmWithoutAGripperHasNoPedal) {
  ByHand by;
  by.step();
  set([](test::FakeArm& arm) { arm.apart = 0; });
  by.step();
  EXPECT_EQ(by.hand.pedal, 0);
}

// ---- libraries

TEST_F(OmegaTest, ALibraryThatIsMissingIsNamedWithTheLoadersWords) {
  const std::string text = refused({.dhd_file = kFakes + "nowhere/libdrd.so"});
  EXPECT_TRUE(has(text, "No such file")) << text;
  EXPECT_TRUE(has(text, "nowhere/libdrd.so")) << text;
  EXPECT_TRUE(has(text, "BURR_FORCEDIMENSION")) << text;
}

TEST_F(OmegaTest, ASymbolThatIsMissingIsNamedWithTheVersion) {
  const std::string text = refused({.dhd_file = kFakes + "libdrd_broken.so"});
  EXPECT_TRUE(has(text, "dhdSetForceAndTorqueAndGripperForce")) << text;
  EXPECT_TRUE(has(text, "version 3.17.1")) << text;
}

TEST_F(OmegaTest, TheEnvironmentNamesALibrary) {
  setenv("BURR_FORCEDIMENSION", (kFakes + "libdrd_broken.so").c_str(), 1);
  EXPECT_TRUE(has(refused({}), "libdrd_broken.so"));
  setenv("BURR_FORCEDIMENSION", kLibrary.c_str(), 1);
  Omega omega;
  EXPECT_TRUE(omega.connect().ok());
  unsetenv("BURR_FORCEDIMENSION");
}

// Without status, serial number, name and the library's own limit on the force.
TEST_F(OmegaTest, AnOldLibraryServesAsFarAsItGoes) {
  test::FakeDhd& old = state_of(kFakes + "libdrd_old.so");
  begin(old);
  old.arm[0].rate = 0;
  OmegaSettings settings{.dhd_file = kFakes + "libdrd_old.so", .now = &virtual_now};
  {
    Omega omega(settings);
    const auto spec = omega.connect();
    ASSERT_TRUE(spec.ok()) << spec.error().text;
    EXPECT_EQ(spec->name, "omega.6");
    EXPECT_EQ(spec->serial, "");
    EXPECT_EQ(spec->peak_force, 12);
    HandState hand;
    EXPECT_EQ(omega.read(hand), Wire::Read::hand);
    EXPECT_TRUE(hand.valid);
    EXPECT_TRUE(omega.write({0, 100, 0}));
    EXPECT_EQ(old.arm[0].forces.back().newton[2], 12) << "bounded here, where nothing else does";
    EXPECT_EQ(old.arm[0].most_force, -1);
  }
  settings.serial = 1001;
  const std::string text = refused(settings);
  EXPECT_TRUE(has(text, "serial numbers")) << text;
  judge(old);
}

// With libdhd alone nobody knows whether the arm is homed, so the user must say it.
TEST_F(OmegaTest, WithoutDrdTheUserMustSayThatItIsHomed) {
  test::FakeDhd& alone = state_of(kFakes + "libdhd.so");
  begin(alone);
  OmegaSettings settings{.dhd_file = kFakes + "libdhd.so", .home_allowed = true};
  const std::string text = refused(settings);
  EXPECT_TRUE(has(text, "libdrd")) << text;
  EXPECT_TRUE(has(text, "`is_homed`")) << text;
  settings.is_homed = true;
  {
    Omega omega(settings);
    EXPECT_TRUE(omega.connect().ok());
    EXPECT_TRUE(alone.arm[0].force_on);
  }
  EXPECT_EQ(alone.arm[0].opened, 2U);
  judge(alone);
}

TEST_F(OmegaTest, LibrariesAreLookedForWhereTheMakerPutsThemTheNewestFirst) {
  const test::Folder folder;
  const std::filesystem::path& home = folder.path();
  const auto touch = [&](const std::string& name) {
    std::filesystem::create_directories((home / name).parent_path());
    std::ofstream(home / name) << "no library";
  };
  for (const char* name : {"libdhd.so.3.9.2", "libdhd.so.3.17.5", "libdhd.so.3.17.10",
                           "libdrd.so.3.9.0", "libdrd.so.3", "other.so"})
    touch(std::string(".local/lib/") + name);
#if defined(__x86_64__)
  touch("sdk/lib/release/lin-x86_64-gcc/libdhd.so.3.1.0");
  setenv("FDSDK", (home / "sdk").c_str(), 1);
#endif
  const std::string before = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
  setenv("HOME", home.c_str(), 1);
  std::vector<std::string> found = candidates();
  setenv("HOME", before.c_str(), 1);
  unsetenv("FDSDK");
  std::erase_if(found, [](const std::string& one) { return one.starts_with("/usr/local"); });
  std::vector<std::string> names;
  for (const std::string& one : found)
    names.push_back(std::filesystem::path(one).filename().string());
  const std::vector<std::string> wanted = {
    "libdrd.so.3",
    "libdhd.so.3",
    "libdrd.so",
    "libdhd.so",
#if defined(__x86_64__)
    "libdhd.so.3.1.0",
#endif
    "libdrd.so.3.9.0",
    "libdrd.so.3",
    "libdhd.so.3.17.10",
    "libdhd.so.3.17.5",
    "libdhd.so.3.9.2"
  };
  EXPECT_EQ(names, wanted);
  EXPECT_EQ(found[0], "libdrd.so.3") << "by name, for the loader";
}

// ---- choice of the device

TEST_F(OmegaTest, NoDeviceIsSaid) {
  set([](test::FakeArm& arm) { arm.present = false; });
  const std::string text = refused(by_itself());
  EXPECT_TRUE(has(text, "plug it in")) << text;
  EXPECT_TRUE(has(text, "udev")) << text;
}

TEST_F(OmegaTest, ADeviceInUseIsRefusedInWords) {
  set([](test::FakeArm& arm) { arm.in_use = true; });
  EXPECT_TRUE(has(refused(by_itself()), "another program"));
  set([](test::FakeArm& arm) { arm.in_use = false; });
  {
    Omega first(by_itself());
    ASSERT_TRUE(first.connect().ok());
    // the library would open it a second time
    const std::string text = refused(by_itself());
    EXPECT_TRUE(has(text, "this burr")) << text;
    EXPECT_TRUE(of([](const test::FakeArm& arm) { return arm.open && arm.force_on; }))
        << "the first one goes on";
  }
  Omega again(by_itself());
  EXPECT_TRUE(again.connect().ok());
}

TEST_F(OmegaTest, AnIndexOrANumberThatIsNotThereIsSaid) {
  OmegaSettings settings = by_itself();
  for (const int index : {1, 7, -1, 1000}) {
    settings.index = index;
    EXPECT_TRUE(has(refused(settings), "1 is plugged in")) << index;
  }
  settings = by_itself();
  settings.serial = 4711;
  EXPECT_TRUE(has(refused(settings), "4711"));
}

TEST_F(OmegaTest, ADeviceWithoutASerialNumberIsFoundByItsIndex) {
  set([](test::FakeArm& arm) { arm.serial = 0; });
  set(
      [](test::FakeArm& arm) {
        arm.present = true;
        arm.serial = 0;
      },
      1);
  OmegaSettings settings = by_itself();
  settings.index = 1;
  Omega omega(settings);
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(omega.connect()->serial, "");
    EXPECT_TRUE(of([](const test::FakeArm& arm) { return arm.open; }, 1));
    EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.open; }, 0));
    omega.disconnect();
  }
}

TEST_F(OmegaTest, ASerialNumberFindsItsDeviceWhereverItIs) {
  set([](test::FakeArm& arm) { arm.present = true; }, 1);
  set([](test::FakeArm& arm) { arm.present = true; }, 2);
  set([](test::FakeArm& arm) { arm.in_use = true; }, 0);
  OmegaSettings settings = by_itself();
  settings.serial = 1003;
  Omega omega(settings);
  const auto spec = omega.connect();
  ASSERT_TRUE(spec.ok()) << spec.error().text;
  EXPECT_EQ(spec->serial, "1003");
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.open; }, 1)) << "given back";
}

// ---- homing

TEST_F(OmegaTest, TheArmIsNeverHomedUnasked) {
  set([](test::FakeArm& arm) { arm.initialized = false; });
  const std::string text = refused(by_itself());
  EXPECT_TRUE(has(text, "`home_allowed`")) << text;
  EXPECT_TRUE(has(text, "move by itself")) << text;
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.homed; }), 0U);
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.open; }));
}

TEST_F(OmegaTest, WhereItMayItIsHomedBeforeForcesAreOn) {
  set([](test::FakeArm& arm) { arm.initialized = false; });
  OmegaSettings settings = by_itself();
  settings.home_allowed = true;
  Omega omega(settings);
  const auto connected = omega.connect();
  ASSERT_TRUE(connected.ok()) << connected.error().text;
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.homed; }), 1U);
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.regulates; }));
  EXPECT_TRUE(of([](const test::FakeArm& arm) { return arm.force_on; }));
}

TEST_F(OmegaTest, AnArmThatIsHomedIsNotHomedAgain) {
  OmegaSettings settings = by_itself();
  settings.home_allowed = true;
  Omega omega(settings);
  EXPECT_TRUE(omega.connect().ok());
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.homed; }), 0U);
}

TEST_F(OmegaTest, AHomingThatFailsIsSaidAndTheArmIsLetGo) {
  set([](test::FakeArm& arm) { arm.initialized = arm.can_home = false; });
  OmegaSettings settings = by_itself();
  settings.home_allowed = true;
  EXPECT_TRUE(has(refused(settings), "could not be homed"));
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.regulates; }));
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.force_on; }));
}

// During a session a person's hand may be on the arm.
TEST_F(OmegaTest, AnArmThatLostItsHomeInASessionIsNotHomedByItself) {
  OmegaSettings settings = by_itself();
  settings.home_allowed = true;
  Omega omega(settings);
  ASSERT_TRUE(omega.connect().ok());
  omega.disconnect();
  set([](test::FakeArm& arm) { arm.initialized = false; });
  const auto again = omega.connect();
  ASSERT_FALSE(again.ok());
  EXPECT_TRUE(has(again.error().text, "no longer homed")) << again.error().text;
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.homed; }), 0U);
}

// Homing takes seconds. Another arm that is closed meanwhile must not keep its force for so long.
TEST_F(OmegaTest, AnArmIsLetGoWhileAnotherOneHomes) {
  set([](test::FakeArm& arm) { arm.rate = 0; });
  set(
      [](test::FakeArm& arm) {
        arm.present = true;
        arm.initialized = false;
        arm.homes_after = 0;
      },
      1);
  Omega first(by_itself());
  ASSERT_TRUE(first.connect().ok());
  ASSERT_TRUE(first.write({0, 2, 0}));
  std::string trouble;
  std::thread other([&] {
    OmegaSettings settings = by_itself();
    settings.index = 1;
    settings.home_allowed = true;
    Omega second(settings);
    const auto connected = second.connect();
    if (!connected) trouble = connected.error().text;
  });
  EXPECT_TRUE(
      test::soon([] { return of([](const test::FakeArm& arm) { return arm.homed; }, 1) > 0; }));
  first.disconnect();
  other.join();
  EXPECT_EQ(trouble, "");
}

// ---- readings and forces that are not valid

TEST_F(OmegaTest, TimeGuardAndSaturatedMotorsAreSuccesses) {
  for (const int code : {1, 2}) {
    set([&](test::FakeArm& arm) { arm.code = code; });
    ByHand by;
    by.step({0, 1, 0});
    by.step();
    EXPECT_TRUE(by.there);
    EXPECT_TRUE(by.hand.valid);
    EXPECT_EQ(last_up(), 1);
    EXPECT_EQ(by.omega.why(), "");
  }
}

TEST_F(OmegaTest, WhatIsNoReadingIsNotBelieved) {
  ByHand by;
  EXPECT_TRUE(by.valid());
  const auto bad = [&](const std::function<void(test::FakeArm&)>& spoil) {
    set([&](test::FakeArm& arm) { spoil(arm); });
    EXPECT_FALSE(by.valid());
    EXPECT_TRUE(by.there);
    EXPECT_TRUE(has(by.omega.why(), "impossible")) << by.omega.why();
    set([](test::FakeArm& arm) {
      arm.place = arm.velocity = {};
      arm.frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    });
    EXPECT_TRUE(by.valid());
    EXPECT_EQ(by.omega.why(), "");
  };
  bad([](test::FakeArm& arm) { arm.place[0] = kNan; });
  bad([](test::FakeArm& arm) { arm.place[1] = kInf; });
  bad([](test::FakeArm& arm) { arm.place[2] = 1.5; });
  bad([](test::FakeArm& arm) { arm.velocity[1] = kNan; });
  bad([](test::FakeArm& arm) { arm.frame[4] = kNan; });
  bad([](test::FakeArm& arm) { arm.frame = {}; });
  bad([](test::FakeArm& arm) { arm.frame[0] = -1; });  // a mirror image
  bad([](test::FakeArm& arm) { arm.frame = {2, 0, 0, 0, 0.5, 0, 0, 0, 1}; });
  bad([](test::FakeArm& arm) { arm.frame[1] = 0.5; });  // sheared
}

// The library's estimate fails until it has two readings.
TEST_F(OmegaTest, AVelocityThatIsNotKnownYetIsNoLoss) {
  ByHand by;
  set([](test::FakeArm& arm) {
    arm.velocity = {1, 1, 1};
    arm.velocity_error = 7;
  });
  EXPECT_TRUE(by.valid());
  EXPECT_EQ(by.hand.velocity, Vec3::Zero());
}

TEST_F(OmegaTest, ADeviceThatIsGoneIsLostInWords) {
  for (const int code : {2, 4, 5, 6, 7}) {
    for (const bool reads : {true, false}) {
      ByHand by;
      by.step();
      set([&](test::FakeArm& arm) { (reads ? arm.read_error : arm.write_error) = code; });
      EXPECT_FALSE(by.frame());
      EXPECT_EQ(by.omega.why(), "omega.6 " + std::string(words(code)));
      set([](test::FakeArm& arm) { arm.read_error = arm.write_error = 0; });
    }
  }
}

TEST_F(OmegaTest, AnErrorThatPassesIsNoLossAndOneOfReadingThatStaysIs) {
  for (const bool reads : {true, false}) {
    ByHand by;
    by.step();
    by.step({0, 0.5, 0});
    const auto fails = [&](int code) {
      set([&](test::FakeArm& arm) { (reads ? arm.read_error : arm.write_error) = code; });
    };
    fails(8);
    by.step();
    by.step();
    EXPECT_TRUE(by.there);
    EXPECT_FALSE(by.hand.valid);
    EXPECT_FALSE(by.omega.why().empty());
    fails(0);
    by.step();
    by.step();
    EXPECT_TRUE(by.hand.valid);
    EXPECT_EQ(by.omega.why(), "");
    fails(8);
    int frames = 0;
    while (frames < 2000 && by.frame()) ++frames;
    EXPECT_EQ(frames, reads ? 499 : 2000) << "to open it anew would switch its forces on";
    fails(0);
  }
}

TEST_F(OmegaTest, EveryErrorCodeHasWordsOfItsOwn) {
  const int codes[] = {2, 3, 4, 5, 6, 7, 8, 12, 14, 20};
  for (const int code : codes)
    for (const int other : codes) {
      if (code != other) {
        EXPECT_STRNE(words(code), words(other));
      }
    }
  for (int code = -5; code < 30; ++code) EXPECT_GT(std::string(words(code)).size(), 20U);
}

TEST_F(OmegaTest, NoForceEverPassesTheArmsOwnLimit) {
  ByHand by;
  EXPECT_TRUE(by.omega.write({30, 40, 0}));
  EXPECT_NEAR(last_force().norm(), 12, 1e-12);
  EXPECT_NEAR(last_force().y() / last_force().z(), 0.75, 1e-12);
  for (const double no : {kNan, kInf}) {
    EXPECT_TRUE(by.omega.write({0, no, 0}));
    EXPECT_EQ(last_force(), Vec3::Zero());
  }
}

// ---- torque

// The library's frame is x to the user, y right, z up, for torques as for forces.
TEST_F(OmegaTest, AWristWithMotorsIsTurnedAboutEveryAxisAndNoFurtherThanItMay) {
  set([](test::FakeArm& arm) {
    arm.type = 104;
    arm.active_wrist = true;
  });
  ByHand by;
  EXPECT_EQ(by.spec.actuated, 6);
  EXPECT_EQ(by.spec.peak_torque, 0.2);
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.most_torque; }), 0.2)
      << "the library bounds it as well";
  const auto last_torque = [] {
    return of([](const test::FakeArm& arm) { return Vec3(arm.forces.back().newton_metre.data()); });
  };
  const auto tick = [&by](const Vec3& torque) {
    static_cast<void>(by.link.state());
    by.link.write_torque(torque);
    by.link.write_force({0, 1, 0});
    by.frame();
  };
  by.frame();
  const Vec3 ours[] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
  for (int axis = 0; axis < 3; ++axis) {
    tick(0.1 * ours[axis]);
    EXPECT_NEAR((last_torque() - 0.1 * Vec3::Unit(axis)).norm(), 0, 1e-15) << axis;
    EXPECT_EQ(last_force(), Vec3::UnitZ());
  }
  tick({3, 0, 4});
  EXPECT_NEAR(last_torque().norm(), 0.2, 1e-15);
  EXPECT_NEAR(last_torque().y() / last_torque().x(), 0.75, 1e-12);
  tick({kNan, 0, 0});
  EXPECT_EQ(last_torque(), Vec3::Zero());
  by.step({0, 1, 0});  // of a tick that writes no torque
  by.frame();
  EXPECT_EQ(last_torque(), Vec3::Zero());
  tick(0.1 * Vec3::UnitX());
  set([](test::FakeArm& arm) { arm.off_cause = 1; });
  for (int n = 0; n < 60; ++n) tick(0.1 * Vec3::UnitX());
  EXPECT_EQ(last_torque(), Vec3::Zero()) << "its forces are off";
}

TEST_F(OmegaTest, AWristWithoutMotorsIsNeverTurned) {
  for (const bool wrist : {true, false}) {  // the fake then counts a torque as misuse
    set([wrist](test::FakeArm& arm) {
      arm.wrist = wrist;
      arm.active_wrist = !wrist;  // motors of a wrist that is not there
      arm.type = wrist ? 34 : 33;
    });
    ByHand by;
    EXPECT_EQ(by.spec.peak_torque, 0);
    EXPECT_EQ(by.spec.actuated, 3);
    by.frame();
    static_cast<void>(by.link.state());
    by.link.write_torque({0.1, 0, 0});
    by.link.write_force({0, 1, 0});
    by.frame();
    EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.largest_torque; }), 0);
  }
}

// ---- forces that the arm itself switched off

TEST_F(OmegaTest, WhyForcesAreOffIsToldAndNothingIsPushedMeanwhile) {
  const std::pair<int, const char*> known[] = {{1, "button was pressed"},
                                               {2, "too fast"},
                                               {3, "watchdog"},
                                               {4, "program"},
                                               {5, "USB"},
                                               {6, "hand"}};
  for (const auto& [cause, word] : known) {
    ByHand by;
    by.step();
    by.step({0, 2, 0});
    by.step({0, 2, 0});
    EXPECT_EQ(last_up(), 2);
    set([&, why = cause](test::FakeArm& arm) { arm.off_cause = why; });
    int ticks = 0;
    for (; by.hand.valid && ticks < 1000; ++ticks) by.step({0, 2, 0});
    EXPECT_LE(ticks, 51) << "looked at twenty times a second";
    EXPECT_TRUE(has(by.omega.why(), word)) << by.omega.why();
    EXPECT_TRUE(by.there);
    by.step({0, 2, 0});  // a tick that ignores it
    EXPECT_EQ(last_up(), 0);
    set([](test::FakeArm& arm) { arm.off_cause = 0; });
    for (int n = 0; n < 60; ++n) by.step();
    EXPECT_TRUE(by.hand.valid);
    EXPECT_EQ(by.omega.why(), "");
  }
}

// It releases the force when burr dies or hangs: 30 ms; a shorter timeout is left as it is.
TEST_F(OmegaTest, TheArmsOwnWatchdogIsSetAndTheExpertModeClosedAgain) {
  for (const bool guarded : {false, true})
    for (const auto& [was, is] : {std::pair{0, 240}, {250, 240}, {80, 80}}) {
      set([&, was = was](test::FakeArm& arm) { arm.watchdog = was; });
      {
        const std::lock_guard lock(fake().lock);
        fake().guards_watchdog = guarded;
      }
      const ByHand by;
      EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.watchdog; }), is) << guarded << was;
      const std::lock_guard lock(fake().lock);
      EXPECT_FALSE(fake().expert);
      fake().guards_watchdog = false;
    }
}

TEST_F(OmegaTest, AWireThatStandsForLongIsLetGoByTheArmItselfAndSaysSo) {
  set([](test::FakeArm& arm) { arm.watches = true; });
  std::unique_ptr<WireDevice> device;
  ASSERT_TRUE(made(device, by_itself()).open().ok());
  test::StandIn tick(*device, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
  set([](test::FakeArm& arm) { arm.stall_ms = 100; });
  EXPECT_TRUE(test::soon([&] { return has(device->trouble(), "watchdog"); })) << device->trouble();
  EXPECT_TRUE(test::soon([&] { return !tick.hand().valid && last_force() == Vec3::Zero(); }));
}

TEST_F(OmegaTest, PowerThatFailsIsToldAndAConnectionThatFailsIsALoss) {
  {
    ByHand by;
    by.step();
    set([](test::FakeArm& arm) { arm.power = 0; });
    for (int n = 0; n < 60; ++n) by.step();
    EXPECT_TRUE(by.there);
    EXPECT_FALSE(by.hand.valid);
    EXPECT_TRUE(has(by.omega.why(), "power")) << by.omega.why();
  }
  set([](test::FakeArm& arm) { arm.power = 1; });
  ByHand by;
  by.step();
  set([](test::FakeArm& arm) { arm.connected = 0; });
  int frames = 0;
  while (by.frame() && frames < 100) ++frames;
  EXPECT_LE(frames, 51);
  EXPECT_TRUE(has(by.omega.why(), "no longer connected")) << by.omega.why();
}

// Some model may leave the whole status at zero.
TEST_F(OmegaTest, AStatusThatNeverSaidAnythingIsNotBelieved) {
  set([](test::FakeArm& arm) { arm.tells = false; });
  ByHand by;
  for (int n = 0; n < 200; ++n) EXPECT_TRUE(by.valid());
  EXPECT_EQ(by.omega.why(), "");
  EXPECT_GT(of([](const test::FakeArm& arm) { return arm.asked; }), 2U);
}

// ---- time

// The tick stops for 50 ms: the last force fades to zero, once, within 5 ms of the loss.
TEST_F(OmegaTest, AStalledTickIsLetGoLinearly) {
  ByHand by;
  by.step({0, 2, 0});
  by.step({0, 2, 0});
  std::vector<double> sent;
  for (int n = 0; n < 50; ++n) {
    by.frame();
    sent.push_back(last_up());
  }
  EXPECT_EQ(sent[0], 2);
  for (std::size_t n = 1; n < sent.size(); ++n) {
    EXPECT_LE(sent[n], sent[n - 1]);
    EXPECT_LE(sent[n - 1] - sent[n], 0.4 + 1e-9);
  }
  EXPECT_EQ(sent[5], 2) << "detected";
  EXPECT_NEAR(sent[7], 1.2, 1e-9);
  EXPECT_EQ(sent[10], 0);
  EXPECT_EQ(sent.back(), 0);
  // the tick continues: no force until it has been at zero itself
  by.step({0, 2, 0});
  EXPECT_FALSE(by.hand.valid);
  by.step({0, 2, 0});
  by.step({0, 0, 0});
  EXPECT_EQ(last_up(), 0);
  by.step({0, 0.5, 0});
  by.step();
  EXPECT_EQ(last_up(), 0.5);
}

// The arm stops for 50 ms in a write: the tick knows it within the timeout.
TEST_F(OmegaTest, AWireThatStandsIsALostHand) {
  ByHand by;
  by.step({0, 2, 0});
  by.step({0, 2, 0});
  virtual_ns += 4'000'000;
  EXPECT_TRUE(by.link.state().valid);
  virtual_ns += 1'000'000;
  EXPECT_FALSE(by.link.state().valid);
}

TEST_F(OmegaTest, ARunningSessionPushesAndLetsGo) {
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  EXPECT_EQ(device.spec().name, "omega.6");
  {
    test::StandIn tick(device, [](const HandState& hand) {
      return Vec3(0, -400 * std::min(0.0, hand.world_from_tool.p.y()), 0);
    });
    ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
    place(0, 0, -0.005);
    EXPECT_TRUE(test::soon([] { return last_up() > 1.9; }));
    EXPECT_LE(last_up(), 2 + 1e-12);
    EXPECT_EQ(device.trouble(), "");
    place(0, 0, 0.005);
    EXPECT_TRUE(test::soon([] { return last_force() == Vec3::Zero(); }));
  }
  device.close();
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.open || arm.force_on; }));
  EXPECT_GT(of([](const test::FakeArm& arm) { return arm.forces.back().ns; }), 0);
}

// Ended in contact and started again: not with the old force.
TEST_F(OmegaTest, ASecondSessionBeginsWithNoForce) {
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  {
    test::StandIn tick(device, [](const HandState&) { return Vec3(0, 0.04, 0); });
    ASSERT_TRUE(test::soon([] { return last_up() == 0.04; }));
    device.close();
  }
  device.write_force({0, 2, 0});  // from a tick that ends after the device was closed
  set([](test::FakeArm& arm) { arm.largest_force = 0; });
  ASSERT_TRUE(device.open().ok());
  const auto reads = of([](const test::FakeArm& arm) { return arm.reads; });
  ASSERT_TRUE(test::soon(
      [&] { return of([](const test::FakeArm& arm) { return arm.reads; }) > reads + 30; }));
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.largest_force; }), 0);
  device.close();
}

TEST_F(OmegaTest, WhatIsWrongIsToldWhileTheSessionGoesOn) {
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  test::StandIn tick(device, [](const HandState&) { return Vec3(0, 0.04, 0); });
  ASSERT_TRUE(test::soon([] { return last_up() == 0.04; }));
  set([](test::FakeArm& arm) { arm.off_cause = 1; });
  EXPECT_TRUE(test::soon([&] { return has(device.trouble(), "button"); }));
  EXPECT_FALSE(tick.engaged());
  set([](test::FakeArm& arm) { arm.off_cause = 0; });
  EXPECT_TRUE(test::soon([&] { return device.trouble().empty(); }));
  EXPECT_TRUE(test::soon([&] { return tick.engaged(); }));
  tick.stop();
  device.close();
  EXPECT_EQ(device.reconnections(), 0) << "it was never lost";
}

TEST_F(OmegaTest, PulledOutInContactItLetsGoAndComesBackByTheRamp) {
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  std::atomic<bool> wall = false;
  test::StandIn tick(device, [&](const HandState&) { return Vec3(0, wall ? 2.0 : 0.0, 0); });
  ASSERT_TRUE(test::soon([&] { return tick.engaged(); }));
  wall = true;
  ASSERT_TRUE(test::soon([] { return last_up() > 1.9; }));
  set([](test::FakeArm& arm) { arm.present = false; });
  ASSERT_TRUE(test::soon([&] { return !device.trouble().empty(); }));
  ASSERT_TRUE(test::soon([&] { return tick.invalid() > 0; }));
  // not found yet
  ASSERT_TRUE(test::soon([&] { return has(device.trouble(), "plug it in"); })) << device.trouble();
  EXPECT_FALSE(tick.engaged());
  const auto writes = of([](const test::FakeArm& arm) { return arm.writes; });
  set([](test::FakeArm& arm) {
    arm.present = true;
    arm.force_on = false;
    arm.largest_force = 0;
  });
  ASSERT_TRUE(test::soon(
      [&] { return of([](const test::FakeArm& arm) { return arm.writes; }) > writes + 50; }));
  EXPECT_EQ(device.reconnections(), 1);
  EXPECT_EQ(device.trouble(), "");
  EXPECT_FALSE(tick.engaged()) << "the wall is still there: it waits for a small force";
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.largest_force; }), 0);
  wall = false;
  EXPECT_TRUE(test::soon([&] { return tick.engaged(); }));
  tick.stop();
  device.close();
}

TEST_F(OmegaTest, AnotherDeviceThanBeforeIsNotTaken) {
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  set([](test::FakeArm& arm) { arm.present = false; });
  set([](test::FakeArm& arm) { arm.present = true; }, 1);
  EXPECT_TRUE(test::soon([&] { return has(device.trouble(), "1001 was not found"); }))
      << device.trouble();
  EXPECT_FALSE(of([](const test::FakeArm& arm) { return arm.force_on; }, 1));
  set([](test::FakeArm& arm) { arm.present = true; });
  EXPECT_TRUE(test::soon([&] { return device.trouble().empty(); }));
  EXPECT_EQ(device.reconnections(), 1);
  device.close();
}

TEST_F(OmegaTest, AnotherModelWithoutASerialNumberIsNotTakenEither) {
  for (const std::size_t which : {0U, 1U})
    set(
        [&](test::FakeArm& arm) {
          arm.serial = 0;
          arm.type = which == 0 ? 34 : 63;
        },
        which);
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  set([](test::FakeArm& arm) { arm.present = false; });
  set([](test::FakeArm& arm) { arm.present = true; }, 1);
  EXPECT_TRUE(test::soon([&] { return has(device.trouble(), "Another device"); }))
      << device.trouble();
  EXPECT_EQ(device.reconnections(), 0);
  device.close();
}

// A reading every 10 ms, a tick every millisecond, a wall that wants 2 N.
TEST_F(OmegaTest, AtAHundredHertzNothingIsPushed) {
  ByHand by;
  haptics::ForceLimit limit(by.spec, {});
  std::uint32_t flags = 0;
  double most = 0;
  const auto run = [&](int milliseconds, int every, double wanted) {
    for (int n = 0; n < milliseconds; ++n) {
      virtual_ns += 1'000'000;
      if (n % every == 0) by.there = exchange(by.omega, by.link);
      const bool usable = limit.accept_reading(by.link.state(), flags);
      by.link.write_force(limit.apply({0, usable ? wanted : 0, 0}, 1e-3, flags));
      most = std::max(most, last_up());
    }
  };
  run(20, 1, 0);
  run(1000, 1, 2);
  EXPECT_NEAR(most, 2, 1e-9) << "at its own rate it pushes";
  EXPECT_EQ(flags & rt::kFlagHandLost, 0U);
  run(20, 10, 2);
  EXPECT_NE(flags & rt::kFlagHandLost, 0U);
  most = 0;
  run(2000, 10, 2);
  EXPECT_EQ(most, 0);
}

// Between two ticks there may be as much time as the machine needs, but never less than the
// device's period.
TEST_F(OmegaTest, AtFourKilohertzTheTickKeepsItsPace) {
  set([](test::FakeArm& arm) { arm.rate = 4000; });
  std::unique_ptr<WireDevice> kept;
  WireDevice& device = made(kept, by_itself());
  ASSERT_TRUE(device.open().ok());
  const std::int64_t before = rt::monotonic_ns();
  test::StandIn tick(device, [](const HandState&) { return Vec3(0, 0.04, 0); });
  EXPECT_TRUE(test::soon([] { return last_up() == 0.04; }));
  EXPECT_TRUE(test::soon([&] { return tick.ticks() > 200; }));
  tick.stop();
  const double ms = 1e-6 * static_cast<double>(rt::monotonic_ns() - before);
  EXPECT_LE(static_cast<double>(tick.ticks()), ms / 0.875 + 3);
  device.close();
}

TEST_F(OmegaTest, TwoAtOnceEachHasItsOwnForceAndItsOwnLoss) {
  set([](test::FakeArm& arm) { arm.present = true; }, 1);
  std::unique_ptr<WireDevice> kept_first, kept_second;
  WireDevice& first = made(kept_first, by_itself());
  OmegaSettings other = by_itself();
  other.index = 1;
  WireDevice& second = made(kept_second, other);
  ASSERT_TRUE(first.open().ok());
  ASSERT_TRUE(second.open().ok());
  EXPECT_EQ(first.spec().serial, "1001");
  EXPECT_EQ(second.spec().serial, "1002");
  {
    test::StandIn one(first, [](const HandState&) { return Vec3(0, 0.04, 0); });
    test::StandIn two(second, [](const HandState&) { return Vec3(0.03, 0, 0); });
    EXPECT_TRUE(test::soon([] { return last_up() == 0.04 && last_force(1) == Vec3(0, 0.03, 0); }));
    set([](test::FakeArm& arm) { arm.present = false; });
    EXPECT_TRUE(test::soon([&] { return !first.trouble().empty(); }));
    // the second one has another index now
    const auto writes = of([](const test::FakeArm& arm) { return arm.writes; }, 1);
    EXPECT_TRUE(test::soon(
        [&] { return of([](const test::FakeArm& arm) { return arm.writes; }, 1) > writes + 50; }));
    EXPECT_EQ(second.trouble(), "");
    EXPECT_EQ(second.reconnections(), 0);
    one.stop();
    two.stop();
  }
  first.close();
  EXPECT_TRUE(of([](const test::FakeArm& arm) { return arm.open; }, 1));
  second.close();
}

// ---- long runs

// Whatever is requested and whatever the hand does, the force on the wire never exceeds the
// device's limit.
TEST_F(OmegaTest, AMillionWildTicksNeverPassTheLimit) {
  ByHand by;
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  constexpr double kUsers = 5;
  haptics::ForceLimit limit(by.spec, {.user_force = kUsers});
  double x = 0;
  Vec3 pull = Vec3::Zero();
  for (int n = 0; n < 1'000'000; ++n) {
    const auto dice = static_cast<unsigned>(random() % 2000);
    x = std::clamp(x + 1e-3 * any(random), -0.07, 0.07);
    if (dice == 0) x = 0.2 * any(random);
    place(dice == 1 ? kNan : x, 0, 0);
    set([&](test::FakeArm& arm) {
      arm.read_error = dice == 2 ? 8 : 0;
      arm.write_error = dice == 3 ? 12 : 0;
      arm.off_cause = dice == 4 ? 2 : 0;
      arm.code = static_cast<int>(dice % 3);
    });
    if (dice == 5) by.link.scale_force(std::abs(any(random)));
    const int frames = dice < 8 ? static_cast<int>(dice) : 1;
    for (int k = 0; k < frames; ++k) by.frame();
    const HandState hand = by.link.state();
    std::uint32_t flags = 0;
    if (dice < 20)  // for some hundred ticks, otherwise the force never grows
      pull = std::pow(10.0, 3 * any(random)) * Vec3(any(random), any(random), any(random));
    Vec3 wanted = pull;
    if (dice == 9) wanted.setConstant(kInf);
    if (dice == 10) wanted.setConstant(kNan);
    if (n % 1000 < 20) wanted.setZero();
    if (!limit.accept_reading(hand, flags)) wanted.setZero();
    by.link.write_force(limit.apply(wanted, 1e-3, flags));
  }
  const double largest = of([](const test::FakeArm& arm) { return arm.largest_force; });
  EXPECT_GT(largest, kUsers - 0.1) << "seed " << seed;
  EXPECT_LE(largest, kUsers + 1e-9) << "seed " << seed;
}

TEST_F(OmegaTest, OpenedAndClosedManyTimesNothingIsLeft) {
  const int rounds = test::rounds();
  set([](test::FakeArm& arm) { arm.rate = 4000; });
  {
    std::unique_ptr<WireDevice> kept;
    ASSERT_TRUE(made(kept, by_itself()).open().ok());
  }
  const int files = test::open_files();
  for (int n = 0; n < rounds; ++n) {
    std::unique_ptr<WireDevice> kept;
    ASSERT_TRUE(made(kept, by_itself()).open().ok()) << n;
  }
  EXPECT_EQ(test::open_files(), files);
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.opened; }),
            static_cast<std::uint64_t>(rounds) + 1);
  EXPECT_EQ(of([](const test::FakeArm& arm) { return arm.closed; }),
            static_cast<std::uint64_t>(rounds) + 1);
}

TEST_F(OmegaTest, TheExchangeTakesNoMemoryAndNoLock) {
  set([](test::FakeArm& arm) { arm.gripper = true; });
  ByHand by;
  by.step();
  // the fake library allocates memory when it first fails on a thread
  set([](test::FakeArm& arm) { arm.read_error = 8; });
  by.step();
  set([](test::FakeArm& arm) { arm.read_error = 0; });
  by.step();
  const test::RtGuard guard;
  for (int n = 0; n < 200; ++n) {
    by.step({0, 0.5, 0});
    const std::lock_guard lock(fake().lock);
    test::FakeArm& arm = fake().arm[0];
    arm.off_cause = n == 60 ? 1 : 0;
    arm.place[0] = n == 120 ? kNan : 0;
    arm.read_error = n == 130 ? 8 : 0;
    arm.write_error = n == 140 ? 8 : 0;
  }
  set([](test::FakeArm& arm) { arm.read_error = 2; });
  by.frame();
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

}  // namespace
}  // namespace burr::device::forcedimension
