// The hand without a device that goes in a plane, and the one that is led by keys.
#include "window/mill/hand_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "window/user.h"

namespace burr::app {
namespace {

using math::Vec3;

TEST(HandPlane, IsSquareToTheLookThroughTheHandAndAsDeepAsItWasPushed) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 200; ++n) {
    render::Camera camera;
    camera.azimuth = 3 * any(random);
    camera.elevation = 1.2 * any(random);
    camera.distance = 0.1;
    HandPlane plane;
    const Vec3 hand = 5e-3 * Vec3(any(random), any(random), any(random));
    plane.begin(hand);
    double deep = 0;
    for (int step = 0; step < 5; ++step) {
      const double by = 1e-3 * any(random);
      plane.push(by, camera);
      deep += by;
      const render::Ray ray =
          render::ray_through(camera, 640 + 300 * any(random), 360 + 200 * any(random), 1280, 720);
      const Vec3 at = plane.meet(ray, camera);
      EXPECT_NEAR((at - hand).dot(-camera.backward()), deep, 1e-12);
      EXPECT_NEAR(ray.direction.cross(at - ray.origin).norm(), 0, 1e-12) << "under the mouse";
    }
    // turned, it turns about the hand
    const Vec3 was = plane.meet(render::ray_through(camera, 600, 300, 1280, 720), camera);
    render::orbit(camera, 0.4, 0.1);
    const Vec3 is = plane.meet(render::ray_through(camera, 640, 360, 1280, 720), camera);
    EXPECT_NEAR((is - was).dot(camera.backward()), 0, 1e-12);
    // a ray that goes away from it
    const render::Ray away = {camera.eye(), camera.backward()};
    EXPECT_EQ(plane.meet(away, camera), is);
    // and pulled behind the eye it is met by none
    plane.push(-2 * camera.distance, camera);
    const Vec3 behind = is + 2 * camera.distance * camera.backward();
    EXPECT_NEAR(
        (plane.meet(render::ray_through(camera, 300, 500, 1280, 720), camera) - behind).norm(), 0,
        1e-12);
  }
}

TEST(HandPlane, ItsLinesAreDrawnOnceAndLeaveOthersAlone) {
  render::Scene scene;
  scene.rods.push_back({Vec3::Zero(), Vec3::UnitX(), 1e-3, {1, 1, 1}, false, false});
  HandPlane plane;
  plane.begin({0, 0, 1e-3});
  for (int n = 0; n < 3; ++n) {
    plane.show(scene);
    EXPECT_EQ(scene.rods.size(), 11U);
    render::zoom(scene.camera, 1.3);
  }
  for (std::size_t n = 1; n < scene.rods.size(); ++n)
    for (const Vec3& end : {scene.rods[n].a, scene.rods[n].b})
      EXPECT_NEAR((end - Vec3(0, 0, 1e-3)).dot(scene.camera.backward()), 0, 1e-12);
  plane.end();
  plane.show(scene);
  ASSERT_EQ(scene.rods.size(), 1U);
  EXPECT_EQ(scene.rods[0].radius, 1e-3);
}

class PlaneWindow : public Window {
 protected:
  static int lines(const render::Scene& scene) {
    int count = 0;
    for (const render::Rod& rod : scene.rods) count += rod.on_top ? 0 : 1;
    return count;
  }
  static void hold(SDL_Keycode code, Uint16 with, bool down) {
    SDL_Event event = {};
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.keysym.sym = code;
    event.key.keysym.mod = with;
    SDL_PushEvent(&event);
  }
};

TEST_F(PlaneWindow, TheWheelPutsTheHandIntoTheBoneWhichHoldsTheBurr) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const render::Scene& scene = ready->scene;
  tick::TickRow row;
  const auto hand = [&] {
    static_cast<void>(session.view(row));
    return row.hand.world_from_tool.p;
  };
  const auto said = [&](const char* words) {
    return [this, words] { return desk_->status_text.find(words) != std::string::npos; };
  };
  Vec3 was = Vec3::Zero();
  double distance = 0;
  mill_by(*ready,
          {{"the first picture", looks(20), [] { move_to(600, 340); }},
           {"over the bone", looks(60),
            [&] {
              EXPECT_EQ(lines(scene), 0);
              distance = scene.camera.distance;
              press(SDLK_g);
            }},
           {"told", said("in the plane"), {}},
           {"drawn", looks(40),
            [&] {
              EXPECT_EQ(lines(scene), 10);
              was = hand();
              move_to(700, 300);
            }},
           {"goes in it", [&] { return (hand() - was).dot(scene.camera.right()) > 2e-3; }, {}},
           {"and nowhere else", looks(60),
            [&] { EXPECT_NEAR((hand() - was).dot(scene.camera.backward()), 0, 0.1e-3); }},
           {"pressed on by the wheel",
            asking_until([&] { return hand(), row.contact.touching && row.contact.depth > 0.5e-3; },
                         [] { turn_wheel(2); }),
            [&] {
              EXPECT_EQ(scene.camera.distance, distance) << "that was no zoom";
              EXPECT_EQ(row.ledger.removed, 0) << "nothing turns";
              EXPECT_LT((row.contact.proxy - hand()).dot(-row.contact.normal), 0)
                  << "the bone holds the burr, not the hand";
              SDL_SetModState(KMOD_LCTRL);
              turn_wheel(1);
            }},
           {"with Ctrl it zooms", [&] { return scene.camera.distance < distance; },
            [] {
              SDL_SetModState(KMOD_NONE);
              button(SDL_BUTTON_LEFT, true);
            }},
           // let go on a busy machine it begins again off the bone: there by the wheel
           {"milled",
            pressing_until([&] { return hand(), row.ledger.removed > 0.5e-9; },
                           [was_down = true](bool down) mutable {
                             if (std::exchange(was_down, down) == down) return;
                             button(SDL_BUTTON_LEFT, down);
                             turn_wheel(down ? 10 : -10);
                           }),
            [] {
              button(SDL_BUTTON_LEFT, false);
              press(SDLK_g);
            }},
           {"over", said("follows the bone"), {}},
           {"gone", looks(3), [&] {
              EXPECT_EQ(lines(scene), 0);
              leave_work();
            }}});
}

TEST_F(PlaneWindow, KeysAloneLeadTheHandPressAndMill) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const render::Scene& scene = ready->scene;
  tick::TickRow row;
  const auto across = [&] {
    return (scene.burr.world_from_tool.p - scene.camera.target).dot(scene.camera.right());
  };
  const auto above = [&] {
    return (scene.burr.world_from_tool.p - scene.camera.target).dot(scene.camera.above());
  };
  double was = 0, azimuth = 0;
  mill_by(*ready,
          {{"the first picture", looks(20), [] { hold(SDLK_RIGHT, KMOD_LCTRL, true); }},
           {"led to the middle", looks(2), [] { hold(SDLK_RIGHT, KMOD_NONE, false); }},
           {"settled", looks(40),
            [&] {
              was = across();
              azimuth = scene.camera.azimuth;
              hold(SDLK_RIGHT, KMOD_LCTRL, true);
            }},
           {"to the right", [&] { return across() > was + 2e-3; },
            [&] {
              EXPECT_EQ(scene.camera.azimuth, azimuth) << "the view did not turn";
              hold(SDLK_RIGHT, KMOD_NONE, false);  // Ctrl was let go before the arrow
            }},
           {"at rest", looks(60), [&] { was = across(); }},
           {"stays", looks(30),
            [&] {
              EXPECT_NEAR(across(), was, 0.1e-3);
              was = above();
              hold(SDLK_KP_8, KMOD_NONE, true);
            }},
           {"up by the keypad", [&] { return above() > was + 1e-3; },
            [] {
              hold(SDLK_KP_8, KMOD_NONE, false);
              press(SDLK_SPACE);
            }},
           {"milled",
            pressing_until(
                [&] { return static_cast<void>(session.view(row)), row.ledger.removed > 0.5e-9; },
                [](bool) { press(SDLK_SPACE); }),
            [] { leave_work(); }}});
}

}  // namespace
}  // namespace burr::app
