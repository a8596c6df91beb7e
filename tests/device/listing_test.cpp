// `burr devices` as a user runs it: the program itself with fake devices.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "device/fake/fake_crtk.h"
#include "device/fake/fake_haply.h"
#include "device/stand_in.h"
#include "support/folder.h"
#include "support/test_places.h"

namespace burr {
namespace {

using nlohmann::json;

const std::string kProgram = test::build_dir() + "/burr";
const std::string kFakes = test::build_dir() + "/fakes/";

// An environment variable, set while this object lives; the program inherits it.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

std::string said_by(const std::string& words) {
  std::FILE* pipe = ::popen((kProgram + " " + words + " 2>&1").c_str(), "r");
  std::string said;
  char some[4096];
  for (std::size_t got = 0; (got = std::fread(some, 1, sizeof some, pipe)) > 0;)
    said.append(some, got);
  EXPECT_EQ(::pclose(pipe), 0) << said;
  return said;
}

class ListingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::access(kProgram.c_str(), X_OK) != 0) GTEST_SKIP() << kProgram << " is not built here";
  }
  // The devices of one kind, as the program names them.
  static json of_kind(const json& all, const std::string& kind) {
    json found = json::array();
    for (const json& one : all)
      if (one["kind"] == kind) found.push_back(one);
    return found;
  }

  Variable config_{"XDG_CONFIG_HOME", "/nowhere"};
  Variable hd_{"BURR_OPENHAPTICS", "/nowhere/libHD.so"};
  Variable dhd_{"BURR_FORCEDIMENSION", "/nowhere/libdrd.so"};
  Variable haply_{"HAPLY_WS_PORT", "1"};
  const int domain_ = test::quiet_domain();
  Variable domain_of_ros_{"ROS_DOMAIN_ID", std::to_string(domain_)};
};

TEST_F(ListingTest, EveryDeviceThatIsThereHasTheNameAUserTypes) {
  const Variable libraries("BURR_FORCEDIMENSION", kFakes + "libdrd.so");
  const Variable serials("FAKE_DHD_SERIALS", "1001,2002");
  test::FakeHaply service;
  service.with([](test::FakeHaply::Commands& w) {
    w.arms.push_back({});
    w.arms[1].id = "B2";
    w.arms[1].type = "minverse";
  });
  const Variable port("HAPLY_WS_PORT", std::to_string(service.port));
  const Variable events("HAPLY_EVENTS_PORT", std::to_string(service.events_port));
  test::FakeCrtkArm left(domain_, "/MTML"), right(domain_, "/MTMR");

  const json all = json::parse(said_by("devices --json"), nullptr, false);
  ASSERT_TRUE(all.is_array());
  std::vector<std::string> names;
  for (const char* kind : {"force-dimension", "haply", "crtk"})
    for (const json& one : of_kind(all, kind)) {
      names.push_back(one["name"]);
      EXPECT_EQ(one["there"], true) << one.dump();
    }
  EXPECT_EQ(names,
            (std::vector<std::string>{"force-dimension:1001", "force-dimension:2002", "haply:049D",
                                      "haply:B2", "crtk:/MTML", "crtk:/MTMR"}));
  const json omega = of_kind(all, "force-dimension")[1];
  EXPECT_EQ(omega["id"], "omega.6 2002");
  EXPECT_EQ(omega["sensed"], 6);
  EXPECT_EQ(omega["actuated"], 3);
  EXPECT_EQ(omega["damping_N_s_m"], 30);
  EXPECT_NEAR(omega["workspace_mm"].get<double>(), 75, 1e-9);
  EXPECT_EQ(of_kind(all, "haply")[1]["peak_force_N"], 3);
  const json touch = of_kind(all, "touch");
  ASSERT_EQ(touch.size(), 1U);
  EXPECT_EQ(touch[0]["name"], "touch");
  EXPECT_EQ(touch[0]["there"], false);
  EXPECT_EQ(service.with([](test::FakeHaply::Commands& w) { return w.arms[1].largest; }) < 0.03,
            true)
      << "nothing is pushed";
  EXPECT_EQ(left.with([](test::FakeCrtkArm::Commands& w) { return w.largest; }), 0);
}

TEST_F(ListingTest, AUserReadsWhatEachCanDoAndHowToNameIt) {
  const Variable library("BURR_OPENHAPTICS", kFakes + "libHD.so");
  test::FakeHaply service;
  service.with([](test::FakeHaply::Commands& w) { w.more_grips = {{.id = "LEFT"}}; });
  const Variable port("HAPLY_WS_PORT", std::to_string(service.port));
  const Variable events("HAPLY_EVENTS_PORT", std::to_string(service.events_port));
  const std::string said = said_by("devices");
  for (const char* words :
       {"touch            ", "senses 6 axes, drives 3", "touch:NAME", "haply:049D",
        "8.0 N peak (3.00 N continuous)",
        "damping up to 4 N s/m, workspace 120 mm about its middle",
        "Grips found: GRIP, LEFT. haply:ARM+GRIP", "not found: no CRTK arm was found"})
    EXPECT_NE(said.find(words), std::string::npos) << words << "\nis not in\n" << said;
}

TEST_F(ListingTest, TheGripIsPartOfTheName) {
  test::FakeHaply service;
  service.with([](test::FakeHaply::Commands& w) { w.more_grips = {{.id = "LEFT"}}; });
  const Variable port("HAPLY_WS_PORT", std::to_string(service.port));
  const Variable events("HAPLY_EVENTS_PORT", std::to_string(service.events_port));
  const test::Folder folder;
  const Variable config("XDG_CONFIG_HOME", folder.str());
  EXPECT_NE(said_by("devices set haply:049D+LEFT scale=0.5").find("inverse3 049D: saved in"),
            std::string::npos);
  std::FILE* pipe =
      ::popen((kProgram + " devices set haply:049D+RIGHT scale=0.5 2>&1").c_str(), "r");
  char some[512] = {};
  EXPECT_GT(std::fread(some, 1, sizeof some - 1, pipe), 0U);
  EXPECT_NE(::pclose(pipe), 0);
  EXPECT_NE(std::string(some).find("finds no grip RIGHT; it finds GRIP, LEFT"), std::string::npos)
      << some;
}

}  // namespace
}  // namespace burr
