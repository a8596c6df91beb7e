// What a user may rely on between two operations: nothing is left without a question, the keyboard
// belongs to the field that is typed into, and a session that is continued is as it was left.
//
//     BURR_LOOK=folder build/release/tests/test_window --gtest_filter='GoingOn.*'    leaves pictures
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "burr/record/player.h"
#include "burr/render/picture.h"
#include "burr/report/marked.h"
#include "burr/sim/replay.h"
#include "burr/workshop/recorded_bone.h"
#include "coarse_block.h"
#include "user.h"
#include "window/parts/autosave.h"
#include "window/parts/kept_sessions.h"

namespace burr::app {
namespace {

class GoingOn : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    ASSERT_NO_FATAL_FAILURE(write_coarse_block(folder_));
    if (desk_) desk_->ui().listen(&heard_);
  }
  // The user sees this line now.
  [[nodiscard]] bool sees(const std::string& line) const {
    return std::find(heard_.begin(), heard_.end(), line) != heard_.end();
  }
  void pages(std::vector<Script::Step> steps, record::Mode mode = record::Mode::free,
             bool given = false) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&] {
      script.look();
      heard_.clear();
    };
    PagesOptions options;
    options.sound = false;
    options.led.identity.mode = mode;
    options.mode_given = given;
    const Status done = run_pages(*desk_, options);
    desk_->after_frame = {};
    EXPECT_TRUE(done) << done.error().text;
    EXPECT_TRUE(script.finished());
  }
  void look(const char* name) const {
    if (const char* to = std::getenv("BURR_LOOK"))
      static_cast<void>(render::write_png(desk_->renderer().shown(),
                                          fs::path(to) / (std::string(name) + ".png")));
  }
  std::vector<Script::Step> cut() {
    return {{"the start page", on(Page::start), [this] { drop(folder_ / "block.toml"); }},
            {"milling", on(Page::milling), [] { move_to(640, 340); }},
            {"the burr over the bone", looks(10), [] { button(SDL_BUTTON_LEFT, true); }},
            {"bone to be cut", pressing_until(looks(40)), [] { button(SDL_BUTTON_LEFT, false); }}};
  }
  static void add(std::vector<Script::Step>& to, std::vector<Script::Step> more) {
    for (Script::Step& one : more) to.push_back(std::move(one));
  }
  [[nodiscard]] std::vector<KeptSession> kept() const { return kept_sessions(folder_ / "state"); }

  std::vector<std::string> heard_;
};

// Escape asks once; Escape stays, Enter leaves; Q asks and answers; the button can be reached by Tab.
TEST_F(GoingOn, NoKeyLeavesAnOperationWithoutAQuestion) {
  const std::string question = word(Word::leave_title);
  const auto asked = [&] { return sees(question); };
  const auto not_asked = [&] { return !sees(question) && desk_->page == Page::milling; };
  auto steps = cut();
  add(steps, {{"bone", looks(3), [] { press(SDLK_ESCAPE); }},
              {"the question", asked,
               [&] {
                 look("leave");
                 press(SDLK_ESCAPE);
               }},
              {"it stays", looks(5), nullptr},
              {"no question", not_asked, [] { press(SDLK_q); }},
              {"the question", asked, [] { press(SDLK_ESCAPE); }},
              {"no question", not_asked, [] { press(SDLK_ESCAPE); }},
              {"the question", asked, [] { press(SDLK_RETURN); }},
              {"the start page", on(Page::start), [&] { press(SDLK_ESCAPE); }}});
  pages(std::move(steps));
  ASSERT_EQ(kept().size(), 1U);
  // the sentence is true: the session can be continued
  EXPECT_GT(kept()[0].removed_mm3, 0);
}

// What stands in the question is what happens.
TEST_F(GoingOn, TheQuestionSaysWhatBecomesOfTheSession) {
  const auto leaves = [&](bool autosave, bool cuts, Word told) {
    desk_->settings.autosave = autosave;
    auto steps = cut();
    if (!cuts) steps.resize(2);
    add(steps, {{"a while", looks(5), [] { press(SDLK_ESCAPE); }},
                {"the sentence", [&] { return sees(word(told)); }, [] { press(SDLK_RETURN); }},
                {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
    pages(std::move(steps));
    const std::size_t there = kept().size();
    fs::remove_all(folder_ / "state");
    return there;
  };
  EXPECT_EQ(leaves(true, true, Word::leave_told_kept), 1U);
  EXPECT_EQ(leaves(true, false, Word::leave_told_nothing), 0U);
  EXPECT_EQ(leaves(false, true, Word::leave_told_lost), 0U);
}

// A field that was clicked into has the keyboard at once, in the same picture; a letter with Ctrl is no
// letter anywhere.
TEST_F(GoingOn, KeysGoToTheFieldAndPressNothingBehindIt) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const std::string lit = word(Word::steps_none);  // what A says without steps
  bool pressed = false;
  const auto watch = [&] {
    pressed = pressed || desk_->status_text.find(lit) != std::string::npos;
    return true;
  };
  float x = 0, y = 0;
  mill_by(*ready,
          {{"the first picture", looks(3), [] { press(SDLK_a, KMOD_LCTRL); }},
           {"nothing was pressed", looks(5), [&] { watch(), press(SDLK_e); }},
           {"the export page", looks(5),
            [&] {
              look("export");
              ASSERT_TRUE(desk_->ui().first_field(x, y));
              // a click and the keys within one picture
              click(static_cast<int>(x), static_cast<int>(y));
              press(SDLK_a, KMOD_LCTRL);
              press(SDLK_a);
              press(SDLK_F2);
            }},
           {"a picture", looks(1), [&] { watch(), press(SDLK_a, KMOD_LCTRL), press(SDLK_j); }},
           {"some pictures", looks(8), [&] { watch(), press(SDLK_ESCAPE); }},
           {"the field is left", looks(3), [] { press(SDLK_ESCAPE); }},
           {"the page is left", looks(5),
            [&] {
              watch();
              EXPECT_FALSE(pressed) << "a key went behind the field";
              press(SDLK_a);  // now it is a command
            }},
           {"told", [&] { return desk_->status_text.find(lit) != std::string::npos; },
            [] { leave_work(); }}});
}

TEST_F(GoingOn, TheModeIsRememberedAndTheCommandLineGoesFirst) {
  const auto mode_of_next = [&](record::Mode given, bool is_given) {
    std::optional<record::Mode> seen;
    auto steps = cut();
    add(steps, {{"bone", looks(3), [] { leave_work(); }},
                {"the start page", on(Page::start), [&] { press(SDLK_ESCAPE); }}});
    pages(std::move(steps), given, is_given);
    const auto all = kept();
    if (all.empty()) return record::Mode::free;
    const auto player = record::Player::open(all.front().file.string());
    const record::Mode mode = (*player)->info().identity->mode;
    fs::remove_all(folder_ / "state");
    return mode;
  };
  EXPECT_EQ(mode_of_next(record::Mode::free, false), record::Mode::free);
  desk_->settings.mode = "practise";
  desk_->settings_changed();
  const SettingsRead read = read_settings(folder_ / "config" / "settings.toml");
  EXPECT_EQ(read.settings.mode, "practise");
  EXPECT_EQ(mode_of_next(record::Mode::free, false), record::Mode::practise);
  EXPECT_EQ(mode_of_next(record::Mode::learn, true), record::Mode::learn);
}

// Mode, ticked steps, water, suction and tool are as they were left, and the marks are those of both
// parts together.
TEST_F(GoingOn, AContinuedOperationIsAsItWasLeftAndStaysOneSession) {
  auto steps = cut();
  add(steps, {{"bone", looks(3), [] { press(SDLK_j); }},  // the first step is done
              {"ticked", looks(5), [] { press(SDLK_i); }},
              {"water", looks(5), [] { press(SDLK_6); }},
              {"suction", looks(5), [] { press(SDLK_k); }},
              {"diamond", looks(20),
               [&] {
                 look("first_part");
                 leave_work();
               }},
              {"the start page", on(Page::start), nullptr},
              {"the list", looks(8),
               [&] {
                 look("list");
                 click(938, 354);
               }},
              {"milling again", on(Page::milling), [] { move_to(600, 330); }},
              {"the burr over the bone", looks(10),
               [&] {
                 look("second_part");
                 button(SDL_BUTTON_LEFT, true);
               }},
              {"more bone", pressing_until(looks(40)), [] { button(SDL_BUTTON_LEFT, false); }},
              {"a while", looks(5), [] { leave_work(); }},
              {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  pages(std::move(steps), record::Mode::practise, true);

  const auto all = kept();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(all[0].suction);
  EXPECT_TRUE(all[0].marks);
  EXPECT_TRUE(fs::exists(picture_of(all[0].file)));
  auto player = record::Player::open(all[0].file.string());
  ASSERT_TRUE(player) << player.error().text;
  ASSERT_EQ((*player)->continued().size(), 1U);
  const std::uint64_t joint = (*player)->continued()[0].first_tick;
  EXPECT_EQ((*player)->continued()[0].identity->mode, record::Mode::practise);
  std::map<std::string, int> begun;
  std::size_t before = 0;
  for (const record::CourseEvent& event : (*player)->course()) {
    if (event.kind == record::CourseKind::step_begun) ++begun[event.what];
    before += event.tick < joint && (event.kind == record::CourseKind::step_begun ||
                                     event.kind == record::CourseKind::step_done)
                  ? 1
                  : 0;
  }
  EXPECT_GE(before, 3U) << "begun, done, the next begun";
  for (const auto& [step, times] : begun) EXPECT_EQ(times, 1) << step << " began anew";
  auto row = (*player)->tick_at(static_cast<double>(joint) / (*player)->info().rate_hz);
  ASSERT_TRUE(row) << row.error().text;
  EXPECT_TRUE(row->tool.irrigated);
  EXPECT_EQ(row->tool.kind, tool::BurrKind::diamond);

  // one account, and marks on the whole of it
  NoProgress quiet;
  const auto last = (*player)->tick_at(1e9);
  ASSERT_TRUE(last);
  EXPECT_NEAR(1e9 * (last->ledger.removed - last->ledger.undone), all[0].removed_mm3, 1e-6);
  const auto marked = report::marked(all[0].file.string(), all[0].rubric, {}, quiet);
  ASSERT_TRUE(marked) << marked.error().text;
  auto bone = workshop::bone_of(**player, {}, quiet);
  ASSERT_TRUE(bone) << bone.error().text;
  const auto again = sim::replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->first_different_tick) << again->difference;
  EXPECT_EQ(again->ticks, (*player)->end_tick());
}

TEST_F(GoingOn, AnExamStaysAnExamAndIsNotContinuedOnceItIsHandedIn) {
  auto steps = cut();
  add(steps, {{"bone", looks(3), [] { leave_work(); }},
              {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  pages(std::move(steps), record::Mode::exam, true);
  ASSERT_EQ(kept().size(), 1U);
  NoProgress quiet;
  {
    auto ready = continue_session(kept()[0], quiet);
    ASSERT_TRUE(ready) << ready.error().text;
    EXPECT_EQ(ready->mode, record::Mode::exam);
    EXPECT_FALSE(ready->allowed.back) << "no undo in an exam";
    KeptSession before = kept()[0];
    Autosave autosave(folder_ / "state", *ready, before.options, {}, &before);
    ASSERT_NE(autosave.diary(), nullptr);
    ready->session->run(0.1, quiet);
    autosave.diary()->declare_done(90, true);
    ASSERT_TRUE(autosave.finish()) << autosave.trouble();
  }
  ASSERT_EQ(kept().size(), 1U);
  const auto refused = continue_session(kept()[0], quiet);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text, word(Word::exam_handed_in));
}

// Another rate of the device: the second part is a recording of its own, and the list says why.
TEST_F(GoingOn, WhatCannotGoOnInOneRecordingBecomesTwo) {
  auto steps = cut();
  add(steps, {{"bone", looks(3), [] { leave_work(); }},
              {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  pages(std::move(steps));
  ASSERT_EQ(kept().size(), 1U);
  const std::string first = kept()[0].file.string();
  NoProgress quiet;
  KeptSession before = kept()[0];
  auto ready = continue_session(before, quiet);
  ASSERT_TRUE(ready) << ready.error().text;
  auto other = std::make_shared<record::EarlierPart>(*ready->left.part);
  other->info.rate_hz = 500;
  ready->left.part = other;
  Autosave autosave(folder_ / "state", *ready, before.options, {}, &before);
  EXPECT_EQ(autosave.trouble(), "");
  EXPECT_NE(autosave.apart().find("it had 500 ticks a second"), std::string::npos)
      << autosave.apart();
  EXPECT_TRUE(autosave.is_part());
  EXPECT_NE(autosave.file().string(), first);
  ready->session->run(0.1, quiet);
  EXPECT_TRUE(autosave.keep());
  ASSERT_TRUE(autosave.finish());
  ASSERT_EQ(kept().size(), 2U);
  auto player = record::Player::open(autosave.file().string());
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_TRUE((*player)->info().embedded);
}

TEST_F(GoingOn, ASessionGetsANameThatStaysOutOfItsRecording) {
  auto steps = cut();
  const std::string name = "Second try";
  add(steps, {{"bone", looks(3), [] { leave_work(); }},
              {"the start page", on(Page::start), nullptr},
              {"the list", looks(8), [] { click(1091, 359); }},  // the pencil
              {"the field", looks(5), [] { press(SDLK_a, KMOD_LCTRL); }},
              {"all of it is selected", looks(3), [&] { type(name); }},  // Ctrl is up again
              {"the letters", looks(5),
               [&] {
                 look("naming");
                 press(SDLK_RETURN);
               }},
              {"the name", [&] { return sees(name); },
               [&] {
                 look("named");
                 press(SDLK_ESCAPE);
               }}});
  pages(std::move(steps), record::Mode::practise, true);
  auto all = kept();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, name);
  EXPECT_EQ(shown_title(all[0]), name);
  std::ifstream in(all[0].file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  EXPECT_EQ(bytes.find(name), std::string::npos);
  // it goes on with the session, and may be taken away again
  NoProgress quiet;
  {
    auto ready = continue_session(all[0], quiet);
    ASSERT_TRUE(ready) << ready.error().text;
    Autosave autosave(folder_ / "state", *ready, all[0].options, {}, &all[0]);
    ready->session->run(0.05, quiet);
    ASSERT_TRUE(autosave.finish());
  }
  all = kept();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, name);
  ASSERT_TRUE(name_session(all[0], ""));
  EXPECT_EQ(kept()[0].name, "");
}

// Every line that the pages draw in English is drawn otherwise in Swedish and German, but for names,
// figures and what all three write alike.
TEST_F(GoingOn, NoWordIsDrawnThatIsTheSameInAllLanguages) {
  const auto session = [&] {
    auto steps = cut();
    add(steps, {{"bone", looks(3), [] { leave_work(); }},
                {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
    pages(std::move(steps), record::Mode::practise, true);
  };
  session();  // so that there is something in the lists
  std::map<std::string, std::set<std::string>> drawn;
  for (const std::string code : {"en", "sv", "de"}) {
    desk_->settings.language = code;
    desk_->settings_changed();
    std::set<std::string>& lines = drawn[code];
    const auto take = [&] {
      lines.insert(heard_.begin(), heard_.end());
      return true;
    };
    pages({{"the start page", on(Page::start), nullptr},
           {"its lines", looks(6), [&] { take(), press(SDLK_F1); }},
           {"the help", looks(4), [&] { take(), press(SDLK_F1); }},
           {"the start page", looks(3), [] { press(SDLK_F2); }},
           {"the settings", looks(4), [&] { take(), press(SDLK_F2); }},
           {"the start page", looks(3), [this] { drop(folder_ / "block.toml"); }},
           {"loading", [&] { return on(Page::loading)() && take(); }, nullptr},
           {"milling", on(Page::milling), nullptr},
           {"its lines", looks(12), [&] { take(), press(SDLK_F10); }},
           {"the menu", looks(4), [&] { take(), press(SDLK_F10); }},
           {"no menu", looks(3), [] { press(SDLK_F4); }},
           {"structures", looks(4), [&] { take(), press(SDLK_ESCAPE); }},
           {"the question", [&] { return sees(word(Word::leave_title)) && take(); },
            [] { press(SDLK_RETURN); }},
           {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}},
          record::Mode::practise, true);
  }
  const std::set<std::string> names = {"burr", "Original", "Hand", "axial", "sagittal", "Film",
                                       "Pedal", "mm", "rpm", "Headset (OpenXR)", "Stereo  [F3]",
                                       // keys are named as they are in the table of keys
                                       "Tab", "Esc", "N", "Esc  Q", "Space", "Backspace",
                                       "Ctrl + 8", "Ctrl + M", "Ctrl + Return", "Ctrl + X",
                                       "Shift + 8", "Shift + X"};
  std::string same;
  for (const std::string& line : drawn["en"]) {
    // a word: three letters in a row
    int letters = 0, most = 0;
    for (const char c : line) {
      letters = std::isalpha(static_cast<unsigned char>(c)) != 0 ? letters + 1 : 0;
      most = std::max(most, letters);
    }
    if (most >= 3 && !names.contains(line) && drawn["sv"].contains(line) &&
        drawn["de"].contains(line))
      same += "\n  \"" + line + "\"";
  }
  EXPECT_EQ(same, "");
  EXPECT_GT(drawn["en"].size(), 60U) << "the pages were not heard";
}

}  // namespace
}  // namespace burr::app
