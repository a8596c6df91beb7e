// A haptic device at the window: the library is one that the test plays, loaded as the real one is.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "burr/tick/second_hand.h"
#include "burr/volume/pieces.h"
#include "burr/workshop/device_book.h"
#include "burr/workshop/suction_hand.h"
#include "device/fake/fake_hd.h"
#include "shared/window_session.h"
#include "shared/work.h"
#include "support/test_places.h"
#include "window/mill/side_panel.h"
#include "window/stick.h"
#include "window/two_blocks.h"
#include "window/user.h"

namespace burr::app {
namespace {

using math::Vec3;

class DeviceWindow : public Window {
 protected:
  void SetUp() override {
    const std::string library = test::build_dir() + "/fakes/libHD.so";
    ::setenv("BURR_OPENHAPTICS", library.c_str(), 1);
    ::setenv("XDG_CONFIG_HOME", fs::absolute(folder_).c_str(), 1);
    void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL);
    ASSERT_NE(loaded, nullptr);
    hd_ = reinterpret_cast<test::FakeHdState>(dlsym(loaded, "fake_hd"))();
    const std::lock_guard lock(hd_->mutex);
    hd_->touch = {};
    hd_->rate = 1000;
    Window::SetUp();
  }
  void TearDown() override {
    Window::TearDown();
    ::unsetenv("BURR_OPENHAPTICS");
    ::unsetenv("XDG_CONFIG_HOME");
  }

  static Result<WindowSession> with_touch(const std::string& suction = {}) {
    WorkOptions options;
    options.suction = suction;
    options.volume.source = "block";
    options.volume.voxel_mm = 0.5;
    options.hand.device = "touch";
    NoProgress quiet;
    return open_ready(options, quiet);
  }
  // Where the block's case has its work.
  static Result<surgeon::WorkPlace> work_place(sim::Session& session) {
    WorkOptions block;
    block.volume.source = "block";
    if (const Status taken = take_case(block); !taken) return taken.error();
    return surgeon::find_work_place(session.bone(), 0.5e-3 * block.burr_mm, block.at, block.into);
  }
  void stylus(const Vec3& mm, int buttons = 0) {
    const std::lock_guard lock(hd_->mutex);
    std::copy_n(mm.data(), 3, hd_->touch[0].transform.begin() + 12);
    hd_->touch[0].buttons = buttons;
  }
  Vec3 hand(sim::Session& session) {
    static_cast<void>(session.view(row_));
    return row_.hand.world_from_tool.p;
  }
  bool lifted(sim::Session& session) {
    static_cast<void>(session.view(row_));
    return (row_.hand.buttons & device::kLifted) != 0;
  }

  test::FakeHd* hd_ = nullptr;
  tick::TickRow row_;
};

TEST_F(DeviceWindow, ItsAxesAreThoseOfTheViewAlsoOfATurnedOne) {
  auto ready = with_touch();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const render::Scene& scene = ready->scene;
  Vec3 at = Vec3::Zero();
  // Moves the stylus by `mm` until the tip has gone that `way`; once more where a machine that
  // stalled lost the hand meanwhile.
  const auto moving_until = [&](const Vec3& mm, auto way) {
    return [&, mm, way, start = Vec3(Vec3::Zero()), asked = Clock::time_point()]() mutable {
      if (asked != Clock::time_point() && (hand(session) - start - 1e-3 * way()).norm() < 1e-5)
        return true;
      if (Clock::now() - asked < std::chrono::seconds(1)) return false;
      asked = Clock::now();
      start = hand(session);
      at += mm;
      stylus(at);
      return false;
    };
  };
  mill_by(*ready, {{"at rest", looks(20), {}},
                   {"ten millimetres to the right of the picture",
                    moving_until({10, 0, 0}, [&] { return Vec3(10 * scene.camera.right()); }),
                    {}},
                   {"up", moving_until({0, 5, 0}, [&] { return Vec3(5 * scene.camera.above()); }),
                    [] {
                      for (int n = 0; n < 6; ++n) press(SDLK_LEFT);
                    }},
                   {"turned", looks(10), {}},
                   {"to the user",
                    moving_until({0, 0, 8}, [&] { return Vec3(8 * scene.camera.backward()); }),
                    [] { leave_work(); }}});
}

TEST_F(DeviceWindow, StopsByKeyAndGoesOnByTheSame) {
  auto ready = with_touch();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  Vec3 start = Vec3::Zero();
  mill_by(*ready,
          {{"at rest", looks(20),
            [&] {
              EXPECT_FALSE(lifted(session));
              press(SDLK_BACKSPACE);
            }},
           {"stopped", [&] { return lifted(session); }, {}},
           {"and said", [&] { return desk_->status_text.find("Stopped") != std::string::npos; },
            [&] {
              start = hand(session);
              stylus({0, 20, 0}, 1);
            }},
           {"nothing moves, nothing mills", looks(20),
            [&] {
              EXPECT_EQ(hand(session), start);
              EXPECT_EQ(row_.hand.pedal, 0);
              stylus({0, 20, 0}, 0);
              press(SDLK_BACKSPACE);
            }},
           {"on again", [&] { return !lifted(session); },
            [&] {
              EXPECT_NEAR((hand(session) - start).norm(), 0, 1e-6);
              leave_work();
            }}});
}

TEST_F(DeviceWindow, TakenAgainInBoneItSaysToLiftFirst) {
  auto ready = with_touch();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const math::Quat view = view_of_hand(ready->scene.camera);
  const auto place = work_place(session);
  ASSERT_TRUE(place);
  double deep = 0;
  const auto goes_by = [&](double mm) {
    deep += mm;
    stylus(view.conjugate() * (deep * place->into));
  };
  const auto said = [&] {
    return desk_->status_text.find(word(Word::begins_free)) != std::string::npos;
  };
  mill_by(*ready, {{"at rest", looks(20), [&] { EXPECT_FALSE(said()) << desk_->status_text; }},
                   {"in contact",
                    [&] {
                      static_cast<void>(hand(session));
                      if (row_.contact.touching) return true;
                      goes_by(0.5);
                      return false;
                    },
                    [] { press(SDLK_BACKSPACE); }},
                   {"stopped", [&] { return lifted(session); }, [] { press(SDLK_BACKSPACE); }},
                   {"what to do", said, {}},
                   {"nothing is felt", looks(20),
                    [&] {
                      static_cast<void>(hand(session));
                      EXPECT_EQ(row_.contact.force, Vec3::Zero());
                    }},
                   {"lifted off, it is silent",
                    [&] {
                      goes_by(-0.5);
                      return !said();
                    },
                    [] { leave_work(); }}});
}

TEST_F(DeviceWindow, AFootOnTheClutchLiftsIt) {
  auto ready = with_touch();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const Stick pedal(SDL_JOYSTICK_TYPE_UNKNOWN, 1, 5);
  pedal.axis(0, -32768);
  Vec3 start = Vec3::Zero();
  mill_by(*ready, {{"at rest", looks(20),
                    [&] {
                      EXPECT_FALSE(lifted(session));
                      pedal.button(3, true);
                    }},
                   {"lifted", [&] { return lifted(session); },
                    [&] {
                      start = hand(session);
                      stylus({15, 0, 0});
                    }},
                   {"laid elsewhere", looks(20),
                    [&] {
                      EXPECT_EQ(hand(session), start);
                      pedal.button(3, false);
                    }},
                   {"let down", [&] { return !lifted(session); },
                    [&] {
                      EXPECT_NEAR((hand(session) - start).norm(), 0, 1e-6);
                      leave_work();
                    }}});
}

TEST_F(DeviceWindow, ASecondOneLeadsTheSuctionAndFeelsTheBone) {
  {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[1].name = "Left";
    hd_->touch[1].serial = "T-0002";
    hd_->touch[1].present = true;
  }
  {
    auto ready = with_touch("touch:Left");
    ASSERT_TRUE(ready) << ready.error().text;
    sim::Session& session = *ready->session;
    const auto place = work_place(session);
    ASSERT_TRUE(place);
    const math::Quat view = view_of_hand(ready->scene.camera);
    const auto tube = [&]() -> const render::Rod* {
      for (const render::Rod& rod : ready->scene.rods)
        if (rod.radius == workshop::SuctionHand::kRadius) return &rod;
      return nullptr;
    };
    const auto stylus_goes = [&](const Vec3& mm) {
      const std::lock_guard lock(hd_->mutex);
      Eigen::Map<Vec3>(hd_->touch[1].transform.data() + 12) = view.conjugate() * mm;
    };
    const auto felt = [&] {
      const std::lock_guard lock(hd_->mutex);
      const auto& forces = hd_->touch[1].forces;
      return forces.empty() ? Vec3(Vec3::Zero())
                            : Vec3(forces.back()[0], forces.back()[1], forces.back()[2]);
    };
    // By a millimetre a picture, as a hand goes; the tip begins 20 mm above the work. A machine that
    // stalls loses the hand: the tube then stays where it is while the stylus moves on, and it has
    // no force until it is in free air again. So the place of the tube is looked at, not that of
    // the stylus; and where the hand was lost, it is lifted off and comes again.
    double deep = 0;
    int steps = 0;
    bool back = false;
    Clock::time_point moved;
    const auto by = [&](int mm) {
      deep += mm;
      stylus_goes(deep * place->into);
      moved = Clock::now();
    };
    const auto still_for = [&](int ms) {
      return Clock::now() - moved > std::chrono::milliseconds(ms);
    };
    Vec3 start = Vec3::Zero(), from = Vec3::Zero(), burr = Vec3::Zero(), force = Vec3::Zero();
    const auto way_mm = [&] { return 1e3 * (tube()->a - start).dot(place->into); };
    // Goes on by `mm` until it is `done`. If it is not within two seconds: back to `free` [mm of
    // the tube's way], and once more.
    const auto goes_by = [&](int mm, double free, auto done) {
      return [&, mm, free, done] {
        if (tube() == nullptr) return false;
        if (back) {
          if (way_mm() > free + 0.1) by(-1);
          if (!still_for(200)) return false;
          back = false;
          steps = 0;
        }
        if (steps == 0) from = tube()->a;
        if (steps < mm) {
          ++steps;
          by(1);
          return false;
        }
        if (done()) {
          steps = 0;
          return true;
        }
        back = still_for(2000);
        return false;
      };
    };
    mill_by(
        *ready,
        {{"the tube", [&] { return tube() != nullptr; },
          [&] {
            start = tube()->a;
            burr = hand(session);
          }},
         {"it goes by itself, as far as the hand",
          goes_by(15, 0, [&] { return (tube()->a - from - 15e-3 * place->into).norm() < 1e-6; }),
          {}},
         {"it rests on the bone, and the hand feels it",
          goes_by(7, 15,
                  [&] {
                    force = felt();
                    return force.norm() > 0.5 && way_mm() > 17 && way_mm() < 20;
                  }),
          [&] {
            const Vec3 push = view * force.normalized();
            EXPECT_LT(push.dot(place->into), -0.9) << "outwards";
            EXPECT_EQ(hand(session), burr) << "the burr stays";
            EXPECT_EQ(row_.ledger.removed, 0);
            press(SDLK_BACKSPACE);
          }},
         {"the stop is one for both hands", [&] { return felt() == Vec3::Zero(); },
          [] { leave_work(); }}});
  }
  const std::lock_guard lock(hd_->mutex);
  EXPECT_LE(hd_->touch[1].largest_force, 3.3 + 1e-9);
  EXPECT_FALSE(hd_->touch[1].open);
}

// With a tool of the rack: it can cut, and its parts are in the picture where its hand is.
TEST_F(DeviceWindow, ASecondOneHoldsAToolThatCuts) {
  {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[1].name = "Left";
    hd_->touch[1].serial = "T-0002";
    hd_->touch[1].present = true;
  }
  WorkOptions options;
  options.suction = "touch:Left";
  options.tool.second = "lindemann";
  options.volume.source = "block";
  options.volume.voxel_mm = 0.5;
  options.hand.device = "touch";
  NoProgress quiet;
  auto ready = open_ready(options, quiet);
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  ASSERT_NE(session.second_hand()->cutting(), nullptr);
  tick::TickRow second;
  const auto drawn = [&] {
    static_cast<void>(session.second_hand()->view().take(second));
    const auto& beside = ready->scene.beside;  // its own surface, where it is
    return beside && beside->look != nullptr &&
           (beside->world_from_tool.p - second.contact.proxy).norm() < 9e-3;
  };
  mill_by(*ready, {{"the tool is drawn", drawn, [&] {
                      EXPECT_EQ(second.tool.number, 0);
                      EXPECT_EQ(second.ledger.removed, 0) << "in free air";
                      leave_work();
                    }}});
}

// The mouse leads the burr, a device the suction: the stop is for both.
TEST_F(DeviceWindow, TheStopStopsAMouseBesideASuctionToo) {
  WorkOptions options;
  options.suction = "touch";
  options.volume.source = "block";
  options.volume.voxel_mm = 0.5;
  NoProgress quiet;
  auto ready = open_ready(options, quiet);
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  const auto removed = [&] {
    static_cast<void>(session.view(row_));
    return row_.ledger.removed;
  };
  double then = 0;
  mill_by(*ready, {{"the first picture", looks(3),
                    [] {
                      move_to(640, 340);
                      button(SDL_BUTTON_LEFT, true);
                    }},
                   {"bone to be cut", pressing_until([&] { return removed() > 0; }),
                    [] { press(SDLK_BACKSPACE); }},
                   {"stopped", looks(20), [&] { then = removed(); }},
                   {"nothing more is cut", looks(30), [&] {
                      EXPECT_EQ(removed(), then);
                      EXPECT_EQ(row_.hand.pedal, 0);
                      button(SDL_BUTTON_LEFT, false);
                      leave_work();
                    }}});
}

// Chosen with the mouse, looked for at once, and there again at the next start.
TEST_F(DeviceWindow, IsChosenOnTheStartPageAndKept) {
  const auto taken = [this] {
    const std::lock_guard lock(hd_->mutex);
    return hd_->touch[0].open;
  };
  bool led = false;
  pages_by({{"the start page", on(Page::start), nullptr},
            {"its pictures", looks(5), [] { click(1100, 648); }},
            {"the list", looks(5), [] { click(900, 523); }},  // its second line
            {"it is kept", [&] { return desk_->settings.device == "touch"; }, nullptr},
            {"looked for and let be", looks(30), [] { click(200, 240); }},  // the first case
            {"milling", on(Page::milling), [&] { led = taken(); }},
            {"pictures", looks(5), [] { leave_work(); }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_TRUE(led);
  EXPECT_FALSE(taken());
  EXPECT_EQ(desk_->message, "");
  const SettingsRead kept = read_settings(desk_->places().config / "settings.toml");
  EXPECT_EQ(kept.settings.device, "touch");
}

TEST_F(DeviceWindow, OneThatIsNotThereIsToldAndTheMouseStaysAWay) {
  {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[0].present = false;
  }
  desk_->settings.device = "touch";
  std::string told;
  pages_by({{"the start page", on(Page::start), nullptr},
            {"its pictures", looks(5), [] { click(200, 240); }},
            {"the sentence", [&] { return desk_->page == Page::start && !desk_->message.empty(); },
             [&] {
               told = desk_->message;
               desk_->settings.device.clear();
               press(SDLK_ESCAPE);
             }}});
  EXPECT_NE(told.find("does not answer"), std::string::npos) << told;
}

TEST_F(DeviceWindow, PulledOutItIsSaidAndTheLastTicksAreKept) {
  auto ready = with_touch();
  ASSERT_TRUE(ready) << ready.error().text;
  const auto set_there = [&](bool there) {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[0].present = there;
  };
  mill_by(*ready, {{"at rest", looks(20), [&] { set_there(false); }},
                   {"said, with the cure",
                    [&] { return desk_->status_text.find("cable") != std::string::npos; },
                    {}},
                   {"kept", [&] { return fs::exists(folder_ / "state" / "faults"); },
                    [&] { set_there(true); }},
                   {"there again",
                    [&] {
                      static_cast<void>(hand(*ready->session));
                      return row_.hand.valid;
                    },
                    [] { leave_work(); }}});
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "state" / "faults")) {
    std::ifstream file(entry.path());
    std::string first;
    std::getline(file, first);
    EXPECT_NE(first.find("force released"), std::string::npos) << first;
    ++files;
  }
  EXPECT_GE(files, 1);
}

TEST_F(DeviceWindow, ItsSettingsAreChangedThereAndKeptInItsBook) {
  std::optional<WindowSession> ready = std::move(*with_touch());
  const std::string id = ready->hands.id;
  EXPECT_EQ(ready->hands.max_force, 3.3);
  const auto none = [] {};
  const auto kept = [&] { return workshop::DeviceBook::read(workshop::users_book()).of(id); };
  // below the two sliders of gamepad and SpaceMouse
  mill_by(*ready, {{"the first picture", looks(3), [] { press(SDLK_F2); }},
                   {"the page", looks(5), [] { click(1280 / 2 + 200, 83); }},
                   {"its other leaf", looks(5), [] { click(500, 266); }},
                   {"the force", [&] { return kept().max_force_n > 0; }, none},
                   {"the next", looks(3), [] { click(416, 377); }},
                   {"dead-man", [&] { return kept().mapping.dead_man; }, none},
                   {"a look", looks(3), [] { press(SDLK_ESCAPE); }},
                   {"the page to go", looks(5), [] { leave_work(); }}});
  EXPECT_LT(kept().max_force_n, 3.3);
  EXPECT_EQ(kept().mapping.scale, 1);
  EXPECT_EQ(ready->session->servo().settings().limit.user_force, 3.3) << "as it began";
  ready.reset();
  const auto again = with_touch();
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(again->hands.max_force, kept().max_force_n);
}

TEST_F(DeviceWindow, ADeviceThatIsNotThereIsRefusedBeforeTheBoneIsMade) {
  {
    const std::lock_guard lock(hd_->mutex);
    hd_->touch[0].present = false;
  }
  const auto ready = with_touch();
  ASSERT_FALSE(ready);
  EXPECT_NE(ready.error().text.find("cable"), std::string::npos) << ready.error().text;
}

// A piece of bone that was taken, carried by the hand of a device.
class CarriedPiece : public DeviceWindow {
 protected:
  static constexpr double kMm = 1e-3;

  void hold(const Vec3& mm, double degrees, bool grabs) {
    const std::lock_guard lock(hd_->mutex);
    test::FakeTouch& touch = hd_->touch[0];
    const double a = degrees * M_PI / 180;
    touch.transform = {std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a), 0,      0,
                       0,           0,           1, 0, mm.x(),       mm.y(),      mm.z(), 1};
    touch.buttons = grabs ? 1 : 0;
  }
  void click_take() const {
    const float u = desk_->ui().unit();
    click(static_cast<int>((kSideLeft + kSideWide - 50) * u),
          static_cast<int>((kSideTop + 48 + 16) * u));
  }
  // Where the corners of the ghost are.
  static std::vector<Vec3> places(const WindowSession& ready, std::size_t softs) {
    std::vector<Vec3> out;
    if (ready.scene.soft.size() <= softs) return out;
    for (const render::SkinVertex& vertex : ready.scene.soft.back().mesh->vertices)
      out.push_back(vertex.p.cast<double>());
    return out;
  }
  static Vec3 middle(const std::vector<Vec3>& points) {
    math::Aabb box;
    for (const Vec3& p : points) box.extend(p);
    return box.centre();
  }

  static std::size_t farthest(const std::vector<Vec3>& points) {
    std::size_t found = 0;
    for (std::size_t n = 1; n < points.size(); ++n)
      if ((points[n] - points[0]).norm() > (points[found] - points[0]).norm()) found = n;
    return found;
  }

  void carries(WindowSession& ready) {
    const std::size_t softs = ready.scene.soft.size();
    const render::Scene& scene = ready.scene;
    std::vector<Vec3> start;
    Vec3 at = Vec3(3, 0, 0);  // of the stylus [mm]
    double turned = 0;        // [degree]
    // Of the copy, along the axes of the picture [mm], and about the one to the user [degree].
    const auto by = [&] {
      const std::vector<Vec3> now = places(ready, softs);
      if (now.empty()) return Vec3(Vec3::Constant(1e3));
      return Vec3(1e3 * (view_.conjugate() * (middle(now) - middle(start))));
    };
    const auto turn = [&] {
      const std::vector<Vec3> now = places(ready, softs);
      if (now.empty()) return 1e3;
      const std::size_t far = farthest(start);
      const Vec3 before = view_.conjugate() * (start[far] - start[0]),
                 after = view_.conjugate() * (now[far] - now[0]);
      return std::remainder(
          (std::atan2(after.y(), after.x()) - std::atan2(before.y(), before.x())) * 180 / M_PI,
          360);
    };
    const auto lies_at = [&](const Vec3& mm, double degrees) {
      return (by() - mm).norm() < 0.02 && std::abs(turn() - degrees) < 0.1;
    };
    // Lets go, grabs, and goes by what is left; again where a busy machine lost the hand meanwhile.
    const auto carrying_to = [&](const Vec3& mm, double degrees) {
      return [&, mm, degrees, pictures = 0]() mutable {
        constexpr int kRound = 60, kGrab = 10, kGo = 20;
        if (lies_at(mm, degrees)) return true;
        const int now = pictures++ % kRound;
        if (now == kGo) {
          at += mm - by();
          turned += degrees - turn();
        }
        hold(at, turned, now >= kGrab);
        return false;
      };
    };
    mill_by(
        ready,
        {{"a picture", looks(3), [] { press(SDLK_m, KMOD_CTRL); }},
         {"the frame of the piece", [&] { return scene.rods.size() >= 12; }, [&] { click_take(); }},
         {"the ghost",
          asking_until([&] { return scene.soft.size() > softs; }, [&] { click_take(); }),
          [&] {
            start = places(ready, softs);
            view_ = view_of_hand(scene.camera);
            hold(at, 0, false);
          }},
         {"a hand that does not grab moves nothing", looks(30),
          [&] { EXPECT_TRUE(lies_at(Vec3::Zero(), 0)); }},
         {"the copy has followed", carrying_to({6, 0, 0}, 0),
          [&] {
            static_cast<void>(hand(*ready.session));
            EXPECT_EQ(row_.spindle_rad_s, 0) << "the button drives no tool";
            EXPECT_EQ(row_.tool.mode == tool::Mode::touch, ready.hands.real != nullptr);
            hold(at, turned, false);
          }},
         {"let go", looks(20),
          [&] {
            hold(at = {-5, 0, 0}, turned, false);
          }},
         {"it stays", looks(20),
          [&] {
            EXPECT_TRUE(lies_at({6, 0, 0}, 0)) << by();
          }},
         {"up and turned", carrying_to({6, 2, 0}, 15), [&] { hold(at, turned, false); }},
         {"let go again", looks(20),
          [&] {
            EXPECT_TRUE(lies_at({6, 2, 0}, 15)) << by();
            press(SDLK_RETURN);
          }},
         // a note of a fault of the hand may replace that one, on a busy machine
         {"it lies there, and the copy is gone", [&] { return scene.soft.size() == softs; }, {}},
         {"the tool cuts again",
          [&] {
            static_cast<void>(hand(*ready.session));
            return row_.tool.mode == tool::Mode::cut;
          },
          [] { close_window(); }}});
    EXPECT_EQ(ready.session->outcome().ledger.removed, 0) << "the button that carries cuts nothing";
    const volume::PieceFinder finder(std::as_const(ready.session->bone()));
    ASSERT_EQ(finder.pieces().size(), 2U);
    const volume::Piece& piece = finder.pieces().back();
    const Vec3 lies =
        ready.session->bone().grid().world_from_grid(0.5 * (piece.low + piece.high).cast<double>());
    EXPECT_LT((lies - middle(start) - view_ * Vec3(6, 2, 0) * kMm).norm(), kBlockVoxel);
  }

  math::Quat view_;  // x right, y up, z to the user, as the piece was taken
};

TEST_F(CarriedPiece, ByTheFirstHandWhoseToolRestsMeanwhile) {
  WorkOptions options;
  options.hand.device = "touch";
  auto ready = ready_two_blocks(options);
  ASSERT_TRUE(ready) << ready.error().text;
  carries(*ready);
}

TEST_F(CarriedPiece, ByAFreeSecondHandBesideAMouse) {
  WorkOptions options;
  options.suction = "touch";
  auto ready = ready_two_blocks(options);
  ASSERT_TRUE(ready) << ready.error().text;
  carries(*ready);
}

}  // namespace
}  // namespace burr::app
