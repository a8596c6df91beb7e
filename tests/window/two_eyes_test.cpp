// Two eyes at the page one works on: the picture is what is made one by one, the mouse finds the
// bone in either half, and a headset's wearer mills with a wand until the headset goes.
#include <gtest/gtest.h>

#include <SDL2/SDL.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "burr/haptics/contact.h"
#include "burr/render/pick.h"
#include "burr/render/stereo.h"
#include "burr/rt/flags.h"
#include "render/openxr/worn.h"
#include "window/user.h"

namespace burr::app {
namespace {

using render::Stereo;
using test::FakeXr;
using test::Worn;

class TwoEyes : public Window {
 protected:
  // How many pixels of the window differ from both eyes' pictures made one by one.
  int differs(const render::Scene& scene, Stereo how) {
    auto renderer = render::Renderer::offscreen();
    EXPECT_TRUE(renderer);
    const int wide = desk_->renderer().width(), high = desk_->renderer().height();
    (*renderer)->resize_offscreen(wide, high);
    render::Scene one = scene;
    one.quality = {};
    const auto made = [&](const render::Camera& camera) {
      one.camera = camera;
      EXPECT_TRUE((*renderer)->show(one));
      return (*renderer)->shown();
    };
    render::Image wanted;
    const render::TwoEyes eyes = desk_->eyes(scene.camera);
    const render::Eyes cameras = render::eyes_of(scene.camera, scene.camera.distance / 30);
    EXPECT_NEAR(eyes.eye_distance, scene.camera.distance / 30, 1e-12) << "as burr picture has it";
    if (how == Stereo::off) {
      wanted = made(scene.camera);
    } else {
      const render::Image left = made(cameras.left), right = made(cameras.right);
      // the window may begin on an odd row of the screen
      wanted = how == Stereo::interleaved && eyes.first_row % 2 == 1
                   ? render::join_eyes(right, left, how)
                   : render::join_eyes(left, right, how);
    }
    const render::Image shown = desk_->renderer().shown();
    EXPECT_EQ(shown.width, wide);
    return differ(shown, wanted, 0, 0, wide, high);
  }
};

// A bone that nobody touches: every way to show it, by key, and back.
TEST_F(TwoEyes, AreShownAsTheyAreMadeOneByOneInEveryWay) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  std::vector<Script::Step> steps = {{"the start", looks(3), [] { press(SDLK_TAB); }}};
  for (const Stereo how : {Stereo::side_by_side, Stereo::anaglyph, Stereo::interleaved, Stereo::off,
                           Stereo::side_by_side}) {
    steps.push_back({"a picture", looks(2), [] { press(SDLK_F3); }});
    steps.push_back({"both eyes at rest",
                     [this, n = 0]() mutable { return ++n > 40 && desk_->renderer().refined(); },
                     [this, how, &ready] {
                       EXPECT_EQ(desk_->settings.stereo, how);
                       EXPECT_LT(differs(ready->scene, how), 400) << static_cast<int>(how);
                     }});
  }
  // a smaller window
  steps.push_back(
      {"a picture", looks(2), [] { SDL_SetWindowSize(SDL_GL_GetCurrentWindow(), 900, 600); }});
  steps.push_back({"at rest there",
                   [this, n = 0]() mutable {
                     return ++n > 40 && desk_->renderer().refined() &&
                            desk_->renderer().width() == 900;
                   },
                   [this, &ready] {
                     EXPECT_LT(differs(ready->scene, Stereo::side_by_side), 400);
                     close_window();
                   }});
  mill_by(*ready, std::move(steps));
}

TEST_F(TwoEyes, MouseFindsTheBoneInEitherHalf) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const render::Scene& scene = ready->scene;
  desk_->settings.stereo = Stereo::side_by_side;
  std::optional<math::Vec3> left;
  const auto rests = [&scene, at = math::Vec3(0, 0, 0), n = 0]() mutable {
    const math::Vec3 now = scene.burr.world_from_tool.p;
    n = (now - at).norm() < 2e-5 ? n + 1 : 0;
    at = now;
    return n > 15;
  };
  mill_by(*ready, {{"the start", looks(3), [] { move_to(320 + 15, 400); }},
                   {"the burr over the left half's place", rests,
                    [&] {
                      left = scene.burr.world_from_tool.p;
                      // the one eye in the middle sees the bone there
                      const render::Ray eye =
                          render::ray_through(scene.camera, 640 + 30 + 0.5, 400.5, 1280, 720);
                      const auto hit = render::pick(scene, eye);
                      ASSERT_TRUE(hit);
                      EXPECT_LT((*left - eye.origin).cross(eye.direction).norm(), 1e-6);
                      const double off = (hit->p - *left).norm();
                      EXPECT_GT(off, scene.burr.radius);
                      EXPECT_LT(off, 2 * scene.burr.radius + 2e-3);
                      move_to(200, 100);
                    }},
                   {"elsewhere", rests, [] { move_to(640 + 320 + 15, 400); }},
                   {"the burr over the right half's place", rests, [&] {
                      EXPECT_LT((scene.burr.world_from_tool.p - *left).norm(), 2e-4);
                      // what is pulled stays in its half
                      SDL_Event event = {};
                      event.type = SDL_MOUSEMOTION;
                      event.motion.x = 630;
                      event.motion.y = 400;
                      event.motion.state = SDL_BUTTON_LMASK;
                      SDL_PushEvent(&event);
                      SDL_Event mapped = {};
                      ASSERT_TRUE(desk_->next(mapped));
                      EXPECT_EQ(mapped.motion.x, 0);
                      close_window();
                    }}});
}

TEST_F(TwoEyes, KindMayChangeWhileOneMills) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const auto removed = [&] { return ready->session->outcome().ledger.removed; };
  double before = 0;
  mill_by(
      *ready,
      {{"the start", looks(3),
        [] {
          press(SDLK_F3);
          move_to(320, 360);
          button(SDL_BUTTON_LEFT, true);
        }},
       {"some bone gone", pressing_until([&] { return removed() > 1e-9; }), [] { press(SDLK_F3); }},
       {"anaglyph", looks(5),
        [&] {
          EXPECT_EQ(desk_->settings.stereo, Stereo::anaglyph);
          before = removed();
          move_to(640, 365);
        }},
       {"more gone", pressing_until([&] { return removed() > before + 1e-9; }),
        [] {
          button(SDL_BUTTON_LEFT, false);
          press(SDLK_SPACE);
          press(SDLK_SPACE);
          press(SDLK_TAB);
          move_to(5, 5);
        }},
       {"at rest", [this, n = 0]() mutable { return ++n > 150 && desk_->renderer().refined(); },
        [&] {
          EXPECT_LT(differs(ready->scene, Stereo::anaglyph), 400);
          close_window();
        }}});
}

TEST_F(TwoEyes, QuadBufferThatIsNotThereIsSaidAndOneEyeShown) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  desk_->settings.stereo = Stereo::quad_buffer;
  mill_by(*ready,
          {{"the sentence",
            [this] {
              return desk_->status_text.find("no picture for each eye (quad_buffer)") !=
                     std::string::npos;
            },
            [this] {
              EXPECT_EQ(desk_->renewed(), 1) << "asked for once";
              press(SDLK_TAB);
            }},
           {"one eye", [this, n = 0]() mutable { return ++n > 40 && desk_->renderer().refined(); },
            [&] {
              EXPECT_EQ(desk_->renewed(), 1);
              EXPECT_LT(differs(ready->scene, Stereo::off), 400);
              close_window();
            }}});
}

// ---- a headset

class Headset : public TwoEyes {
 protected:
  // where in the room the wand must be for this place of the world
  static XrVector3f in_room(const render::Camera& c, const math::Vec3& world) {
    const math::Vec3 v = (world - c.eye()) / (c.distance / 0.5);
    return {static_cast<float>(v.dot(c.right())), static_cast<float>(v.dot(c.above())),
            static_cast<float>(v.dot(c.backward()))};
  }
};

TEST_F(Headset, ThatIsNotThereIsSaidOnceAndTheWindowGoesOn) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  ::setenv("BURR_OPENXR_LOADER", "/nowhere/libopenxr_loader.so.1", 1);
  desk_->headset_wanted = true;
  mill_by(*ready, {{"the sentence",
                    [this] { return desk_->status_text.find("no headset: ") != std::string::npos; },
                    [this] {
                      EXPECT_NE(desk_->status_text.find("install libopenxr-loader1"),
                                std::string::npos);
                      EXPECT_FALSE(desk_->headset_wanted);
                    }},
                   {"the window as ever", looks(5), [] { close_window(); }}});
  ::unsetenv("BURR_OPENXR_LOADER");
}

TEST_F(Headset, WandIsTheHandThroughTheSafetyLayerUntilTheRuntimeGoes) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  Worn worn;
  render::Scene& scene = ready->scene;
  desk_->headset_wanted = true;
  const auto burr = [&scene] { return scene.burr.world_from_tool.p; };
  const auto flags = [&] {
    tick::TickRow row;
    static_cast<void>(ready->session->view(row));
    return row.contact.flags;
  };
  const auto removed = [&] { return ready->session->outcome().ledger.removed; };
  math::Vec3 place = math::Vec3::Zero(), work = math::Vec3::Zero();
  const auto put_wand = [&](const math::Vec3& at) {
    worn.change([&](FakeXr& xr) { xr.wand.position = in_room(scene.camera, at); });
  };
  std::uint32_t told = 0;
  double gone = 0;
  const auto is_told = [&](std::uint32_t flag) {
    return [&, flag] {
      told |= flags();
      return (told & flag) != 0;
    };
  };
  mill_by(*ready,
          {{"pictures in the headset", [&] { return worn.xr().with_pictures > 3; },
            [&] {
              const auto hit =
                  render::pick(scene, render::ray_through(scene.camera, 640, 360, 1280, 720));
              ASSERT_TRUE(hit);
              work = hit->p;
              place = hit->p + 10e-3 * hit->n;
              put_wand(place);
            }},
           {"the burr there", [&] { return (burr() - place).norm() < 3e-4; },
            [&] {
              EXPECT_NE(worn.xr().pictures[0].rgba, worn.xr().pictures[1].rgba);
              EXPECT_EQ(removed(), 0) << "no trigger, no spindle";
              put_wand(work - 1e-3 * (place - work) / 10e-3);
            }},
           {"pressed on the bone without a trigger",
            [&, n = 0, felt = 0]() mutable {
              tick::TickRow row;
              static_cast<void>(ready->session->view(row));
              if (row.contact.force.norm() > render::kFeltForce) ++felt;
              if (++n % 240 == 0) put_wand(place);  // a busy machine lets the force go
              if (n % 240 == 60) put_wand(work - 1e-3 * (place - work) / 10e-3);
              return felt > 10;
            },
            [&] {
              EXPECT_EQ(worn.xr().most_vibration, 0.0F) << "nothing is cut";
              worn.change([](FakeXr& xr) { xr.trigger = 1; });
            }},
           {"bone cut by it",
            [&, n = 0]() mutable {
              if (removed() > 1e-9) return true;
              // a busy machine lets the force go: lift, and press again
              if (++n % 240 == 0) put_wand(place);
              if (n % 240 == 60) put_wand(work);
              return false;
            },
            [&] {
              EXPECT_GT(worn.xr().most_vibration, 0) << "the controller shows the cutting";
              EXPECT_LE(worn.xr().most_vibration, static_cast<float>(render::kMostVibration));
              told = 0;
              worn.change(
                  [](FakeXr& xr) { xr.wand.position.y = std::numeric_limits<float>::quiet_NaN(); });
            }},
           {"a pose that is none, told by the safety layer", is_told(rt::kFlagNotFinite),
            [&] { gone = removed(); }},
           {"nothing moves", looks(20),
            [&] {
              EXPECT_TRUE(burr().allFinite());
              EXPECT_EQ(removed(), gone);
              EXPECT_EQ(worn.xr().vibrates, 0.0F) << "nothing is cut any more";
              worn.change([](FakeXr& xr) { xr.trigger = 0; });
              put_wand(place);
            }},
           {"back again", [&] { return (burr() - place).norm() < 3e-4; },
            [&] {
              told = 0;
              worn.change([](FakeXr& xr) { xr.wand_tracked = false; });
            }},
           {"tracking lost, told by the safety layer", is_told(rt::kFlagHandLost),
            [&] {
              EXPECT_LT((burr() - place).norm(), 1e-3);
              put_wand(place + math::Vec3(0.02, 0, 0));
            }},
           {"nothing moves", looks(20),
            [&] {
              EXPECT_LT((burr() - place).norm(), 1e-3);
              worn.change([](FakeXr& xr) { xr.wand_tracked = true; });
            }},
           {"found again", [&] { return (burr() - place - math::Vec3(0.02, 0, 0)).norm() < 5e-4; },
            [&] { worn.change([](FakeXr& xr) { xr.instance_loss_pending = true; }); }},
           {"the headset gone, and said",
            [this] { return desk_->status_text.find("the window continues") != std::string::npos; },
            [&] {
              EXPECT_EQ(desk_->headset, nullptr);
              EXPECT_EQ(worn.xr().sessions, 0);
              EXPECT_EQ(worn.xr().begun, worn.xr().ended);
              move_to(645, 365);
            }},
           {"the mouse is the hand again",
            [&] {
              const auto hit =
                  render::pick(scene, render::ray_through(scene.camera, 645.5, 365.5, 1280, 720));
              return hit && (burr() - hit->p).norm() < scene.burr.radius + 4e-3;
            },
            [] { close_window(); }}});
}

TEST_F(Headset, IsPutOnAndTakenOffBySettings) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  Worn worn;
  mill_by(*ready,
          {{"the window", looks(3),
            [&] {
              EXPECT_EQ(worn.xr().instances, 0) << "nobody asked for one";
              desk_->headset_wanted = true;
            }},
           {"worn, and it is said",
            [&] {
              return worn.xr().with_pictures > 3 &&
                     desk_->status_text.find("Headset: Fake headset") != std::string::npos;
            },
            [&] { desk_->headset_wanted = false; }},
           {"off", [&] { return desk_->status_text.find("Headset off") != std::string::npos; },
            [&] {
              EXPECT_EQ(worn.xr().instances, 0);
              desk_->headset_wanted = true;
            }},
           {"worn again", [&] { return worn.xr().sessions == 1; },
            [this] { ASSERT_TRUE(desk_->renew()) << "the graphics card lost"; }},
           {"and in the new window", [&] { return worn.xr().with_pictures > 20; },
            [] { close_window(); }}});
  EXPECT_EQ(worn.xr().instances, 0) << "off when the page is left";
}

}  // namespace
}  // namespace burr::app
