// Measuring at the window: the numbers against the points themselves, and the clicks end to end.
#include "window/parts/measuring.h"

#include <gtest/gtest.h>

#include <numbers>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/render/pick.h"
#include "window/user.h"

namespace burr::app {
namespace {

using math::Vec3;

TEST(Measuring, KnowsDistancesAndAngles) {
  Measuring m;
  EXPECT_FALSE(m.on());
  m.next();
  ASSERT_EQ(m.what(), Measure::distance);
  m.pick({0.001, 0, 0});
  EXPECT_FALSE(m.value());
  m.pick({0.004, 0.004, 0});
  ASSERT_TRUE(m.value());
  EXPECT_NEAR(*m.value(), 0.005, 1e-15);
  EXPECT_EQ(m.words(), "Distance: 5.00 mm");
  m.pick({0, 0, 0});
  EXPECT_FALSE(m.value()) << "the third click begins anew";
  m.next();
  ASSERT_EQ(m.what(), Measure::angle);
  for (const Vec3& p : {Vec3(0.01, 0, 0), Vec3(0, 0, 0), Vec3(0.02, 0.02, 0)}) m.pick(p);
  ASSERT_TRUE(m.value());
  EXPECT_NEAR(*m.value(), std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(m.words(), "Angle: 45.0°");
  m.next();
  ASSERT_EQ(m.what(), Measure::thickness);
  EXPECT_FALSE(m.picks());
  const auto bone = phantom::bone_from_distance(phantom::cube_grid(20e-3, 64), {},
                                                phantom::plate(3e-3, {0, 0, 1}, {0, 0, 0}));
  m.probe(*bone, {0, 0, 5e-3}, {0, 0, -1}, 5e-3);
  ASSERT_TRUE(m.value());
  EXPECT_NEAR(*m.value(), 3e-3, 1e-5);
  m.probe(*bone, {0, 0, 5e-3}, {0, 0, 1}, 5e-3);
  EXPECT_FALSE(m.value());
  m.next();
  EXPECT_FALSE(m.on());
  EXPECT_EQ(m.words(), "");
}

TEST(Measuring, APointIsDrawnWhereItsRayGoesThrough) {
  render::Camera camera;
  camera.target = {0.01, 0.02, -0.01};
  camera.azimuth = 0.7;
  camera.elevation = -0.4;
  for (const auto& [x, y] : {std::pair{640.5, 360.5}, {100.0, 50.0}, {1200.0, 700.0}}) {
    const render::Ray ray = render::ray_through(camera, x, y, 1280, 720);
    const auto at = on_picture(camera, ray.origin + 0.2 * ray.direction, 1280, 720);
    ASSERT_TRUE(at);
    EXPECT_NEAR(static_cast<double>(at->x), x, 1e-2);
    EXPECT_NEAR(static_cast<double>(at->y), y, 1e-2);
    EXPECT_FALSE(on_picture(camera, ray.origin - 0.2 * ray.direction, 1280, 720)) << "behind";
  }
}

class MeasuringWindow : public Window {};

TEST_F(MeasuringWindow, TwoClicksGiveTheirDistanceNothingIsCutAndEscapeEndsIt) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const auto at = [&](int x, int y) {
    const auto hit = render::pick(
        ready->scene, render::ray_through(ready->scene.camera, x + 0.5, y + 0.5,
                                          desk_->renderer().width(), desk_->renderer().height()));
    return hit ? hit->p : Vec3(NAN, NAN, NAN);
  };
  const std::uint64_t hash = ready->session->bone().content_hash();
  std::string told;
  double truth = 0;
  int drawn = 0;
  render::Image before;
  tick::TickRow row;
  bool still_there = false;
  const auto says = [this](const std::string& word) {
    return [this, word] { return desk_->status_text.find(word) != std::string::npos; };
  };
  mill_by(*ready, {{"the first picture", looks(3),
                    [&] {
                      before = desk_->renderer().shown();
                      press(SDLK_d);
                    }},
                   {"what to do", says("click two points"), [] { click(600, 330); }},
                   {"a picture", looks(3), [] { click(700, 400); }},
                   {"the distance", says(" mm"),
                    [&] {
                      told = desk_->status_text;
                      truth = (at(600, 330) - at(700, 400)).norm();
                      const render::Image now = desk_->renderer().shown();
                      drawn = differ(before, now, 610, 340, 690, 390);
                      button(SDL_BUTTON_LEFT, true);  // held, as if to mill
                    }},
                   {"a while", looks(10),
                    [&] {
                      static_cast<void>(ready->session->view(row));
                      button(SDL_BUTTON_LEFT, false);
                      press(SDLK_d);
                    }},
                   {"the angle's turn", says("three points"), [] { press(SDLK_d); }},
                   {"the thickness' turn", says("hick"), [] { press(SDLK_ESCAPE); }},
                   {"its end", says("ended"), [&] {
                      still_there = desk_->page == Page::milling;
                      leave_work();
                    }}});
  ASSERT_TRUE(std::isfinite(truth)) << "a click beside the bone: the test shows nothing";
  EXPECT_GT(truth, 1e-3);
  // the last of what is said: a busy machine may have lost ticks before
  EXPECT_TRUE(told.ends_with(say(Word::measured_distance, 1e3 * truth))) << told;
  EXPECT_GT(drawn, 100) << "no line over the picture";
  EXPECT_EQ(row.hand.pedal, 0);
  EXPECT_TRUE(still_there) << "Escape left the window";
  EXPECT_EQ(ready->session->bone().content_hash(), hash);
}

}  // namespace
}  // namespace burr::app
