// The rack of tools: how the mouse holds each, that none is pushed while it hovers, that each cuts, and
// the panel in the window.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "burr/mouse/grip.h"
#include "burr/mouse/mouse_aim.h"
#include "burr/render/pick.h"
#include "burr/render/tool_mesh.h"
#include "burr/scenario/rack.h"
#include "burr/sim/session.h"
#include "shared/tool_options.h"
#include "shared/window_session.h"
#include "shared/work.h"
#include "support/folder.h"
#include "user.h"
#include "window/mill/rack_panel.h"
#include "window/mill/side_panel.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kDegree = std::numbers::pi / 180;

render::Camera from_above() {
  render::Camera camera;
  camera.elevation = 1.2;
  return camera;
}

TEST(Grip, TheHandleLeansFromTheNormalToTheSideOfTheHand) {
  const render::Camera camera = from_above();
  const Vec3 out = (camera.backward() + 0.3 * camera.above()).normalized();
  for (const scenario::RackTool& tool : scenario::built_in_rack().all)
    for (const bool left : {false, true}) {
      mouse::Grip grip;
      grip.take(&tool);
      const math::Quat q = grip.turn(out, camera, left);
      const Vec3 handle = q * Vec3::UnitZ();
      EXPECT_NEAR(std::acos(std::clamp(handle.dot(out), -1.0, 1.0)), tool.lean, 1e-6) << tool.name;
      if (tool.lean > 0.1) {
        EXPECT_GT((left ? -1 : 1) * handle.dot(camera.right()), 0.3) << tool.name;
      }
      EXPECT_NEAR(q.norm(), 1, 1e-12);
    }
}

TEST(Grip, ABladeLiesFromLeftToRightUntilItIsTurned) {
  const render::Camera camera = from_above();
  mouse::Grip grip;
  grip.take(scenario::built_in_rack().find("sagittal-saw"));
  const Vec3 out = camera.backward();
  // the side of the hand is a little above the picture's right
  EXPECT_GT(std::abs((grip.turn(out, camera, false) * Vec3::UnitX()).dot(camera.right())), 0.95);
  grip.roll(90 * kDegree);
  EXPECT_LT(std::abs((grip.turn(out, camera, false) * Vec3::UnitX()).dot(camera.right())), 0.3);
  EXPECT_NEAR((grip.turn(out, camera, false) * Vec3::UnitZ()).dot(out), 1, 1e-3);
}

TEST(Grip, ReachesAsFarAsTheSurfaceOfItsCuttingParts) {
  constexpr std::uint64_t kSeed = 77;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> any;
  for (const scenario::RackTool& tool : scenario::built_in_rack().all) {
    mouse::Grip grip;
    grip.take(&tool);
    const surface::Mesh mesh = render::mesh_of(tool.tool, tool::Role::cuts);
    // the mesh has chords in place of arcs; boxes and wedges are drawn with sharp corners
    double off = 2 * render::kToolFacet;
    for (const tool::Part& part : tool.tool.parts)
      if (part.shape.kind == tool::ShapeKind::box || part.shape.kind == tool::ShapeKind::wedge)
        off = std::max(off, 0.75 * part.shape.rounding);
    for (int n = 0; n < 20; ++n) {
      const math::Quat q =
          math::Quat(any(random), any(random), any(random), any(random)).normalized();
      const Vec3 way = Vec3(any(random), any(random), any(random)).normalized();
      double most = -1, farthest = 0;
      for (const surface::Vertex& vertex : mesh.vertices) {
        const Vec3 p = vertex.p.cast<double>();
        most = std::max(most, (q * p).dot(way));
        farthest = std::max(farthest, p.norm());
      }
      EXPECT_NEAR(grip.reach_along(q, way), most, off) << tool.name;
      EXPECT_GE(grip.reach(), farthest - off) << tool.name;
    }
  }
}

// A block and the mouse's hand, without a window: pictures of 16 ticks.
struct Bench {
  WindowSession ready;
  mouse::Grip grip;
  std::unique_ptr<mouse::MouseAim> aim;
  tick::TickRow row;

  explicit Bench(const std::string& tool) {
    WorkOptions options;
    options.volume.source = "phantom:block";
    options.volume.voxel_mm = 0.4;
    options.tool.tool = tool;
    NoProgress quiet;
    EXPECT_TRUE(take_case(options));
    auto work = open_work(options, quiet);
    EXPECT_TRUE(work);
    auto made = make_window_session(options, std::move(*work), quiet);
    EXPECT_TRUE(made) << (made ? "" : made.error().text);
    ready = std::move(*made);
    aim = std::make_unique<mouse::MouseAim>(ready.session->bone().grid().voxel);
    const int number = ready.session->settings().servo.tool;
    grip.take(number < 0 ? nullptr : &ready.rack[static_cast<std::size_t>(number)]);
    aim->hold(&grip);
  }
  void picture(double x, double y, const std::optional<mouse::MouseAim::Push>& push) {
    const render::Ray eye = render::ray_through(ready.scene.camera, x, y, 1280, 720);
    ready.hands.mouse->aim(aim->at(ready.scene, eye, push, false));
    for (int t = 0; t < 16; ++t) {
      row = ready.session->servo().tick(false);
      most_force = std::max(most_force, row.contact.force.norm());
      ready.scene.burr.world_from_tool = {row.contact.proxy, row.hand.world_from_tool.q};
    }
  }
  double most_force = 0;
};

class Rack : public testing::TestWithParam<std::string> {};

TEST_P(Rack, NothingPushesItWhileItHoversAndItCutsWhereItIsPressed) {
  const std::uint64_t seed = std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> at(0.2, 0.8);
  Bench bench(GetParam());
  ASSERT_FALSE(bench.grip.burr());
  for (int n = 0; n < 60; ++n) bench.picture(1280 * at(random), 720 * at(random), {});
  EXPECT_LT(bench.most_force, 0.05);
  EXPECT_EQ(bench.row.ledger.removed, 0);
  bench.picture(640, 360, {});
  // pressed: held for a second, as a drill is, then drawn to and fro, as a curette is
  for (int n = 0; n < 180; ++n)
    bench.picture(640 + (n < 60 ? 0 : 120 * std::sin(0.15 * n)),
                  360 + (n < 60 ? 0 : 40 * std::sin(0.11 * n)), mouse::MouseAim::Push{2.5e-3, 1});
  EXPECT_GT(bench.row.ledger.removed * 1e9, 0.01);
  EXPECT_GT(bench.most_force, 0.05);
  EXPECT_LT(bench.most_force, 8);
}

std::vector<std::string> tools() {
  std::vector<std::string> names;
  for (const scenario::RackTool& tool : scenario::built_in_rack().all) names.push_back(tool.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Tools, Rack, testing::ValuesIn(tools()), [](const auto& which) {
  std::string name = which.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(RackOfASession, HoldsTheToolsThatAreThickEnoughForTheVoxels) {
  tick::ServoSettings settings;
  const auto fine = offer_rack({}, 0.2e-3, settings);
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->size(), scenario::built_in_rack().all.size());
  ASSERT_EQ(settings.tools.size(), fine->size());
  EXPECT_EQ(settings.tool, -1);
  const auto coarse = offer_rack({}, 0.55e-3, settings);
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->size(), fine->size());
  for (const tool::ShapedTool& tool : settings.tools)
    EXPECT_GE(tool::thinnest(tool.tool), 0.55e-3 - 1e-9) << tool.name;
  ToolOptions named;
  named.tool = "flame";
  ASSERT_TRUE(offer_rack(named, 0.2e-3, settings));
  EXPECT_EQ(settings.tools[static_cast<std::size_t>(settings.tool)].name, "flame");
  named.tool = "spoon";
  const auto none = offer_rack(named, 0.2e-3, settings);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("there is no tool \"spoon\"; use one of"), std::string::npos);
}

class RackWindow : public Window {
 protected:
  [[nodiscard]] int number(WindowSession& ready) const {
    tick::TickRow row;
    if (ready.session->view(row)) last_ = row;
    return last_.tool.number;
  }
  // the middle of a tile of the panel
  void click_tile(int n) const {
    const float u = desk_->ui().unit();
    click(static_cast<int>((kSideLeft + 10 + 113 * static_cast<float>(n % 3) + 55) * u),
          static_cast<int>((kSideTop + 44 + 112 * static_cast<float>(n / 3) + 50) * u));
  }
  void mill_with_rack(WindowSession& ready, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    WindowOptions options;
    options.rack = ready.rack;
    const auto left =
        mill(*desk_, *ready.session, ready.hands, *ready.worker, ready.scene, options);
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  mutable tick::TickRow last_;
};

TEST_F(RackWindow, AToolIsTakenByItsPictureByKeyAndGivenBack) {
  auto ready = block();
  ASSERT_TRUE(ready);
  ASSERT_GE(ready->rack.size(), 5U);
  const auto told = [this](const std::string& text) {
    return [this, text] { return desk_->status_text.find(text) != std::string::npos; };
  };
  const std::string second = ready->rack[1].title.in("en");
  render::Image before;
  mill_with_rack(
      *ready, {{"a picture", looks(3), [] { press(SDLK_7); }},
               {"the panel", looks(20), [&] { before = desk_->renderer().shown(), click_tile(3); }},
               {"the second tool of the list", [&] { return number(*ready) == 1; }, {}},
               {"its name", told(second), [] { press(SDLK_k); }},
               {"one size", told("one size"), [] { press(SDLK_8); }},
               {"turned", told("15"), [] { press(SDLK_PERIOD); }},
               {"at most its own speed", told("100 %"), [] { press(SDLK_2); }},
               {"the burr adds", [&] { return number(*ready) == -1; }, [&] { click_tile(6); }},
               {"the fifth tool", [&] { return number(*ready) == 4; },
                [&] {
                  EXPECT_EQ(last_.tool.mode, tick::ToolMode::cut);
                  click_tile(1);
                }},
               {"the diamond burr",
                [&] { return number(*ready) == -1 && last_.tool.kind == tool::BurrKind::diamond; },
                [] { press(SDLK_7); }},
               {"the panel is closed", looks(5), [&] {
                  const render::Image after = desk_->renderer().shown();
                  const int right = static_cast<int>((kSideLeft + kSideWide) * desk_->ui().unit());
                  EXPECT_GT(differ(before, after, 110, 60, std::min(right, after.width), 300),
                            3000);
                  close_window();
                }}});
}

}  // namespace
}  // namespace burr::app
