// The case on the page for milling, and its two texts: no window is needed.
#include "window/mill/mill_case.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/recorder.h"
#include "shared/word_names.h"
#include "support/folder.h"

namespace burr::app {
namespace {

constexpr double kRate = 4000;  // [Hz]

class MillCases : public testing::Test {
 protected:
  MillCases()
      : bone_(phantom::bone_from_distance(phantom::cube_grid(24e-3, 24), {}, phantom::ball(10e-3),
                                          8)),
        recorder_(kRate),
        diary_(recorder_, kRate) {
    options_.lesson.emplace();
    for (const char* id : {"open", "look"}) options_.lesson->steps.emplace_back().id = id;
    options_.diary = &diary_;
    record::SessionInfo info;
    info.rate_hz = kRate;
    info.volume.grid = bone_->grid();
    const Status started = recorder_.start(folder_ / "s.mcap", info);
    EXPECT_TRUE(started) << started.error().text;
  }
  MillCase made(record::Mode mode) {
    options_.mode = mode;
    options_.allowed = workshop::allowed_in(mode, {}, true);
    return {*bone_, kRate, scene_, options_, row_, notes_};
  }
  // What the user reads; before, as if nothing had been said.
  std::string read() {
    std::string text = notes_.renew({});
    notes_.keep("");
    return text;
  }

  test::Folder folder_;
  std::unique_ptr<volume::Bone> bone_;
  record::Recorder recorder_;
  record::Diary diary_;
  render::Scene scene_;
  WindowOptions options_;
  tick::TickRow row_;
  MillNotes notes_;
};

// View and tool follow the steps where the mode shows them, or once the user uses them; in an exam never.
TEST_F(MillCases, FollowsTheStepsWhereTheyAreShownOrUsed) {
  using record::Mode;
  for (const Mode mode : {Mode::free, Mode::learn, Mode::practise, Mode::exam}) {
    MillCase work = made(mode);
    work.look_at_steps(false);
    EXPECT_EQ(work.follows(), mode == Mode::learn) << record::word_of(mode);
    const int turns = work.turns();
    work.step_done();
    EXPECT_EQ(work.follows(), mode != Mode::exam) << record::word_of(mode);
    EXPECT_EQ(work.turns() > turns, mode != Mode::exam) << "another step, another target";
    MillCase lit = made(mode);
    lit.look_at_steps(false);
    const int before = lit.turns();
    lit.light_target();
    EXPECT_EQ(lit.follows(), mode != Mode::exam) << record::word_of(mode);
    EXPECT_EQ(lit.turns() > before, mode != Mode::exam) << "its target is looked for anew";
  }
}

TEST_F(MillCases, AnExamRefusesWhatTakesWorkBackAndFreeWorkNothing) {
  const std::vector<Action> back = {Action::back, Action::smooth, Action::undo,
                                    Action::redo, Action::reset,  Action::mirror};
  MillCase exam = made(record::Mode::exam);
  for (const Action action : back) EXPECT_FALSE(exam.allows(action)) << static_cast<int>(action);
  EXPECT_FALSE(exam.allows(Action::see_through));
  for (const Action action : {Action::cut, Action::add, Action::touch, Action::smaller,
                              Action::rack, Action::keep, Action::leave})
    EXPECT_TRUE(exam.allows(action)) << static_cast<int>(action);
  exam.say_refused();
  EXPECT_EQ(read(), word(Word::refused_exam));

  MillCase free = made(record::Mode::free);
  for (const Action action : back) EXPECT_TRUE(free.allows(action)) << static_cast<int>(action);
  EXPECT_TRUE(free.allows(Action::see_through));
  free.say_refused();
  EXPECT_EQ(read(), word(Word::refused_case));
}

TEST_F(MillCases, AnExamHasNoStepsAndRemindsNobodyOfThem) {
  MillCase exam = made(record::Mode::exam);
  EXPECT_FALSE(exam.steps_offered());
  exam.look_at_steps(false);
  EXPECT_EQ(exam.step(), nullptr) << "no step begins";
  EXPECT_EQ(exam.open_steps(), 0U);
  exam.step_done();
  EXPECT_EQ(read(), word(Word::refused_exam));
}

TEST_F(MillCases, StepsBeginWithTheFirstTickAndAreDoneOneAfterAnother) {
  MillCase learning = made(record::Mode::learn);
  EXPECT_EQ(learning.step(), nullptr) << "before the first tick";
  learning.look_at_steps(false);
  ASSERT_NE(learning.step(), nullptr);
  EXPECT_EQ(learning.step()->id, "open");
  EXPECT_EQ(learning.open_steps(), 2U);
  learning.step_done();
  learning.look_at_steps(false);  // does not begin them again
  EXPECT_EQ(learning.step()->id, "look");
  EXPECT_EQ(learning.open_steps(), 1U);
  learning.step_done();
  EXPECT_EQ(read(), word(Word::steps_all_done));
  EXPECT_EQ(learning.open_steps(), 0U);
}

TEST_F(MillCases, DoneThatEndsTheSessionIsAskedOnce) {
  using Done = MillCase::Done;
  options_.done_ends = true;
  MillCase work = made(record::Mode::practise);
  EXPECT_EQ(work.declare_done(false), Done::answered);
  EXPECT_EQ(read(), word(Word::done_nothing)) << "there is nothing to mark";
  row_.ledger.removed = 1e-9;
  EXPECT_EQ(work.declare_done(false), Done::asks);
  EXPECT_EQ(read(), "");
  EXPECT_FALSE(diary_.declared_done()) << "nobody has answered yet";
  EXPECT_EQ(work.declare_done(true), Done::ends) << "the second time is the answer";
  work.mark_done();
  EXPECT_TRUE(diary_.declared_done());
}

TEST_F(MillCases, DoneThatEndsNothingIsDeclaredAndTakenBack) {
  MillCase work = made(record::Mode::free);
  EXPECT_EQ(work.declare_done(false), MillCase::Done::answered);
  EXPECT_TRUE(diary_.declared_done());
  EXPECT_EQ(read(), word(Word::done_declared));
  EXPECT_EQ(work.declare_done(false), MillCase::Done::answered);
  EXPECT_FALSE(diary_.declared_done());
  EXPECT_EQ(read(), word(Word::done_taken_back));
  options_.diary = nullptr;
  EXPECT_EQ(work.declare_done(false), MillCase::Done::answered);
  EXPECT_EQ(read(), word(Word::done_not_recorded));
}

TEST_F(MillCases, AnInjuryLiftsTheHandOnceWhereTheModeStopsAtIt) {
  const MillCase::Nearest in = HudState::Nearest{"dura", -3e-3};
  row_.spindle_rad_s = 1000;
  const double full_speed = 4000;
  for (const auto& [mode, stops] :
       {std::pair(record::Mode::learn, true), {record::Mode::exam, false}}) {
    MillCase work = made(mode);
    EXPECT_EQ(options_.allowed.injury == workshop::Injury::stop, stops);
    EXPECT_FALSE(work.look_at_injury({}, full_speed));
    EXPECT_EQ(work.look_at_injury(in, full_speed), stops);
    EXPECT_FALSE(work.look_at_injury(in, full_speed)) << "it is the same injury";
    row_.spindle_rad_s = 0.01 * full_speed;
    EXPECT_FALSE(work.look_at_injury({}, full_speed));
    EXPECT_FALSE(work.look_at_injury(in, full_speed)) << "the burr hardly turns";
    row_.spindle_rad_s = 1000;
  }
}

// ---- the two texts

TEST(MillNotes, WhatStandsIsSaidInItsOrder) {
  MillNotes notes;
  EXPECT_EQ(notes.renew({.hint = "hold the button"}), "hold the button");
  EXPECT_EQ(notes.renew({.measured = "3 mm", .hint = "hold the button"}), "3 mm");
  EXPECT_EQ(notes.text(), "") << "the strip has the value from the picture";
  EXPECT_EQ(notes.renew({.progress = "half", .measured = "3 mm"}), "half");
  notes.note("undone");
  notes.note("");
  EXPECT_EQ(notes.renew({.warning = "disk full", .progress = "half"}), "disk full; undone");
  EXPECT_EQ(notes.renew({.warning = "disk full", .trouble = "no file"}), "no file");
  notes.warn_released("let go");
  EXPECT_EQ(notes.renew({.released = true}),
            "let go. " + std::string(word(Word::begins_free)) + "; undone");
}

TEST(MillNotes, ANoteThatIsKeptGoesWithAClickAndThenTheTextsAreDueAtOnce) {
  MillNotes notes;
  EXPECT_TRUE(notes.due());
  EXPECT_FALSE(notes.due()) << "five times a second";
  notes.keep("written: a.mp4");
  EXPECT_EQ(notes.renew({}), "written: a.mp4");
  EXPECT_TRUE(notes.stays());
  notes.click_away();
  EXPECT_TRUE(notes.due());
  EXPECT_EQ(notes.renew({}), "");
  EXPECT_FALSE(notes.stays());
}

}  // namespace
}  // namespace burr::app
