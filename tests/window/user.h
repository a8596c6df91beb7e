// tests/window/user.h - somebody at the window, without a screen: keys, mouse and drops as SDL
// events, a script of what to do when, and a desk to sit at.
#pragma once

#include <gtest/gtest.h>

#include <SDL2/SDL.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "shared/window_session.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "support/data.h"
#include "support/folder.h"
#include "window/mill/window.h"
#include "window/shell/pages.h"

namespace burr::app {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// ---- what a user does

inline void press(SDL_Keycode code, Uint16 held = KMOD_NONE) {
  SDL_Event event = {};
  event.type = SDL_KEYDOWN;
  event.key.keysym.sym = code;
  event.key.keysym.mod = held;
  SDL_PushEvent(&event);
  event.type = SDL_KEYUP;
  SDL_PushEvent(&event);
}
// Leaves the page for milling: the second Q answers the question of the first.
inline void leave_work() {
  press(SDLK_q);
  press(SDLK_q);
}
inline void move_to(int x, int y) {
  SDL_Event event = {};
  event.type = SDL_MOUSEMOTION;
  event.motion.x = x;
  event.motion.y = y;
  SDL_PushEvent(&event);
}
inline void button(Uint8 which, bool down) {
  SDL_Event event = {};
  event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
  event.button.button = which;
  SDL_PushEvent(&event);
}
inline void click(int x, int y) {
  move_to(x, y);
  button(SDL_BUTTON_LEFT, true);
  button(SDL_BUTTON_LEFT, false);
}
inline void turn_wheel(int by) {
  SDL_Event event = {};
  event.type = SDL_MOUSEWHEEL;
  event.wheel.y = by;
  SDL_PushEvent(&event);
}
inline void type(const std::string& text) {
  for (const char c : text) {
    SDL_Event event = {};
    event.type = SDL_TEXTINPUT;
    event.text.text[0] = c;
    SDL_PushEvent(&event);
  }
}
inline void drop(const fs::path& path) {
  SDL_Event event = {};
  event.type = SDL_DROPFILE;
  event.drop.file = SDL_strdup(path.c_str());
  SDL_PushEvent(&event);
}
inline void close_window() {
  SDL_Event event = {};
  event.type = SDL_QUIT;
  SDL_PushEvent(&event);
}

// One step after another: done when its condition holds; each looks once a picture.
class Script {
 public:
  struct Step {
    const char* what;
    std::function<bool()> when;
    std::function<void()> then;
  };
  // `told`: what the window said last, for a step that never comes
  Script(std::vector<Step> steps, const std::string& told)
      : steps_(std::move(steps)), told_(told) {}

  void look() {
    if (next_ < steps_.size() && steps_[next_].when()) {
      if (steps_[next_].then) steps_[next_].then();
      ++next_;
      since_ = Clock::now();
    } else if (Clock::now() - since_ > std::chrono::seconds(120) && !gave_up_) {
      gave_up_ = true;  // never hang: leave, and say where
      ADD_FAILURE() << "waited in vain: "
                    << (next_ < steps_.size() ? steps_[next_].what : "for the end")
                    << "; told last: \"" << told_ << "\"";
      close_window();
    }
  }
  [[nodiscard]] bool finished() const { return next_ == steps_.size(); }

 private:
  std::vector<Step> steps_;
  const std::string& told_;
  std::size_t next_ = 0;
  Clock::time_point since_ = Clock::now();
  bool gave_up_ = false;
};

// true at the n-th look
inline std::function<bool()> looks(int n) {
  return [n]() mutable { return --n <= 0; };
}

// True once it is `done`, while `press(true)` holds. A busy machine may let the force go; a hand
// lifts then, and presses again.
inline std::function<bool()> pressing_until(
    std::function<bool()> done,
    std::function<void(bool)> press = [](bool down) { button(SDL_BUTTON_LEFT, down); }) {
  return [done = std::move(done), press = std::move(press), since = Clock::time_point()]() mutable {
    if (done()) return true;
    const auto now = Clock::now();
    if (since == Clock::time_point()) since = now;
    if (now - since > std::chrono::seconds(4)) {
      press(true);
      since = now;
    } else if (now - since > std::chrono::seconds(3)) {
      press(false);
    }
    return false;
  };
}

// True once it is `done`; meanwhile, once a second, what was asked for is asked again: a larger
// burr has no room while the tip is still in its hole.
inline std::function<bool()> asking_until(std::function<bool()> done, std::function<void()> ask) {
  return [done = std::move(done), ask = std::move(ask), asked = Clock::now()]() mutable {
    if (done()) return true;
    if (Clock::now() - asked > std::chrono::seconds(1)) {
      ask();
      asked = Clock::now();
    }
    return false;
  };
}

class Window : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("SDL_VIDEODRIVER", "offscreen", 1);
    auto made = Desk::open({folder_ / "config", folder_ / "state", {}});
    if (!made) {
      ASSERT_FALSE(test::data_required()) << made.error().text;
      GTEST_SKIP() << made.error().text;
    }
    desk_ = std::move(*made);
    desk_->governor.most = 0;  // pictures are compared: they must not depend on the machine's load
    SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
  }
  void TearDown() override {
    desk_.reset();
    speak("en");
  }

  // a block by formula, coarse, ready to be milled
  static Result<WindowSession> block() {
    WorkOptions options;
    options.volume.source = "block";
    options.volume.voxel_mm = 0.5;
    NoProgress quiet;
    return open_ready(options, quiet);
  }
  void mill_by(WindowSession& ready, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    const auto left = mill(*desk_, *ready.session, ready.hands, *ready.worker, ready.scene, {});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  void pages_by(std::vector<Script::Step> steps) {
    const Status done = end_of_pages_by(std::move(steps));
    ASSERT_TRUE(done) << done.error().text;
  }
  // what the program ends with
  Status end_of_pages_by(std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    const Status done = run_pages(*desk_, {});
    desk_->after_frame = {};
    EXPECT_TRUE(script.finished());
    return done;
  }
  [[nodiscard]] std::function<bool()> on(Page page) const {
    return [this, page] { return desk_->page == page; };
  }

  // how many pixels differ in a box of two pictures
  static int differ(const render::Image& a, const render::Image& b, int x0, int y0, int x1,
                    int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const std::size_t at =
            3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                 static_cast<std::size_t>(x));
        int by = 0;
        for (std::size_t c = 0; c < 3; ++c) by += std::abs(int{a.rgb[at + c]} - int{b.rgb[at + c]});
        count += by > 24 ? 1 : 0;
      }
    return count;
  }

  // a ball of bone in air, as a scan: 24 x 24 x 24 voxels of 1 mm, HU
  [[nodiscard]] fs::path scan() const {
    const fs::path path = folder_ / "Svensson Karin.nrrd";
    std::ofstream file(path, std::ios::binary);
    file << "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
            "sizes: 24 24 24\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
            "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n";
    for (int k = 0; k < 24; ++k)
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) {
          const double r = std::hypot(i - 11.5, j - 11.5, k - 11.5);
          const auto hu =
              static_cast<std::int16_t>(std::clamp(300 + 700 * (8 - r), -1000.0, 1500.0));
          const char bytes[2] = {static_cast<char>(hu & 0xFF), static_cast<char>((hu >> 8) & 0xFF)};
          file.write(bytes, 2);
        }
    return path;
  }

  const test::Folder own_;
  fs::path folder_ = own_.path();
  std::unique_ptr<Desk> desk_;
};

}  // namespace burr::app
