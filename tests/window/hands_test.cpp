// Other hands than the mouse's at the window: a whole session by gamepad alone, pedals, a
// SpaceMouse by a false libspnav; pulled out, at rest, and with numbers that cannot be.
#include <gtest/gtest.h>

#include <SDL2/SDL.h>
#include <dlfcn.h>

#include <array>
#include <climits>
#include <cstdlib>
#include <limits>
#include <string>

#include "support/test_places.h"
#include "window/hands/gamepad.h"
#include "window/hands/pedals.h"
#include "window/hands/spacemouse.h"
#include "window/stick.h"
#include "window/user.h"

namespace burr::app {
namespace {

class Pad : public Stick {
 public:
  Pad()
      : Stick(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
              SDL_CONTROLLER_BUTTON_MAX) {
    trigger(0);
    axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT, -32768);
  }
  void trigger(double share) const {
    axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, static_cast<int>(-32768 + 65535 * share));
  }
};

class HandsWindow : public Window {
 protected:
  void SetUp() override {
    ::setenv("BURR_SPNAV", "/nowhere/libspnav.so.0", 1);
    Window::SetUp();
  }
  // one step that presses a button of the pad, one that lets go
  static void tap(std::vector<Script::Step>& steps, const Pad& pad, int button) {
    steps.push_back({"down", looks(2), [&pad, button] { pad.button(button, true); }});
    steps.push_back({"up", looks(2), [&pad, button] { pad.button(button, false); }});
  }
};

// Where the burr is, across the picture.
double across(const render::Scene& scene) {
  return (scene.burr.world_from_tool.p - scene.camera.target).dot(scene.camera.right());
}
double above(const render::Scene& scene) {
  return (scene.burr.world_from_tool.p - scene.camera.target).dot(scene.camera.above());
}

TEST_F(HandsWindow, AWholeSessionByGamepadAlone) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const std::uint64_t start = session.bone().content_hash();
  const double first_radius = session.burr_radius();
  render::Scene& scene = ready->scene;
  Pad pad;
  tick::TickRow row;
  const auto removed = [&] {
    static_cast<void>(session.view(row));
    return 1e9 * row.ledger.removed;
  };
  double was_across = 0, was_azimuth = 0;
  bool undone = false;
  std::vector<Script::Step> steps = {
      {"seen at rest", looks(20), [&] { pad.axis(SDL_CONTROLLER_AXIS_LEFTX, 32767); }},
      {"led to the middle", looks(1), [&] { pad.axis(SDL_CONTROLLER_AXIS_LEFTX, 3000); }},
      {"settled", looks(40), [&] { was_across = across(scene); }},
      {"a stick at rest moves nothing", looks(30),
       [&] {
         EXPECT_NEAR(across(scene), was_across, 1e-5);
         pad.axis(SDL_CONTROLLER_AXIS_LEFTX, 32767);
       }},
      {"to the right", [&] { return across(scene) > was_across + 2e-3; },
       [&] { pad.axis(SDL_CONTROLLER_AXIS_LEFTX, -32768); }},
      {"back", [&] { return across(scene) < was_across + 1e-3; },
       [&] {
         pad.axis(SDL_CONTROLLER_AXIS_LEFTX, 0);
         was_azimuth = scene.camera.azimuth;
         pad.axis(SDL_CONTROLLER_AXIS_RIGHTX, -32768);
       }},
      {"the view turned", [&] { return std::abs(scene.camera.azimuth - was_azimuth) > 0.2; },
       [&] {
         pad.axis(SDL_CONTROLLER_AXIS_RIGHTX, 0);
         pad.trigger(0.8);
       }},
      {"milled",
       pressing_until([&] { return removed() > 4; },
                      [&](bool down) { pad.trigger(down ? 0.8 : 0); }),
       [&] { pad.trigger(0); }},
      {"lifted", looks(40), {}},
      {"undone",
       [&, look = 0]() mutable {
         // a busy machine may have let go in between: it is several strokes then
         if (look++ % 20 == 0) pad.button(SDL_CONTROLLER_BUTTON_X, look % 40 == 1);
         undone = session.bone().content_hash() == start;
         return undone;
       },
       [&] {
         pad.button(SDL_CONTROLLER_BUTTON_X, false);
         pad.button(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
       }},
      {"a smaller burr", [&] { return session.burr_radius() < first_radius - 1e-5; },
       [&] { pad.button(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, false); }},
  };
  tap(steps, pad, SDL_CONTROLLER_BUTTON_DPAD_RIGHT);
  steps.push_back({"it adds now",
                   [&] {
                     return desk_->status_text.find("add") != std::string::npos ||
                            desk_->status_text.find("Add") != std::string::npos;
                   },
                   {}});
  tap(steps, pad, SDL_CONTROLLER_BUTTON_START);
  tap(steps, pad, SDL_CONTROLLER_BUTTON_BACK);  // closes the help, no more
  steps.push_back({"still here", looks(5), [&] { EXPECT_EQ(desk_->page, Page::milling); }});
  steps.push_back({"leave", looks(2), [&] { pad.button(SDL_CONTROLLER_BUTTON_BACK, true); }});
  steps.push_back({"the question", looks(3), [&] {
                     EXPECT_EQ(desk_->page, Page::milling);
                     pad.button(SDL_CONTROLLER_BUTTON_A, true);
                   }});
  mill_by(*ready, std::move(steps));
  EXPECT_TRUE(undone);
}

TEST_F(HandsWindow, AGamepadThatIsPulledOutWhileItPressesLifts) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  Pad pad;
  tick::TickRow row;
  const auto pedal = [&] {
    static_cast<void>(session.view(row));
    return row.hand.pedal;
  };
  mill_by(*ready,
          {{"seen at rest", looks(20), [&] { pad.trigger(1); }},
           {"pressing", [&] { return pedal() > 0.9; }, [&] { pad.pull_out(); }},
           {"a picture or two", looks(3), [&] { EXPECT_EQ(pedal(), 0); }},
           {"told", [&] { return desk_->status_text.find("disconnected") != std::string::npos; },
            [] { leave_work(); }}});
}

TEST_F(HandsWindow, ATriggerThatIsHeldFromTheStartPressesOnlyAfterItWasLetGo) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  Pad pad;
  pad.trigger(1);
  tick::TickRow row;
  const auto pedal = [&] {
    static_cast<void>(ready->session->view(row));
    return row.hand.pedal;
  };
  mill_by(*ready, {{"held", looks(30),
                    [&] {
                      EXPECT_EQ(pedal(), 0);
                      pad.trigger(0);
                    }},
                   {"let go", looks(5), [&] { pad.trigger(1); }},
                   {"pressing", [&] { return pedal() > 0.9; },
                    [&] { pad.button(SDL_CONTROLLER_BUTTON_B, true); }},
                   {"B lifts", [&] { return pedal() == 0; },
                    [&] { pad.button(SDL_CONTROLLER_BUTTON_B, false); }},
                   {"and it stays so", looks(10), [&] {
                      EXPECT_EQ(pedal(), 0);
                      leave_work();
                    }}});
}

TEST_F(HandsWindow, APedalMillsByItsWayChangesTheBurrAndLetsTheCoolantRun) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  desk_->settings.pedal_burr = 2;
  desk_->settings.pedal_coolant = 1;
  Stick stick(SDL_JOYSTICK_TYPE_UNKNOWN, 1, 4);
  stick.axis(0, -32768);
  const double radius = session.burr_radius();
  tick::TickRow row;
  const auto pedal = [&] {
    static_cast<void>(session.view(row));
    return row.hand.pedal;
  };
  mill_by(
      *ready,
      {{"at rest", looks(20),
        [&] {
          EXPECT_EQ(pedal(), 0);
          move_to(640, 330);
          stick.axis(0, 0);
        }},
       {"half down", [&] { return pedal() > 0.3 && pedal() < 0.6; }, [&] { stick.axis(0, 32767); }},
       {"down",
        pressing_until([&] { return pedal() > 0.99 && row.ledger.removed > 1e-9; },
                       [&](bool down) { stick.axis(0, down ? 32767 : -32768); }),
        [&] { stick.axis(0, -32768); }},
       {"up", [&] { return pedal() == 0; }, [&] { stick.button(2, true); }},
       {"the next burr",
        asking_until([&] { return session.burr_radius() > radius + 1e-5; },
                     [&, down = true]() mutable { stick.button(2, down = !down); }),
        {}},
       {"told", looks(20), [&] { stick.button(1, true); }},
       {"coolant", [&] { return desk_->status_text.find("oolant") != std::string::npos; },
        [&] { stick.button(0, true); }},
       {"by button", [&] { return pedal() > 0.99; }, [&] { stick.pull_out(); }},
       {"pulled out", looks(3), [&] {
          EXPECT_EQ(pedal(), 0);
          leave_work();
        }}});
}

TEST_F(HandsWindow, AFlightStickIsNoPedal) {
  Stick stick(SDL_JOYSTICK_TYPE_UNKNOWN, 6, 12);
  Pedals pedals;
  EXPECT_EQ(pedals.count(), 0);
}

TEST(Hands, RestIsRestAndNumbersThatCannotBeStayWithinBounds) {
  EXPECT_EQ(beyond_dead(0, 0.15), 0);
  EXPECT_EQ(beyond_dead(4500, 0.15), 0);
  EXPECT_GT(beyond_dead(9000, 0.15), 0);
  EXPECT_EQ(beyond_dead(INT_MIN, 0.15), -1);
  EXPECT_EQ(beyond_dead(INT_MAX, 0.15), 1);
  EXPECT_EQ(beyond_dead(std::numeric_limits<double>::quiet_NaN(), 0.15), 0);
  double right = INT_MIN, up = INT_MAX;
  calm_stick(right, up, 0.15);
  EXPECT_NEAR(std::hypot(right, up), 1, 1e-12);
  right = up = 3000;
  calm_stick(right, up, 0.15);
  EXPECT_EQ(right, 0);
  EXPECT_EQ(up, 0);
}

// ---- a cap

class CapWindow : public Window {
 protected:
  void SetUp() override {
    ::setenv("BURR_SPNAV", (test::build_dir() + "/libfake_spnav.so").c_str(), 1);
    void* fake = dlopen((test::build_dir() + "/libfake_spnav.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(fake, nullptr) << dlerror();
    move_ = reinterpret_cast<void (*)(const int*)>(dlsym(fake, "fake_move"));
    press_ = reinterpret_cast<void (*)(int)>(dlsym(fake, "fake_press"));
    daemon_ = reinterpret_cast<void (*)(int)>(dlsym(fake, "fake_daemon"));
    opened_ = reinterpret_cast<int (*)()>(dlsym(fake, "fake_open_count"));
    daemon_(1);
    cap({});
    Window::SetUp();
  }
  void cap(std::array<int, 6> axes) const { move_(axes.data()); }

  void (*move_)(const int*) = nullptr;
  void (*press_)(int) = nullptr;
  void (*daemon_)(int) = nullptr;
  int (*opened_)() = nullptr;
};

TEST_F(CapWindow, MovesPressesTurnsAndChangesTheBurr) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  render::Scene& scene = ready->scene;
  EXPECT_EQ(opened_(), 1);
  const double radius = session.burr_radius();
  tick::TickRow row;
  const auto pedal = [&] {
    static_cast<void>(session.view(row));
    return row.hand.pedal;
  };
  double x = 0, y = 0, azimuth = 0, elevation = 0;
  // a cap tells of itself again and again while it is held
  std::array<int, 6> held = {};
  const auto until = [&](std::function<bool()> done) {
    return [this, &held, done = std::move(done)] {
      cap(held);
      return done();
    };
  };
  mill_by(
      *ready,
      {{"led to the middle", looks(20), [&] { held = {350, 0, 0, 0, 0, 0}; }},
       {"moving", until(looks(1)), [&] { held = {}; }},
       {"settled", until(looks(40)),
        [&] {
          x = across(scene);
          y = above(scene);
          held = {30, -30, 30, 20, -20, 0};
        }},
       {"a cap at rest moves nothing", until(looks(30)),
        [&] {
          EXPECT_NEAR(across(scene), x, 1e-5);
          EXPECT_NEAR(above(scene), y, 1e-5);
          EXPECT_EQ(pedal(), 0);
          held = {300, 0, 0, 0, 0, 0};
        }},
       {"right", until([&] { return across(scene) > x + 2e-3; }),
        [&] { held = {-300, 0, 0, 0, 0, 0}; }},
       {"left", until([&] { return across(scene) < x; }), [&] { held = {}; }},
       {"settled again", until(looks(40)),
        [&] {
          y = above(scene);
          held = {0, 0, 300, 0, 0, 0};
        }},
       {"away is up", until([&] { return above(scene) > y + 2e-3; }),
        [&] { held = {0, 0, -300, 0, 0, 0}; }},
       {"towards is down", until([&] { return above(scene) < y; }),
        [&] {
          azimuth = scene.camera.azimuth;
          held = {0, 0, 0, 0, 300, 0};
        }},
       {"twisted", until([&] { return std::abs(scene.camera.azimuth - azimuth) > 0.1; }),
        [&] {
          EXPECT_LT(std::remainder(scene.camera.azimuth - azimuth, 6.2832), 0)
              << "the bone turns with the cap, the eye the other way";
          elevation = scene.camera.elevation;
          held = {0, 0, 0, scene.camera.elevation > 0.5 ? -300 : 300, 0, 0};
        }},
       {"tilted", until([&] { return std::abs(scene.camera.elevation - elevation) > 0.1; }),
        [&] {
          // back over the bone: the view has turned under the cursor
          held = {};
          move_to(640, 360);
        }},
       {"led by the mouse", until(looks(10)), [&] { held = {0, -300, 0, 0, 0, 0}; }},
       {"pushed in", until([&] { return pedal() > 0.9; }), [&] { held = {0, 300, 0, 0, 0, 0}; }},
       {"pulled", until([&] { return pedal() == 0; }),
        [&] {
          held = {};
          press_(1);
        }},
       {"larger",
        until(asking_until([&] { return session.burr_radius() > radius + 1e-5; },
                           [&] { press_(1); })),
        [&] { press_(0); }},
       {"smaller",
        until(asking_until([&] { return session.burr_radius() < radius + 1e-5; },
                           [&] { press_(0); })),
        [&] { held = {0, INT_MIN, 0, 0, 0, 0}; }},
       {"pressing", until([&] { return pedal() > 0.9; }), {}},
       // now it says nothing any more: the daemon died
       {"lifts by itself", [&] { return pedal() == 0; },
        [&] { held = {INT_MIN, INT_MAX, INT_MIN, INT_MAX, INT_MIN, INT_MAX}; }},
       {"what cannot be", until(looks(10)), [&] {
          EXPECT_TRUE(scene.burr.world_from_tool.p.allFinite());
          EXPECT_TRUE(std::isfinite(scene.camera.azimuth));
          leave_work();
        }}});
  desk_.reset();
  EXPECT_EQ(opened_(), 0) << "left open";
}

TEST_F(CapWindow, BeforeAPlaneItIsAHandOfThreeAxes) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const render::Camera& camera = ready->scene.camera;
  tick::TickRow row;
  const auto hand = [&] {
    static_cast<void>(session.view(row));
    return row.hand.world_from_tool.p;
  };
  std::array<int, 6> held = {};
  math::Vec3 was = math::Vec3::Zero();
  const auto until = [&](std::function<bool()> done) {
    return [this, &held, done = std::move(done)] {
      cap(held);
      return done();
    };
  };
  mill_by(*ready, {{"over the bone", looks(20), [] { move_to(640, 300); }},
                   {"at rest", looks(60), [] { press(SDLK_g); }},
                   {"in the plane", looks(20),
                    [&] {
                      was = hand();
                      held = {0, 300, 0, 0, 0, 0};
                    }},
                   {"up", until([&] { return (hand() - was).dot(camera.above()) > 2e-3; }),
                    [&] {
                      EXPECT_NEAR((hand() - was).dot(camera.backward()), 0, 0.1e-3);
                      EXPECT_EQ(row.hand.pedal, 0);
                      held = {0, -300, 0, 0, 0, 0};
                    }},
                   {"down", until([&] { return (hand() - was).dot(camera.above()) < 0; }),
                    [&] {
                      EXPECT_EQ(row.hand.pedal, 0) << "down is no pressing there";
                      was = hand();
                      held = {0, 0, -300, 0, 0, 0};
                    }},
                   {"towards", until([&] { return (hand() - was).dot(camera.backward()) > 2e-3; }),
                    [&] { held = {0, 0, 300, 0, 0, 0}; }},
                   {"away", until([&] { return (hand() - was).dot(camera.backward()) < 0; }), [&] {
                      held = {};
                      leave_work();
                    }}});
}

TEST(Cap, WithoutLibraryOrDaemonThereIsNone) {
  ::setenv("BURR_SPNAV", "/nowhere/libspnav.so.0", 1);
  SpaceMouse none;
  EXPECT_FALSE(none.there());
  EXPECT_EQ(none.now(0.15).right, 0);
  ::setenv("BURR_SPNAV", "libm.so.6", 1);  // a library that is another
  SpaceMouse other;
  EXPECT_FALSE(other.there());
}

}  // namespace
}  // namespace burr::app
