// A person marks products at the window: blinded, with keys and mouse, into the store by the same function as elsewhere.
#include "window/rate/rate_page.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "burr/render/picture.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "burr/school/store.h"
#include "school/products.h"
#include "support/made_once.h"
#include "support/test_places.h"
#include "user.h"

namespace burr::app {
namespace {

constexpr const char* kRater = "A. Berg";

class RateWindow : public Window {
 protected:
  // Two products of one learner: blocks that scripted surgeons milled, as `burr` itself enters them.
  static bool make_products(const fs::path& folder) {
    const std::string store = " --store '" + (folder / "school.sqlite").string() + "'";
    bool fine = command("learner add --id kestrel-27 --level PGY2 --name 'Nora Nyberg'" + store);
    for (const std::string& n : std::vector<std::string>{"1", "2"}) {
      const std::string file = "'" + (folder / ("kestrel-27 " + n + ".mcap")).string() + "'";
      fine = fine &&
             command("surgeon block --level average --seed " + n +
                     " --learner kestrel-27 --attempt " + n + " --record " + file) &&
             command("learner enter kestrel-27 " + file + store);
    }
    return fine;
  }
  void SetUp() override {
    Window::SetUp();
    if (!desk_) return;
    const fs::path products = test::made_once("rate_products", make_products);
    ASSERT_FALSE(products.empty());
    const fs::path store = folder_ / "school.sqlite";
    fs::copy_file(products / "school.sqlite", store);
    desk_->store = store.string();
    const auto place = school::place_of(desk_->store, desk_->places());
    ASSERT_TRUE(place) << place.error().text;
    auto opened = school::Store::open(*place);
    ASSERT_TRUE(opened) << opened.error().text;
    store_ = std::move(*opened);
    ASSERT_EQ(sessions().size(), 2U) << "the test shows nothing";
  }
  static bool command(const std::string& words) {
    const std::string line = "'" + test::build_dir() + "/burr' --quiet " + words + " 2>&1";
    std::string said;
    FILE* out = ::popen(line.c_str(), "r");
    if (out == nullptr) return false;
    std::array<char, 4096> some{};
    while (std::fgets(some.data(), some.size(), out) != nullptr) said += some.data();
    const int code = ::pclose(out);
    EXPECT_EQ(code, 0) << words << ": " << said;
    return code == 0;
  }
  [[nodiscard]] std::vector<school::SessionRow> sessions() {
    const auto rows = school::sessions_of(*store_, "");
    return rows ? *rows : std::vector<school::SessionRow>();
  }
  [[nodiscard]] std::vector<school::RaterMarkRow> marks() {
    const auto rows = school::rater_marks(*store_);
    return rows ? *rows : std::vector<school::RaterMarkRow>();
  }
  void rate_by(RateState& state, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&] {
      look_for_names();
      script.look();
    };
    const auto left = rate(*desk_, state, {});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  // Nothing that tells whose it is may be said, in the page or on the window's frame.
  void look_for_names() {
    SDL_Window* window = SDL_GL_GetCurrentWindow();
    const std::string told =
        desk_->status_text + (window != nullptr ? SDL_GetWindowTitle(window) : "");
    std::vector<std::string> secrets = {"kestrel", "Nora", "PGY", ".mcap"};
    for (const school::SessionRow& one : sessions()) secrets.push_back(one.id);
    for (const std::string& one : secrets)
      EXPECT_EQ(told.find(one), std::string::npos) << one << " in: " << told;
  }
  [[nodiscard]] bool told(Word which) const {
    return desk_->status_text.find(word(which)) != std::string::npos;
  }
  // For people: BURR_TEST_PICTURES names a folder.
  void look(const std::string& name) {
    const char* folder = std::getenv("BURR_TEST_PICTURES");
    if (folder == nullptr) return;
    EXPECT_TRUE(
        render::write_png(desk_->renderer().shown(), fs::path(folder) / ("rate_" + name + ".png")));
  }
  // The bone is there: much of its part of the window is light.
  [[nodiscard]] std::function<bool()> bone_shown() {
    return [this] {
      const render::Image image = desk_->renderer().shown();
      int light = 0;
      for (int y = 150; y < 450; y += 5)
        for (int x = 200; x < 600; x += 5)
          light +=
              image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(x))] > 150
                  ? 1
                  : 0;
      return light > 1000;  // of 4800
    };
  }

  std::unique_ptr<school::Store> store_;
};

TEST_F(RateWindow, ARaterSeesTheProductAndMarksItByKeys) {
  const auto queue = products_here(*store_, kRater, "", 7);
  ASSERT_TRUE(queue);
  ASSERT_EQ(queue->here.size(), 2U);
  const auto items = product_items(*store_, queue->here[0].session, queue->here[0].rubric_hash);
  ASSERT_TRUE(items && items->size() >= 2);
  const std::size_t count = items->size();
  RateState state;
  state.seed = 7;
  std::vector<render::Image> seen;
  const auto see = [&] { seen.push_back(desk_->renderer().shown()); };
  std::vector<Script::Step> steps = {
      {"who marks", looks(5),
       [&] {
         look("who");
         type(kRater);
       }},
      {"the name", looks(5), [] { press(SDLK_RETURN); }},
      {"the bone", bone_shown(), nullptr},
      {"a picture", looks(5),
       [&] {
         see();
         look("bone");
         press(SDLK_3);
       }},
      {"from the left", looks(5),
       [&] {
         see();
         press(SDLK_5);
       }},
      {"a section", looks(5),
       [&] {
         see();
         look("section");
         press(SDLK_1);
       }},
      {"straight on again", looks(5),
       [&] {
         see();
         press(SDLK_RETURN, KMOD_LCTRL);  // nothing is marked yet
       }},
      {"a sentence", [this] { return desk_->status_text.find("no mark yet") != std::string::npos; },
       nullptr}};
  // the first item cannot be judged, and why; the others are met
  steps.push_back({"a picture", looks(3), [] {
                     for (int n = 0; n < 3; ++n) press(SDLK_RIGHT);
                     press(SDLK_r);
                   }});
  steps.push_back({"the field", looks(4), [] { type("dark"); }});
  steps.push_back({"what was typed", looks(4), [] { press(SDLK_RETURN); }});
  for (std::size_t n = 1; n < count; ++n)
    steps.push_back({"an item", looks(4), [] {
                       press(SDLK_DOWN);
                       press(SDLK_RIGHT);
                     }});
  steps.push_back({"all marked", looks(4), [&] {
                     look("marked");
                     EXPECT_TRUE(marks().empty());
                     press(SDLK_RETURN, KMOD_LCTRL);
                   }});
  steps.push_back({"kept", [this] { return told(Word::rate_kept); }, nullptr});
  steps.push_back({"the next bone", bone_shown(), [] { press(SDLK_ESCAPE); }});
  rate_by(state, std::move(steps));
  // a key turns the bone, a section is another picture, and the first view is the first again
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_GT(differ(seen[0], seen[1], 0, 0, 780, 580), 3000);
  EXPECT_GT(differ(seen[1], seen[2], 0, 0, 780, 580), 3000);
  EXPECT_LT(differ(seen[0], seen[3], 0, 0, 780, 580), 300);
  const auto kept = marks();
  ASSERT_EQ(kept.size(), count);
  for (const school::RaterMarkRow& one : kept) {
    EXPECT_EQ(one.session, queue->here[0].session) << "not the order of this seed";
    EXPECT_EQ(one.rater, kRater);
    EXPECT_TRUE(one.blinded);
    const bool first = one.item == (*items)[0].id;
    EXPECT_EQ(one.mark, first ? "not assessable" : "met") << one.item;
    EXPECT_EQ(one.reason, first ? "dark" : "");
  }
}

// Also what is not kept yet is there again; what was put off comes later.
TEST_F(RateWindow, WhoLeavesAndComesBackGoesOn) {
  RateState state;
  state.seed = 7;
  state.rater = kRater;
  rate_by(state, {{"the bone", bone_shown(), [] { press(SDLK_RIGHT); }},
                  {"a mark", looks(4), [] { press(SDLK_ESCAPE); }}});
  const std::string first = state.session;
  ASSERT_FALSE(first.empty());
  std::size_t given = 0;
  for (const auto& [item, mark] : state.marks) given += mark.mark == "met" ? 1 : 0;
  EXPECT_EQ(given, 1U);
  EXPECT_TRUE(marks().empty());
  rate_by(state, {{"the bone", bone_shown(), [] { press(SDLK_ESCAPE); }}});
  EXPECT_EQ(state.session, first);
  given = 0;
  for (const auto& [item, mark] : state.marks) given += mark.mark == "met" ? 1 : 0;
  EXPECT_EQ(given, 1U) << "the mark was lost";
  // "Not now", beside "Keep and go on"
  rate_by(state, {{"the bone", bone_shown(), nullptr},
                  {"put off",
                   asking_until([&] { return state.session != first; },
                                [x = 1020]() mutable { click(x = x < 1110 ? x + 15 : 1020, 668); }),
                   [] { press(SDLK_ESCAPE); }}});
  EXPECT_TRUE(state.later.contains(first));
  EXPECT_NE(state.session, first);
}

// By mouse: marks, and turning; from the start page and back to it.
TEST_F(RateWindow, TheStartPageLeadsThereAndTheMouseDoesTheSame) {
  render::Image before;
  pages_by({{"the start page", on(Page::start), nullptr},
            {"the page of raters",
             asking_until(on(Page::rate),
                          [x = 390]() mutable { click(x = x < 600 ? x + 20 : 390, 675); }),
             nullptr},
            {"who marks", looks(5), [] { type(kRater); }},
            {"the name", looks(5), [] { press(SDLK_RETURN); }},
            {"the bone", bone_shown(), nullptr},
            {"a picture", looks(5),
             [&] {
               before = desk_->renderer().shown();
               move_to(300, 300);
               SDL_Event event = {};
               event.type = SDL_MOUSEMOTION;
               event.motion.x = 380;
               event.motion.y = 300;
               event.motion.xrel = 80;
               event.motion.state = SDL_BUTTON_LMASK;
               SDL_PushEvent(&event);
             }},
            {"turned", looks(5),
             [&] {
               EXPECT_GT(differ(before, desk_->renderer().shown(), 0, 0, 780, 580), 3000);
               before = desk_->renderer().shown();
               turn_wheel(3);
             }},
            {"nearer", looks(5),
             [&] {
               EXPECT_GT(differ(before, desk_->renderer().shown(), 0, 0, 780, 580), 3000);
               press(SDLK_ESCAPE);
             }},
            {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
}

// A recording that is another one now is not shown, and its name is not said.
TEST_F(RateWindow, AChangedRecordingIsNotShown) {
  for (const school::SessionRow& one : sessions())
    ASSERT_TRUE(store_->database().run("UPDATE session SET recording_hash = $1 WHERE id = $2",
                                       {std::string(40, 'a'), one.id}));
  RateState state;
  state.rater = kRater;
  rate_by(state, {{"a sentence",
                   [this] { return desk_->status_text.find("was changed") != std::string::npos; },
                   [] { press(SDLK_RETURN, KMOD_LCTRL); }},
                  {"nothing was kept", looks(5), [&] {
                     look("changed");
                     EXPECT_TRUE(marks().empty());
                     press(SDLK_ESCAPE);
                   }}});
}

TEST_F(RateWindow, SaysThatNothingIsLeftAndWhoMayNotMark) {
  const auto queue = products_here(*store_, kRater, "", 1);
  ASSERT_TRUE(queue);
  for (const school::Product& one : queue->here) {
    const auto items = product_items(*store_, one.session, one.rubric_hash);
    ASSERT_TRUE(items);
    school::Marking marking{one.session, kRater, true, {}};
    for (const ProductItem& item : *items) marking.marks.push_back({item.id, "met", ""});
    ASSERT_TRUE(school::mark(*store_, marking));
  }
  RateState state;
  rate_by(state,
          {{"who marks", looks(5), [] { type("machine"); }},
           {"the name", looks(5), [] { press(SDLK_RETURN); }},
           {"refused",
            [this] { return desk_->status_text.find("must be a person") != std::string::npos; },
            [] { press(SDLK_ESCAPE); }}});
  state.rater = kRater;
  rate_by(state, {{"nothing left", [this] { return told(Word::rate_nothing); },
                   [&] {
                     look("nothing");
                     press(SDLK_ESCAPE);
                   }}});
  // a learner never gets the own products
  state = {};
  state.rater = "kestrel-27";
  rate_by(state, {{"nothing left", [this] { return told(Word::rate_nothing); },
                   [] { press(SDLK_ESCAPE); }}});
}

TEST_F(RateWindow, SpeaksThreeLanguages) {
  for (const char* code : {"sv", "de"}) {
    speak(code);
    RateState state;
    state.rater = kRater;
    state.seed = 7;
    rate_by(state, {{"the bone", bone_shown(), nullptr},
                    {"a picture", looks(5), [&] {
                       look(std::string("bone_") + code);
                       EXPECT_EQ(desk_->status_text.find("A product"), std::string::npos);
                       EXPECT_NE(desk_->status_text.find(code == std::string("sv") ? "Ett arbete"
                                                                                   : "Eine Arbeit"),
                                 std::string::npos)
                           << desk_->status_text;
                       press(SDLK_ESCAPE);
                     }}});
  }
}

}  // namespace
}  // namespace burr::app
