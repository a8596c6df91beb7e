// The doctor on a computer made of files, and with libraries that crash or hang.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "device/fake/fake_hd.h"
#include "doctor/doctor_checks.h"
#include "doctor/finding.h"
#include "doctor/fix.h"
#include "doctor/run_in_process.h"
#include "support/folder.h"
#include "support/test_places.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// ---- a process apart

TEST(ProcessResult, GivesBackTheWords) {
  const ProcessResult seen =
      run_in_process([] { return std::string("all is well"); }, milliseconds(10'000));
  EXPECT_TRUE(seen.ended);
  EXPECT_EQ(seen.words, "all is well");
}

TEST(ProcessResult, SurvivesACrashAnEndAndAHang) {
  const ProcessResult crash = run_in_process(
      []() -> std::string {
        std::signal(SIGABRT, SIG_DFL);
        std::abort();
      },
      milliseconds(10'000));
  EXPECT_FALSE(crash.ended);
  EXPECT_NE(crash.words.find("crashed"), std::string::npos) << crash.words;
  const ProcessResult end = run_in_process([]() -> std::string { _exit(3); }, milliseconds(10'000));
  EXPECT_FALSE(end.ended);
  EXPECT_NE(end.words.find("exit code 3"), std::string::npos) << end.words;
  const ProcessResult hang = run_in_process(
      [] {
        std::this_thread::sleep_for(std::chrono::hours(1));
        return std::string("late");
      },
      milliseconds(100));
  EXPECT_FALSE(hang.ended);
  EXPECT_NE(hang.words.find("hung"), std::string::npos) << hang.words;
}

TEST(ProcessResult, WordsWithoutEndAreCut) {
  const ProcessResult seen =
      run_in_process([] { return std::string(100'000, 'x'); }, milliseconds(10'000));
  EXPECT_TRUE(seen.ended);
  EXPECT_EQ(seen.words.size(), 4096U);
}

// ---- nodes, on a computer of files

class DoctorNodes : public ::testing::Test {
 protected:
  void SetUp() override {
    system_.root = folder_.path();
    fs::create_directories(system_.root / "sys/bus/usb/devices");
    system_.may_use = [this](const fs::path& node) {
      asked_.push_back(node);
      return allowed_;
    };
  }
  const burr::test::Folder folder_;

  void plug(const std::string& place, const std::string& vendor, const std::string& product,
            int number) {
    const fs::path device = system_.root / "sys/bus/usb/devices" / place;
    fs::create_directories(device);
    std::ofstream(device / "idVendor") << vendor << "\n";
    std::ofstream(device / "idProduct") << product << "\n";
    std::ofstream(device / "busnum") << "1\n";
    std::ofstream(device / "devnum") << number << "\n";
  }

  System system_;
  bool allowed_ = true;
  std::vector<fs::path> asked_;
};

TEST_F(DoctorNodes, NothingPluggedInIsNoTrouble) {
  const auto findings = look_at_nodes(system_);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].health, Health::absent);
}

TEST_F(DoctorNodes, KnowsMakersByTheirNumbersAndNoOthers) {
  plug("1-1", "1451", "0402", 7);
  plug("1-2", "0403", "cb48", 8);
  plug("1-3", "0403", "6001", 9);  // another product with the same maker's chip
  plug("1-4", "16c0", "0483", 10);
  plug("1-5", "046d", "c077", 11);
  const auto findings = look_at_nodes(system_);
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(findings[0].what, "Force Dimension");
  EXPECT_EQ(findings[1].what, "Novint Falcon");
  EXPECT_EQ(findings[2].what, "Polhem, WoodenHaptics");
  for (const Finding& one : findings) EXPECT_EQ(one.health, Health::good);
  EXPECT_NE(findings[0].value.find("/dev/bus/usb/001/007"), std::string::npos) << findings[0].value;
}

TEST_F(DoctorNodes, ANodeThatMayNotBeOpenedIsNamedWithTheCure) {
  plug("1-1", "1451", "0402", 7);
  allowed_ = false;
  auto findings = look_at_nodes(system_);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].health, Health::trouble);
  EXPECT_NE(findings[0].value.find("/dev/bus/usb/001/007"), std::string::npos);
  EXPECT_NE(findings[0].todo.find("doctor --fix"), std::string::npos);
  // the rule exists already, so the advice is another one
  fs::create_directories(udev_file(system_).parent_path());
  std::ofstream(udev_file(system_)) << udev_rules();
  findings = look_at_nodes(system_);
  EXPECT_EQ(findings[0].todo.find("--fix"), std::string::npos);
  EXPECT_NE(findings[0].todo.find("plug it in again"), std::string::npos);
}

TEST_F(DoctorNodes, SerialLinesAndRawHidBelowADeviceAreAskedForToo) {
  plug("1-1", "16c0", "0486", 7);
  fs::create_directories(system_.root / "sys/bus/usb/devices/1-1/1-1:1.0/tty/ttyACM0");
  fs::create_directories(system_.root /
                         "sys/bus/usb/devices/1-1/1-1:1.1/0003:16C0:0486.0001/hidraw/hidraw3");
  static_cast<void>(look_at_nodes(system_));
  ASSERT_EQ(asked_.size(), 3U);
  EXPECT_NE(std::find(asked_.begin(), asked_.end(), system_.root / "dev/ttyACM0"), asked_.end());
  EXPECT_NE(std::find(asked_.begin(), asked_.end(), system_.root / "dev/hidraw3"), asked_.end());
}

// The two forms in which a Touch was sold: a serial line, and since 2023 a raw HID node.
TEST_F(DoctorNodes, TellsTheTwoTouchesApart) {
  const fs::path devices = system_.root / "sys/bus/usb/devices";
  plug("1-1", "2988", "0302", 7);
  fs::create_directories(devices / "1-1/1-1:1.0/tty/ttyACM0");
  std::ofstream(devices / "1-1/1-1:1.0/bInterfaceClass") << "02\n";
  plug("1-2", "abcd", "0001", 8);  // a number that nobody published, by its maker's name
  std::ofstream(devices / "1-2/manufacturer") << "3D Systems\n";
  fs::create_directories(devices / "1-2/1-2:1.0/0003:ABCD:0001.0004/hidraw/hidraw5");
  std::ofstream(devices / "1-2/1-2:1.0/bInterfaceClass") << "03\n";
  auto findings = look_at_nodes(system_);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].what, "3D Systems Touch HID");
  EXPECT_EQ(findings[0].health, Health::good);
  EXPECT_NE(findings[0].value.find("/dev/hidraw5"), std::string::npos) << findings[0].value;
  EXPECT_NE(findings[0].todo.find("has no ttyACM"), std::string::npos) << findings[0].todo;
  EXPECT_EQ(findings[1].what, "3D Systems Touch USB");
  EXPECT_NE(findings[1].value.find("/dev/ttyACM0"), std::string::npos) << findings[1].value;
  EXPECT_NE(findings[1].todo.find("out of sale"), std::string::npos) << findings[1].todo;
  // its driver has not taken the node
  fs::remove_all(devices / "1-2/1-2:1.0/0003:ABCD:0001.0004");
  findings = look_at_nodes(system_);
  EXPECT_EQ(findings[0].health, Health::trouble);
  EXPECT_NE(findings[0].value.find("no hidraw node"), std::string::npos) << findings[0].value;
  // nor may it be opened: burr's own rule does not name this number
  fs::create_directories(devices / "1-2/1-2:1.0/0003:ABCD:0001.0004/hidraw/hidraw5");
  allowed_ = false;
  findings = look_at_nodes(system_);
  EXPECT_NE(findings[0].todo.find("3D Systems' driver"), std::string::npos) << findings[0].todo;
  EXPECT_NE(findings[1].todo.find("doctor --fix"), std::string::npos) << findings[1].todo;
  // neither a serial line nor HID: it is not said which
  fs::remove_all(devices / "1-1");
  allowed_ = true;
  plug("1-3", "2988", "0301", 9);
  findings = look_at_nodes(system_);
  EXPECT_EQ(findings[0].what, "3D Systems Touch");
}

TEST(DoctorRules, NameEveryMakerOnceForEachKindOfNode) {
  const std::string rules = udev_rules();
  for (const char* words :
       {"SUBSYSTEM==\"usb\", ATTRS{idVendor}==\"1451\", MODE", "ATTRS{idProduct}==\"cb48\"",
        "ATTRS{idProduct}==\"04*\"", "SUBSYSTEM==\"tty\"", "SUBSYSTEM==\"hidraw\"", "uaccess"})
    EXPECT_NE(rules.find(words), std::string::npos) << words << "\n" << rules;
}

// ---- devices

class DoctorDevices : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("HAPLY_WS_PORT", "1", 1);
    ::setenv("BURR_FORCEDIMENSION", "/nowhere/libdrd.so", 1);
    system_.maker_timeout = milliseconds(20'000);
  }
  void TearDown() override {
    for (const char* name : {"HAPLY_WS_PORT", "BURR_FORCEDIMENSION", "BURR_OPENHAPTICS"})
      ::unsetenv(name);
  }
  Finding of(const std::string& what) {
    for (Finding& one : look_at_devices(system_))
      if (one.what == what) return one;
    ADD_FAILURE() << what << " was not looked at";
    return {};
  }
  System system_;
};

TEST_F(DoctorDevices, WhatIsMissingIsSaidWithTheLoadersWordsAndWhatToInstall) {
  ::setenv("BURR_OPENHAPTICS", "/nowhere/libHD.so", 1);
  const Finding touch = of("touch");
  EXPECT_EQ(touch.health, Health::absent);
  EXPECT_NE(touch.value.find("No such file"), std::string::npos) << touch.value;
  EXPECT_NE(touch.todo.find("install"), std::string::npos) << touch.todo;
  EXPECT_NE(touch.todo.find("docs/use/devices/touch.md"), std::string::npos);
  const Finding haply = of("haply");
  EXPECT_EQ(haply.health, Health::absent);
  EXPECT_NE(haply.value.find(":1"), std::string::npos) << haply.value;
}

TEST_F(DoctorDevices, AMissingSymbolIsNamed) {
  ::setenv("BURR_OPENHAPTICS", (test::build_dir() + "/fakes/libHD_old.so").c_str(), 1);
  EXPECT_NE(of("touch").value.find("hdScheduleAsynchronous"), std::string::npos);
}

TEST_F(DoctorDevices, ADeviceThatIsThereIsNamedAndCanBeTried) {
  ::setenv("BURR_OPENHAPTICS", (test::build_dir() + "/fakes/libHD.so").c_str(), 1);
  const Finding touch = of("touch");
  EXPECT_EQ(touch.health, Health::good);
  EXPECT_NE(touch.value.find("T-0001"), std::string::npos) << touch.value;
  EXPECT_EQ(touch.todo, "burr devices test touch");
}

TEST_F(DoctorDevices, ADeviceThatIsThereAndInTroubleIsToldAsThat) {
  const std::string library = test::build_dir() + "/fakes/libHD.so";
  void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL);
  ASSERT_NE(loaded, nullptr);
  test::FakeHd& hd = *reinterpret_cast<test::FakeHdState>(dlsym(loaded, "fake_hd"))();
  hd.touch[0].calibration = 0x5001;  // must be calibrated, and only
  hd.touch[0].style = 4;             // in the inkwell
  ::setenv("BURR_OPENHAPTICS", library.c_str(), 1);
  const Finding touch = of("touch");
  hd.touch[0] = {};
  EXPECT_EQ(touch.health, Health::trouble);
  EXPECT_NE(touch.value.find("T-0001"), std::string::npos) << touch.value;
  EXPECT_NE((touch.value + touch.todo).find("inkwell"), std::string::npos)
      << touch.value << touch.todo;
}

TEST_F(DoctorDevices, ALibraryThatCrashesOrHangsDoesSoAlone) {
  ::setenv("BURR_OPENHAPTICS", (test::build_dir() + "/fakes/libHD_crash.so").c_str(), 1);
  Finding touch = of("touch");
  EXPECT_EQ(touch.health, Health::trouble);
  EXPECT_NE(touch.value.find("crashed"), std::string::npos) << touch.value;
  ::setenv("BURR_OPENHAPTICS", (test::build_dir() + "/fakes/libHD_hang.so").c_str(), 1);
  system_.maker_timeout = milliseconds(1500);
  touch = of("touch");
  EXPECT_NE(touch.value.find("hung"), std::string::npos) << touch.value;
  EXPECT_NE(touch.todo.find("install"), std::string::npos);
}

// ---- texts

TEST(Findings, ReadAsLinesAndAsJson) {
  const std::vector<Finding> findings = {
      {"a", "one", Health::good, "is there", ""},
      {"a", "two", Health::trouble, "is \"odd\"", "mend it"},
      {"b", "three", Health::absent, std::string(300, 'x') + " y", "get one"}};
  const std::string text = text_of(findings);
  EXPECT_NE(text.find("ok one"), std::string::npos) << text;
  EXPECT_NE(text.find("!! two"), std::string::npos);
  EXPECT_NE(text.find("-> mend it"), std::string::npos);
  EXPECT_NE(text.find("-- three"), std::string::npos);
  const auto json = nlohmann::json::parse(json_of(findings));
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[1]["health"], "trouble");
  EXPECT_EQ(json[1]["is"], "is \"odd\"");
}

// ---- the rule that --fix writes

class Rules : public ::testing::Test {
 protected:
  void SetUp() override {
    system_.root = folder_.path();
    fs::create_directories(udev_file(system_).parent_path());
  }
  const burr::test::Folder folder_;
  [[nodiscard]] static std::string held(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static Answer yes(const std::string&) { return Answer::yes; }
  System system_;
};

TEST_F(Rules, AreShownAskedForWrittenAndThenLeftAlone) {
  std::string shown;
  const auto no = write_rules(system_, [&](const std::string& rules) {
    shown = rules;
    return Answer::no;
  });
  ASSERT_TRUE(no.ok());
  EXPECT_NE(no->find("nothing was written"), std::string::npos);
  EXPECT_NE(shown.find(udev_rules()), std::string::npos);
  EXPECT_NE(shown.find(udev_file(system_).string()), std::string::npos);
  EXPECT_FALSE(fs::exists(udev_file(system_)));
  const auto written = write_rules(system_, yes);
  ASSERT_TRUE(written.ok()) << written.error().text;
  EXPECT_NE(written->find("udevadm"), std::string::npos);
  EXPECT_EQ(held(udev_file(system_)), udev_rules());
  const auto again = write_rules(system_, [](const std::string&) {
    ADD_FAILURE() << "asked for nothing";
    return Answer::no;
  });
  ASSERT_TRUE(again.ok());
  EXPECT_NE(again->find("is already correct"), std::string::npos);
}

TEST_F(Rules, OfTheUsersOwnAreKeptBeside) {
  std::ofstream(udev_file(system_)) << "# mine\n";
  const auto written = write_rules(system_, yes);
  ASSERT_TRUE(written.ok());
  EXPECT_NE(written->find("70-burr.rules.old"), std::string::npos);
  EXPECT_EQ(held(udev_file(system_).string() + ".old"), "# mine\n");
  EXPECT_EQ(held(udev_file(system_)), udev_rules());
}

TEST_F(Rules, WhatCannotBeIsSaidAndNothingIsLost) {
  const auto nobody = write_rules(system_, [](const std::string&) { return Answer::nobody; });
  ASSERT_FALSE(nobody.ok());
  EXPECT_NE(nobody.error().text.find("--fix --yes"), std::string::npos);
  fs::remove_all(udev_file(system_).parent_path());
  std::ofstream(udev_file(system_).parent_path()) << "a file where a folder should be\n";
  const auto nowhere = write_rules(system_, yes);
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().text.find("cannot be made"), std::string::npos) << nowhere.error().text;
  EXPECT_EQ(nowhere.error().text.find("sudo burr doctor --fix") != std::string::npos,
            geteuid() != 0);
}

TEST_F(Rules, WithoutUdevTheyWaitForIt) {
  fs::remove_all(udev_file(system_).parent_path().parent_path());
  const auto written = write_rules(system_, yes);
  ASSERT_TRUE(written.ok()) << written.error().text;
  EXPECT_NE(written->find("apt install udev"), std::string::npos) << *written;
  EXPECT_EQ(held(udev_file(system_)), udev_rules());
}

}  // namespace
}  // namespace burr::app
