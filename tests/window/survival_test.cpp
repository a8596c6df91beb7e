// What may happen to a window while one mills: it is resized, put away and brought back, its
// letters grow, the graphics card is lost, the disk is full. The session goes on each time.
#include "window/shell/pages.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <csignal>

#include "burr/record/player.h"
#include "window/parts/kept_sessions.h"
#include "window/user.h"

namespace burr::app {
namespace {

void window_event(SDL_WindowEventID what, int wide = 0, int high = 0) {
  SDL_Event event = {};
  event.type = SDL_WINDOWEVENT;
  event.window.event = what;
  event.window.data1 = wide;
  event.window.data2 = high;
  SDL_PushEvent(&event);
}
void resize(int wide, int high) { SDL_SetWindowSize(SDL_GL_GetCurrentWindow(), wide, high); }

class Survival : public Window {
 protected:
  [[nodiscard]] std::uint64_t tick(sim::Session& session) {
    static_cast<void>(session.view(row_));
    return row_.tick;
  }
  tick::TickRow row_;
};

// the picture as it is at rest: bone in the middle, a strip below
bool something_in(const render::Image& image, int x0, int y0, int x1, int y1) {
  int least = 255, most = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const int v =
          image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x))];
      least = std::min(least, v);
      most = std::max(most, v);
    }
  return most - least > 60;
}

TEST_F(Survival, ResizedWhileMillingItDrawsTheNewSizeAndTheHandGoesOn) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  render::Image small, large;
  std::uint64_t then = 0;
  mill_by(*ready,
          {{"the first picture", looks(3),
            [] {
              move_to(640, 340);
              button(SDL_BUTTON_LEFT, true);
            }},
           {"the press", [&] { return tick(session) > 0 && row_.hand.pedal == 1; },
            [] { resize(900, 600); }},
           {"the small picture", [&] { return desk_->renderer().width() == 900; }, nullptr},
           {"drawn", looks(5),
            [&] {
              small = desk_->renderer().shown();
              then = tick(session);
              move_to(1280, 680);
              resize(2560, 1440);
            }},
           {"the large picture", [&] { return desk_->renderer().width() == 2560; }, nullptr},
           {"drawn", looks(5),
            [&] {
              large = desk_->renderer().shown();
              move_to(640, 340);
              resize(1280, 720);
            }},
           {"as before, and bone to be cut", pressing_until([&] {
              return desk_->renderer().width() == 1280 && tick(session) > then &&
                     row_.ledger.removed > 0;
            }),
            [] { leave_work(); }}});
  EXPECT_EQ(small.width, 900);
  EXPECT_EQ(small.height, 600);
  EXPECT_EQ(large.width, 2560);
  EXPECT_EQ(large.height, 1440);
  EXPECT_TRUE(something_in(small, 200, 100, 700, 400)) << "no bone";
  EXPECT_TRUE(something_in(large, 600, 300, 1900, 1000)) << "no bone";
  EXPECT_TRUE(something_in(large, 300, 1320, 2200, 1430)) << "no strip";
  EXPECT_GT(session.outcome().ticks, then);
  EXPECT_GT(session.outcome().ledger.removed, 0) << "nothing was cut: the test shows nothing";
}

TEST_F(Survival, PutAwayItLiftsTheBurrDrawsNothingAndComesBack) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  render::Image away, later, back;
  mill_by(*ready, {{"the first picture", looks(3),
                    [] {
                      move_to(640, 340);
                      press(SDLK_SPACE);
                    }},
                   {"the press", [&] { return tick(session) > 0 && row_.hand.pedal == 1; },
                    [] { window_event(SDL_WINDOWEVENT_MINIMIZED); }},
                   {"the lift", [&] { return tick(session) > 0 && row_.hand.pedal == 0; }, nullptr},
                   {"a while", looks(3),
                    [&] {
                      away = desk_->renderer().shown();
                      press(SDLK_TAB);  // would be seen
                    }},
                   {"a while", looks(5),
                    [&] {
                      later = desk_->renderer().shown();
                      window_event(SDL_WINDOWEVENT_RESTORED);
                    }},
                   {"a picture", looks(5), [&] {
                      back = desk_->renderer().shown();
                      leave_work();
                    }}});
  EXPECT_EQ(differ(away, later, 0, 0, 1280, 720), 0) << "drawn though nobody sees it";
  EXPECT_GT(differ(later, back, 100, 650, 1180, 712), 10'000) << "the panels are hidden now";
}

TEST_F(Survival, LettersThatGrowWhileMillingAreDrawnLarger) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  float before = 0, after = 0;
  desk_->settings.scale = 0.8;
  mill_by(*ready, {{"the first picture", looks(3), [] { resize(2560, 1440); }},
                   {"a large window", looks(5),
                    [&] {
                      before = desk_->ui().unit();
                      desk_->settings.scale = 1.5;
                    }},
                   {"larger letters", looks(3), [&] {
                      after = desk_->ui().unit();
                      leave_work();
                    }}});
  EXPECT_GT(after, 1.5F * before);
}

TEST_F(Survival, AfterTheGraphicsCardIsLostTheSamePictureIsThereAgainAndBoneIsCutOn) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  render::Image before, after;
  std::uint64_t then = 0;
  const auto at_rest = [&] {
    return [this, n = 0]() mutable { return ++n > 60 && desk_->renderer().refined(); };
  };
  // Tab: without what counts on by itself; far from the bone the tool stands still
  mill_by(*ready, {{"the first picture", looks(3),
                    [] {
                      press(SDLK_TAB);
                      move_to(1200, 60);
                    }},
                   {"a picture at rest", at_rest(),
                    [&] {
                      before = desk_->renderer().shown();
                      then = tick(session);
                      const Status renewed = desk_->renew();
                      EXPECT_TRUE(renewed) << renewed.error().text;
                    }},
                   {"a picture at rest", at_rest(),
                    [&] {
                      after = desk_->renderer().shown();
                      press(SDLK_TAB);
                      move_to(640, 340);
                      button(SDL_BUTTON_LEFT, true);
                    }},
                   {"bone to be cut",
                    pressing_until([&] { return tick(session) > then && row_.ledger.removed > 0; }),
                    [] { leave_work(); }}});
  EXPECT_EQ(desk_->renewed(), 1);
  ASSERT_EQ(after.width, before.width);
  EXPECT_TRUE(something_in(before, 300, 100, 1000, 600)) << "no bone: the test shows nothing";
  // lost bone would be a tenth and more
  EXPECT_LT(differ(before, after, 300, 150, 1000, 700), 700 * 550 / 50);
  EXPECT_TRUE(something_in(after, 300, 100, 1000, 600));
  EXPECT_GT(session.outcome().ledger.removed, 0);
}

TEST_F(Survival, AFullDiskIsSaidInTheWindowAndTheSessionGoesOn) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto was = std::signal(SIGXFSZ, SIG_IGN);
  std::string said, on_start_page;
  Clock::time_point full;
  const Status ended = end_of_pages_by(
      {{"the start page", on(Page::start), [&] { drop(scan()); }},
       {"the import page", on(Page::import), nullptr},
       {"a picture of it", looks(3), [] { press(SDLK_RETURN); }},
       {"milling", on(Page::milling),
        [] {
          move_to(640, 360);
          press(SDLK_SPACE);
          press(SDLK_s);  // to be kept, even if nothing is cut
        }},
       {"a while", looks(30),
        [&] {
          // the disk takes no file longer than this any more
          const rlimit little = {20'000, old.rlim_max};
          ::setrlimit(RLIMIT_FSIZE, &little);
        }},
       {"the sentence",
        [&] {
          said = desk_->status_text;
          return said.find("NOT RECORDED ANY MORE") != std::string::npos;
        },
        [&] { full = Clock::now(); }},
       {"a second more", [&] { return Clock::now() - full > std::chrono::seconds(1); },
        [&] {
          ::setrlimit(RLIMIT_FSIZE, &old);
          leave_work();
        }},
       {"the start page again", on(Page::start), nullptr},
       {"its sentence", looks(3), [&] {
          on_start_page = desk_->message;
          press(SDLK_ESCAPE);
        }}});
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, was);
  EXPECT_NE(said.find(".mcap"), std::string::npos) << said;
  // said once more, and the program ends with the code for it
  ASSERT_FALSE(ended);
  EXPECT_EQ(static_cast<int>(ended.error().trouble), 74);
  EXPECT_NE(ended.error().text.find("its recording is incomplete: it holds the first"),
            std::string::npos)
      << ended.error().text;
  EXPECT_EQ(on_start_page, ended.error().text);
  EXPECT_FALSE(kept_sessions(folder_ / "state").empty());
  // what was written until then opens
  for (const KeptSession& kept : kept_sessions(folder_ / "state")) {
    const auto player = record::Player::open(kept.file.string());
    EXPECT_TRUE(player) << player.error().text;
  }
}

}  // namespace
}  // namespace burr::app
