// What Haply's service does between burr and the arm: axes, mount, workspace, filters. Against a service that does
// all of it (fake/fake_haply_35.h), after the maker's pages.
#include "burr/device/haply/pipeline.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <utility>

#include "burr/device/haply/inverse.h"
#include "burr/device/haply/message.h"
#include "device/fake/fake_haply_35.h"
#include "device/stand_in.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using test::FakeHaply35;
using test::soon;
using Commands = FakeHaply35::Commands;
using Theirs = FakeHaply35::Pipeline;

const std::pair<const char*, std::function<void(Theirs&)>> kWays[] = {
    {"turns the axes (basis XZY)", [](Theirs& p) { p.basis = "XZY"; }},
    {"turns the axes (basis X-YZ)", [](Theirs& p) { p.basis = "X-YZ"; }},
    {"moves, turns or scales places (mount, preset custom)",
     [](Theirs& p) {
       p.preset = "custom";
       p.mount.p = {0.1, 0, 0};
     }},
    {"moves, turns or scales places (mount, preset led_front)",
     [](Theirs& p) {
       p.preset = "led_front";
       p.mount.q = Quat(0, 0, 0, 1);
     }},
    {"moves, turns or scales places (mount",
     [](Theirs& p) {
       p.scale = {1, 1, 2};
     }},
    {"moves, turns or scales places (transform of the workspace)",
     [](Theirs& p) {
       p.workspace.p = {0, 0, 0.05};
     }},
    {"damps every motion (filters: damping 0.5)", [](Theirs& p) { p.damping = 0.5; }},
    {"damps motion along an axis",
     [](Theirs& p) {
       p.damping_along = {0, 1, 0};
     }},
    {"weakens forces in another way than burr knows (filters: force_gate 0.9)",
     [](Theirs& p) { p.force_gate = 0.9; }},
};

class PipelineTest : public ::testing::Test {
 protected:
  PipelineTest() { ::unsetenv("BURR_HAPLY_AS_IT_IS"); }
  [[nodiscard]] InverseSettings here() const {
    return {.host = "127.0.0.1", .port = service_.port, .events_port = 1};
  }
  std::string refusal() {
    Inverse wire(here());
    const auto found = wire.connect();
    return found.ok() ? "" : found.error().text;
  }
  FakeHaply35 service_;
};

// Whatever a saved profile does, burr undoes it for its own session: 10 mm and a newton are those of the arm.
TEST_F(PipelineTest, ASavedProfileIsUndone) {
  for (const auto& [words, change] : kWays) {
    for (const bool late : {false, true}) {
      service_.with([&, change = change](Commands& w) {
        w = {};
        w.late = late;
        change(w.begins);
        w.arm.place = {0.01, 0.02, 0.03};
      });
      Inverse wire(here());
      const auto found = wire.connect();
      ASSERT_TRUE(found.ok()) << words << ": " << found.error().text;
      EXPECT_EQ(found->software, "Inverse Service 3.5, firmware 7.4, force gate 0.3");
      HandState hand;
      Wire::Read read = Wire::Read::nothing;
      ASSERT_TRUE(soon([&] { return (read = wire.read(hand)) != Wire::Read::nothing; }));
      ASSERT_TRUE(wire.write({0.5, 1, 2}));
      ASSERT_TRUE(soon([&] { return (read = wire.read(hand)) != Wire::Read::nothing; }));
      EXPECT_NEAR((hand.world_from_tool.p - Vec3(0.01, 0.03, -0.02)).norm(), 0, 1e-9) << words;
      EXPECT_NEAR(
          (service_.with([](Commands& w) { return w.arm.force; }) - Vec3(0.5, -2, 1)).norm(), 0,
          1e-4)
          << words;
      EXPECT_EQ(service_.with([](Commands& w) { return w.refused; }), 0);
      wire.disconnect();
    }
  }
}

TEST_F(PipelineTest, AServiceThatDoesNotStopIsRefusedByName) {
  for (const auto& [words, change] : kWays) {
    service_.with([&, change = change](Commands& w) {
      w = {};
      w.stubborn = true;
      change(w.begins);
    });
    const std::string said = refusal();
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find("reset it in Haply's window"), std::string::npos) << said;
    EXPECT_NEAR(service_.with([](Commands& w) { return w.arm.force.norm(); }), 0, 1e-12);
  }
  service_.with([](Commands& w) {
    w = {};
    w.stubborn = true;  // and nothing in the way
  });
  EXPECT_EQ(refusal(), "");
  service_.with([](Commands& w) { w.begins.basis = "ZXY"; });
  ::setenv("BURR_HAPLY_AS_IT_IS", "1", 1);
  EXPECT_EQ(refusal(), "");
  ::unsetenv("BURR_HAPLY_AS_IT_IS");
}

TEST(Pipeline, ReadsWhatThePagesShow) {
  Pipeline p;
  EXPECT_FALSE(read_pipeline("no JSON", "A", p));
  EXPECT_FALSE(read_pipeline(R"({"inverse3":[{"device_id":"A","state":{}}]})", "A", p));
  EXPECT_FALSE(read_pipeline(R"({"inverse3":[{"device_id":"B","config":{}}]})", "A", p));
  // what changes nothing is left out; nothing is in the way then
  ASSERT_TRUE(read_pipeline(R"({"inverse3":[{"device_id":"A","config":{"mount":{}}}]})", "A", p));
  EXPECT_EQ(in_the_way(p), "");
  ASSERT_TRUE(read_pipeline(
      R"({"inverse3":[{"device_id":"A","config":{"basis":{"permutation":"+X+Y+Z"}}}]})", "A", p));
  EXPECT_EQ(in_the_way(p), "");
  ASSERT_TRUE(read_pipeline(
      R"({"inverse3":[{"device_id":"A","config":{"mount":{"transform":{"position":{"x":0.2}}}}}]})",
      "A", p));
  EXPECT_NE(in_the_way(p), "");
}

}  // namespace
}  // namespace burr::device::haply
