// All that a key does while a recording is played, the mouse does too; and what is shown after a jump.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "burr/record/player.h"
#include "support/test_places.h"
#include "user.h"
#include "window/parts/kept_sessions.h"
#include "window/parts/measuring.h"
#include "window/replay/replay_bar.h"
#include "window/replay/replay_page.h"
#include "window/shell/pages.h"

namespace burr::app {
namespace {

int run_burr(const std::string& words) {
  const int left =
      std::system((test::build_dir() + "/burr --quiet " + words + " > /dev/null").c_str());
  return WIFEXITED(left) ? WEXITSTATUS(left) : -1;
}

class ReplayByMouse : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    ASSERT_EQ(run_burr("mill phantom:block --voxel-mm 0.5 --motion pocket --burr-mm 5 --seconds 4 "
                       "--record " +
                       file_.string()),
              0);
    auto player = record::Player::open(file_.string());
    ASSERT_TRUE(player) << player.error().text;
    end_ = (*player)->seconds();
    const auto last = (*player)->tick_at(end_);
    ASSERT_TRUE(last);
    removed_ = last->ledger.removed - last->ledger.undone;
    ASSERT_GT(removed_, 0) << "nothing was cut: the test shows nothing";
  }
  void watch_by(double from, std::vector<Script::Step> steps, const std::string& beside = {},
                const std::function<void()>& each = {}) {
    Script script(std::move(steps), seen_.note);
    desk_->after_frame = [&] {
      if (each) each();
      script.look();
    };
    const auto left =
        watch_file(*desk_, file_.string(), {},
                   {.folder = folder_.string(), .from = from, .beside = beside, .seen = &seen_});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  [[nodiscard]] const BarPlace* place(Action action) const {
    const auto at = std::find_if(seen_.buttons.begin(), seen_.buttons.end(),
                                 [&](const BarPlace& one) { return one.action == action; });
    return at == seen_.buttons.end() ? nullptr : &*at;
  }
  void push(Action action) const {
    const BarPlace* at = place(action);
    ASSERT_NE(at, nullptr) << static_cast<int>(action);
    click(static_cast<int>(at->x + at->w / 2), static_cast<int>(at->y + at->h / 2));
  }
  [[nodiscard]] std::function<void()> pushes(Action action) const {
    return [this, action] { push(action); };
  }
  // The step before has pushed a button; this one comes when it has done its work, and pushes the next.
  [[nodiscard]] Script::Step then(const char* what, std::function<bool()> did, Action next) const {
    return {what, std::move(did), pushes(next)};
  }
  [[nodiscard]] bool told(Word words) const {
    return seen_.note.find(word(words)) != std::string::npos;
  }

  fs::path file_ = folder_ / "s.mcap";
  double end_ = 0, removed_ = 0;
  Watched seen_;
};

// Keys of watch_keys.cpp that have a button; the other ones turn and zoom the view, or go along the
// time line, as the mouse does there.
TEST(ReplayBar, HasEachActionOnceWithItsKey) {
  const std::vector<Action> bar = replay_bar_actions();
  EXPECT_EQ(std::set<Action>(bar.begin(), bar.end()).size(), bar.size());
  for (const Action wanted :
       {Action::step_back, Action::step_on, Action::stroke_back, Action::stroke_on, Action::beside,
        Action::compare, Action::earlier, Action::later, Action::slices, Action::see_through,
        Action::first_view, Action::labels, Action::picture, Action::export_, Action::hide,
        Action::help, Action::leave})
    EXPECT_EQ(std::count(bar.begin(), bar.end(), wanted), 1) << static_cast<int>(wanted);
}

TEST_F(ReplayByMouse, EveryButtonDoesWhatItsKeyDoes) {
  render::Image labelled, plain, turned, again;
  const auto at = [this](double t) { return [this, t] { return std::abs(seen_.t - t) < 1e-9; }; };
  double before = 0;
  watch_by(
      2,
      {{"a picture", looks(5), pushes(Action::step_on)},
       then("a second later", at(3), Action::step_back),
       then("and back", at(2), Action::stroke_back),
       {"a stroke before", [&] { return seen_.t < 2; },
        [&] {
          before = seen_.t;
          push(Action::stroke_on);
        }},
       then(
           "a stroke after", [&] { return seen_.t > before; }, Action::play),
       then(
           "it plays", [&] { return seen_.playing; }, Action::play),
       then(
           "it pauses", [&] { return !seen_.playing; }, Action::faster),
       then(
           "faster", [&] { return seen_.pace == 2; }, Action::slower),
       {"slower", [&] { return seen_.pace == 1; }, [] { press(SDLK_HOME); }},
       then("the start", at(0), Action::step_on),
       {"somewhere in it", at(1),
        [&] {
          before = seen_.t;
          push(Action::film_from);
        }},
       then(
           "the film begins here", [&] { return seen_.film_from == before; }, Action::film_from),
       then(
           "or not", [&] { return seen_.film_from == 0; }, Action::film_until),
       then(
           "the film ends here", [&] { return seen_.film_until == before; }, Action::slices),
       then(
           "slices", [&] { return seen_.slices == 1; }, Action::slices),
       then(
           "no slices", [&] { return seen_.slices == 0; }, Action::see_through),
       then(
           "transparent", [&] { return seen_.note == say(Word::see_through, 40.0); },
           Action::see_through),
       then(
           "more", [&] { return seen_.note == say(Word::see_through, 65.0); }, Action::see_through),
       then(
           "more", [&] { return seen_.note == say(Word::see_through, 85.0); }, Action::see_through),
       {"whole", [&, wait = 0]() mutable { return told(Word::bone_whole) && ++wait > 10; },
        [&] {
          labelled = desk_->renderer().shown();
          push(Action::labels);
        }},
       {"labels off", looks(10),
        [&] {
          plain = desk_->renderer().shown();
          for (int n = 0; n < 9; ++n) press(SDLK_UP);
        }},
       {"turned", looks(10),
        [&] {
          turned = desk_->renderer().shown();
          push(Action::first_view);
        }},
       {"the first view", looks(10),
        [&] {
          again = desk_->renderer().shown();
          push(Action::picture);
        }},
       then(
           "a picture", [&] { return fs::exists(folder_ / "burr_001.png"); }, Action::earlier),
       then(
           "no second one yet", [&] { return told(Word::replay_second_first); }, Action::later),
       then("no second one yet", looks(3), Action::export_),
       {"the page", [&] { return seen_.exporting; }, [] { press(SDLK_ESCAPE); }},
       then(
           "no page", [&] { return !seen_.exporting; }, Action::help),
       {"help", [&] { return seen_.help; }, [] { press(SDLK_ESCAPE); }},
       then(
           "no help", [&] { return !seen_.help; }, Action::hide),
       {"no panels", [&] { return !seen_.panels; }, [] { click(640, 300); }},
       then(
           "panels again", [&] { return seen_.panels; }, Action::beside),
       // the dialog for a second recording
       {"the dialog", looks(4), [] { press(SDLK_ESCAPE); }},
       then("no dialog", looks(4), Action::compare),
       {"the dialog", looks(4),
        [this] {
          press(SDLK_ESCAPE);
          drop(file_);
        }},
       then(
           "both", [&] { return seen_.beside && seen_.table.w > 0 && !seen_.behind; },
           Action::later),
       then(
           "later", [&] { return seen_.shift == 0.5; }, Action::earlier),
       then(
           "earlier", [&] { return seen_.shift == 0; }, Action::compare),
       then(
           "measured", [&] { return seen_.coloured || seen_.measured; }, Action::compare),
       then(
           "no table", [&] { return seen_.table.w == 0; }, Action::beside),
       then(
           "one again", [&] { return !seen_.beside; }, Action::leave)});
  ASSERT_FALSE(again.rgb.empty());
  const auto between = [](const render::Image& a, const render::Image& b) {
    return differ(a, b, 460, 20, 1260, 480);  // right of the tips
  };
  EXPECT_GT(between(plain, turned), 2000);
  EXPECT_LT(between(plain, again), 200) << "as it was before it was turned";
  EXPECT_GT(differ(labelled, plain, 20, 300, 90, 480), 20) << "the frame of the button";
}

TEST_F(ReplayByMouse, NoButtonLiesOverAnother) {
  std::vector<BarPlace> places;
  BarPlace table;
  watch_by(end_,
           {{"both, measured", [&, wait = 0]() mutable { return seen_.measured && ++wait > 20; },
             [&] {
               places = seen_.buttons;
               table = seen_.table;
               press(SDLK_ESCAPE);
             }}},
           file_.string());
  ASSERT_EQ(desk_->renderer().width(), 1280);
  ASSERT_EQ(places.size(), replay_bar_actions().size() + 5);
  const auto overlap = [](const BarPlace& a, const BarPlace& b) {
    return a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h;
  };
  for (std::size_t n = 0; n < places.size(); ++n) {
    const BarPlace& one = places[n];
    EXPECT_GE(one.x, 0);
    EXPECT_GE(one.y, 0);
    EXPECT_LE(one.x + one.w, 1280);
    EXPECT_LE(one.y + one.h, 720);
    for (std::size_t m = 0; m < n; ++m)
      EXPECT_FALSE(overlap(one, places[m]))
          << static_cast<int>(one.action) << " " << static_cast<int>(places[m].action);
    EXPECT_FALSE(overlap(one, table)) << static_cast<int>(one.action);
  }
}

TEST_F(ReplayByMouse, TheTableOfTwoCoversNeitherPlaceOfWork) {
  BarPlace table;
  std::optional<ImVec2> work;
  float radius = 0;
  NoProgress quiet;
  auto recorded = open_recorded(file_.string(), {}, {}, quiet);
  ASSERT_TRUE(recorded && recorded->timeline.work);
  watch_by(end_,
           {{"both, measured", [&, wait = 0]() mutable { return seen_.measured && ++wait > 20; },
             [&] {
               table = seen_.table;
               press(SDLK_ESCAPE);
             }}},
           file_.string());
  work = on_picture(recorded->scene.camera, recorded->timeline.work->at, 640, 720);
  const auto edge =
      on_picture(recorded->scene.camera,
                 recorded->timeline.work->at + 8e-3 * recorded->scene.camera.right(), 640, 720);
  ASSERT_TRUE(work && edge);
  radius = std::hypot(edge->x - work->x, edge->y - work->y);
  for (const float x : {work->x, work->x + 640})
    EXPECT_TRUE(x + radius < table.x || x - radius > table.x + table.w)
        << x << " " << radius << " " << table.x;
}

// Whatever stands beside the picture after a jump is of the new moment, or is not shown.
TEST_F(ReplayByMouse, AfterAJumpNoValueIsThatOfTheMomentBefore) {
  bool jumped = false;
  int wrong = 0, silent = 0, looked = 0;
  const auto look = [&] {
    if (!jumped || std::abs(seen_.t - end_) > 1e-9) return;
    ++looked;
    if (seen_.known && std::abs(seen_.removed - removed_) > 1e-15) ++wrong;
    if (seen_.shown != seen_.t && !seen_.behind) ++silent;
  };
  watch_by(0.2,
           {{"the beginning", [&] { return seen_.known && !seen_.behind; },
             [&] {
               EXPECT_LT(seen_.removed, 0.9 * removed_);
               jumped = true;
               press(SDLK_END);
             }},
            {"the end", [&] { return seen_.shown == end_ && !seen_.behind && seen_.known; },
             [&] {
               EXPECT_DOUBLE_EQ(seen_.removed, removed_);
               press(SDLK_ESCAPE);
             }}},
           {}, look);
  EXPECT_GT(looked, 0);
  EXPECT_EQ(wrong, 0) << "a value of the moment before";
  EXPECT_EQ(silent, 0) << "another moment's picture without the three dots";
}

// On a slow computer a whole click, and the way on to elsewhere, may come within one picture.
TEST_F(ReplayByMouse, AClickCountsWhereItWasMadeAlsoWhileTheBoneIsComputed) {
  watch_by(2, {{"a picture", looks(5),
                [this] {
                  press(SDLK_RIGHT);
                  push(Action::film_until);
                  move_to(640, 300);
                }},
               {"the film ends there", [&] { return seen_.film_until == 3; },
                [] { press(SDLK_ESCAPE); }}});
}

TEST_F(ReplayByMouse, TheLineOfAFinishedFilmStaysUntilItIsClickedAway) {
  std::string while_writing;
  watch_by(0.5,
           {{"a picture", looks(5), [] { press(SDLK_o); }},
            {"the end of the film", [&] { return seen_.film_until == 0.5; }, [] { press(SDLK_e); }},
            {"the page", looks(5), [] { click(280 + 181, 144 + 126); }},    // pictures
            {"the choice", looks(5), [] { click(280 + 612, 144 + 310); }},  // write
            {"it writes", [&] { return fs::exists(folder_ / "film" / "frame_000001.png"); },
             [] { press(SDLK_e); }},
            {"the page", [&] { return seen_.exporting && seen_.line.rfind("Writing", 0) == 0; },
             [&] {
               while_writing = seen_.line;
               click(280 + 447, 144 + 310);  // closes the page, not the film
             }},
            {"no page", [&] { return !seen_.exporting; }, nullptr},
            {"the film is written", [&] { return told(Word::film_stopped) || seen_.note_stays; },
             [&] {
               EXPECT_NE(seen_.note.find(" pictures"), std::string::npos) << seen_.note;
               click(640, 520);
             }},
            {"the line is gone", [&] { return !seen_.note_stays; }, [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(while_writing.rfind("Writing film: ", 0), 0U) << while_writing;
  EXPECT_EQ(while_writing.back(), '%') << while_writing;
}

// ---- from the start page

TEST_F(ReplayByMouse, ARecordingThatWasPlayedIsAmongTheRecentOnesAKeptSessionIsNot) {
  const fs::path state = folder_ / "state",
                 kept = state / "sessions" / "session_20261127_120000.mcap";
  fs::create_directories(kept.parent_path());
  fs::copy_file(file_, kept);
  std::ofstream(fs::path(kept).replace_extension(".json"))
      << R"({"title": "Block", "when": "2026-11-27 12:00", "recipe": {"source": "phantom:block"},)"
         R"( "clean": true})";
  ASSERT_EQ(kept_sessions(state).size(), 1U);
  pages_by({{"the start page", on(Page::start), nullptr},
            {"a picture", looks(5), [] { click(1213, 354); }},  // the triangle beside the session
            {"it plays", on(Page::replay), nullptr},
            {"a while", looks(5), [] { press(SDLK_ESCAPE); }},
            {"the start page", on(Page::start),
             [&] {
               EXPECT_TRUE(recent(state).empty());
               drop(file_);
             }},
            {"it plays", on(Page::replay), nullptr},
            {"a while", looks(5), [] { press(SDLK_ESCAPE); }},
            {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  ASSERT_EQ(recent(state).size(), 1U);
  EXPECT_EQ(recent(state)[0].path, file_.string());
  EXPECT_EQ(recent(state)[0].title, word(Word::start_recording)) << "no name of a patient";
}

}  // namespace
}  // namespace burr::app
