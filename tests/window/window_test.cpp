// The whole program at once, without a screen: the window's own loop draws, the servo mills, the
// workers mesh, the recorder writes, and a restless user moves the mouse, presses keys, undoes,
// redoes and resets. Run under ThreadSanitizer too, where silence is the test (scripts/tsan_long.sh
// for minutes).
#include "window/mill/window.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <SDL2/SDL.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "burr/base/progress.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/render/bone_scene.h"
#include "burr/render/renderer.h"
#include "burr/rt/changed_bits.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/live_surface.h"
#include "support/data.h"

namespace burr::app {

namespace {

using namespace std::chrono_literals;

// Somebody who never sits still, and leaves after `seconds` at the window if bone was cut by then;
// else a little later. Any thread: SDL takes events from all.
class User {
 public:
  User(std::uint64_t seed, double seconds) : random_(seed), seconds_(seconds) {}
  // main: the window is there; is there anything to see?
  void look(bool cut) {
    looked_ = true;
    cut_ = cut;
  }

 private:
  void run() {
    using Clock = std::chrono::steady_clock;
    while (!done_ && !looked_) std::this_thread::sleep_for(10ms);
    const Clock::time_point sat_down = Clock::now();
    while (!done_) {
      const double sat = std::chrono::duration<double>(Clock::now() - sat_down).count();
      if (sat > seconds_ && ((cut_ && keys_ > 20) || sat > seconds_ + 120)) {
        SDL_Event event = {};
        event.type = SDL_QUIT;
        SDL_PushEvent(&event);
        return;
      }
      move();
      if (random_() % 8 == 0) press(random_() % 4 != 0);
      if (random_() % 40 == 0) wheel();
      if (random_() % 16 == 0) key();
      std::this_thread::sleep_for(8ms);
    }
  }

  void move() {
    // wanders over the middle, where the bone is
    x_ = std::clamp(x_ + static_cast<int>(random_() % 21) - 10, 480, 800);
    y_ = std::clamp(y_ + static_cast<int>(random_() % 21) - 10, 240, 480);
    SDL_Event event = {};
    event.type = SDL_MOUSEMOTION;
    event.motion.x = x_;
    event.motion.y = y_;
    event.motion.xrel = static_cast<int>(random_() % 3) - 1;
    event.motion.yrel = static_cast<int>(random_() % 3) - 1;
    event.motion.state = random_() % 50 == 0 ? SDL_BUTTON_RMASK : 0;
    SDL_PushEvent(&event);
  }
  static void press(bool down) {
    SDL_Event event = {};
    event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
    event.button.button = SDL_BUTTON_LEFT;
    SDL_PushEvent(&event);
  }
  void wheel() {
    SDL_Event event = {};
    event.type = SDL_MOUSEWHEEL;
    event.wheel.y = random_() % 2 == 0 ? 1 : -1;
    SDL_PushEvent(&event);
  }
  void key() {
    constexpr SDL_Keycode kKeys[] = {SDLK_u,     SDLK_u, SDLK_y, SDLK_r, SDLK_1, SDLK_1,
                                     SDLK_2,     SDLK_3, SDLK_4, SDLK_5, SDLK_h, SDLK_PLUS,
                                     SDLK_MINUS, SDLK_f, SDLK_9, SDLK_0};
    SDL_Event event = {};
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = kKeys[random_() % std::size(kKeys)];
    SDL_PushEvent(&event);
    ++keys_;
    if (random_() % 8 == 0) {  // the sound off, and on again at once
      event.key.keysym.sym = SDLK_m;
      SDL_PushEvent(&event);
      SDL_PushEvent(&event);
    }
  }

  std::mt19937_64 random_;
  double seconds_;
  int x_ = 640, y_ = 360, keys_ = 0;
  std::atomic<bool> done_ = false, looked_ = false, cut_ = false;
  std::jthread thread_{[this] { run(); }};  // last: begins when all else is there, ends before it

 public:
  ~User() { done_ = true; }
};

// The loudest of what the loudspeaker was given last: a file of raw floats, which grows.
float loudest(const std::string& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size / 2048 - 8) * 2048);
  float most = 0;
  for (float x = 0; in.read(reinterpret_cast<char*>(&x), sizeof x);)
    most = std::max(most, std::abs(x));
  return most;
}

TEST(WholeProgram, MillsDrawsRecordsUndoesAndResetsAllAtOnce) {
  ::setenv("SDL_VIDEODRIVER", "offscreen", 1);
  {
    const auto gpu = render::Renderer::offscreen();
    if (!gpu) {
      ASSERT_FALSE(test::data_required()) << gpu.error().text;
      GTEST_SKIP() << gpu.error().text;
    }
  }
  const char* command = std::getenv("BURR_WINDOW_SECONDS");
  const double seconds = command != nullptr ? std::atof(command) : 3;
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
  std::printf("%.0f s, BURR_SEED=%llu\n", seconds, static_cast<unsigned long long>(seed));
  test::Folder folder;
  const std::string file = folder / "s.mcap";
  const auto make = [] {
    return phantom::bone_from_distance(phantom::cube_grid(20e-3, 64), {}, phantom::ball(8e-3), 512);
  };
  sim::SessionSettings settings;
  settings.servo.burr.radius = 1.5e-3;
  settings.realtime = true;
  auto bone = make();
  const auto place = surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {});
  ASSERT_TRUE(place) << place.error().text;
  math::Pose above;
  above.p = place->at - 10e-3 * place->into;
  auto owned = std::make_unique<mouse::MouseHand>(above);
  mouse::MouseHand& hand = *owned;
  NoProgress quiet;
  auto made = sim::Session::make(std::move(bone), std::move(owned), settings, quiet);
  ASSERT_TRUE(made) << made.error().text;
  sim::Session& session = **made;

  render::Scene scene;
  scene.tissue_colours = render::colours_of(session.bone().tissues());
  surface::Worker worker(session.bone(), 2);
  ASSERT_TRUE(
      worker.first(quiet, [&](const surface::Skin& skin) { workshop::put_skin(scene, skin); }));
  scene.camera = render::view_of_work(place->at, -place->into, 30e-3);

  record::SessionInfo info;
  sim::describe(session.settings(), session.hand().spec(), info);
  info.volume.grid = session.bone().grid();
  info.volume.tissues = session.bone().tissues();
  info.volume.content_hash = session.bone().content_hash();
  record::Recorder recorder(settings.servo.rate_hz, 8192, true);
  const Status started = recorder.start(file, info);
  ASSERT_TRUE(started) << started.error().text;
  session.set_recorder(&recorder);

  // sound goes into a file; looked for anew it begins the file anew
  ::setenv("SDL_AUDIODRIVER", "disk", 1);
  ::setenv("SDL_DISKAUDIOFILE", (file + ".raw").c_str(), 1);
  float sounded = 0;
  {
    Loudspeaker loudspeaker(settings.servo, {});
    ASSERT_EQ(loudspeaker.trouble(), "");
    rt::ChangedBits& changed = session.bone().add_watcher();
    int cut = 0;
    User user(seed, seconds);
    const auto looks = [&]() -> std::string {
      changed.take_all([&cut](std::size_t) { ++cut; });
      sounded = std::max(sounded, loudest(file + ".raw"));
      user.look(cut > 100);
      return {};
    };
    WindowOptions options;
    options.warning = looks;
    options.loudspeaker = &loudspeaker;
    const Status shown = run_window(session, {.mouse = &hand}, worker, scene, options);
    ASSERT_TRUE(shown) << shown.error().text;
  }
  session.set_recorder(nullptr);
  const auto account = recorder.finish();
  ASSERT_TRUE(account) << account.error().text;
  const sim::Outcome outcome = session.outcome();
  std::printf("%llu ticks (%llu missed), %llu commands, %llu changed bricks, %.1f mm3 removed\n",
              static_cast<unsigned long long>(outcome.ticks),
              static_cast<unsigned long long>(outcome.timing.missed),
              static_cast<unsigned long long>(account->commands),
              static_cast<unsigned long long>(account->brick_rows), 1e9 * outcome.ledger.removed);
  EXPECT_GT(sounded, 0) << "nothing was to be heard of it";
  EXPECT_TRUE(account->whole());
  EXPECT_EQ(account->ticks, outcome.ticks);
  EXPECT_EQ(account->written_ticks, outcome.ticks);
  EXPECT_GT(account->commands, 0U) << "no command was given: the test shows nothing";
  EXPECT_GT(account->brick_rows, 0U) << "nothing was cut: the test shows nothing";

  // what was recorded is what is there
  auto player = record::Player::open(file);
  ASSERT_TRUE(player) << player.error().text;
  auto again = make();
  const Status there = (*player)->bone_at(1e9, *again);
  ASSERT_TRUE(there) << there.error().text;
  EXPECT_EQ(again->content_hash(), session.bone().content_hash());
  if (seconds <= 30) {
    const auto replayed = sim::replay(**player, make(), quiet);
    ASSERT_TRUE(replayed) << replayed.error().text;
    EXPECT_FALSE(replayed->first_different_tick.has_value())
        << *replayed->first_different_tick << ": " << replayed->difference;
    EXPECT_EQ(replayed->ticks, outcome.ticks);
  }
  if (HasFailure()) {
    folder.keep();
    std::printf("kept for a look: %s\n", file.c_str());
  }
}

}  // namespace
}  // namespace burr::app
