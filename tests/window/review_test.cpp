// The end of a case at the window: the learner's own marks, then those of the machine; what an exam does
// not show; a session that was killed.
#include "window/review/review.h"

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "burr/record/player.h"
#include "burr/report/marked.h"
#include "burr/report/questions.h"
#include "burr/school/pending.h"
#include "burr/school/sessions.h"
#include "burr/school/store.h"
#include "coarse_block.h"
#include "support/test_places.h"
#include "user.h"
#include "window/mill/mill_keys.h"
#include "window/parts/kept_sessions.h"
#include "window/review/enter_session.h"
#include "window/review/review_page.h"
#include "window/review/self_marks_page.h"
#include "window/start/start_page.h"

namespace burr::app {
namespace {

constexpr const char* kState = "BURR_TEST_KILLED_STATE";  // of the child that is killed

class ReviewWindow : public Window {
 protected:
  void SetUp() override {
    if (const char* state = std::getenv(kState)) folder_ = state;
    Window::SetUp();
    ASSERT_NO_FATAL_FAILURE(write_coarse_block(folder_));
  }
  // The pages of burr, with the practice block chosen in this mode; the script plays the user.
  void work_by(record::Mode mode, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    PagesOptions options;
    options.sound = false;
    options.led.identity.mode = mode;
    options.mode_given = true;
    options.led.identity.learner = learner_;
    const Status done = run_pages(*desk_, options);
    desk_->after_frame = {};
    EXPECT_TRUE(done) << done.error().text;
    EXPECT_TRUE(script.finished());
  }
  // Opens the block and cuts into it.
  std::vector<Script::Step> cut() {
    return {{"the start page", on(Page::start), [this] { drop(folder_ / "block.toml"); }},
            {"milling", on(Page::milling), [] { move_to(640, 340); }},
            {"the burr over the bone", looks(10), [] { button(SDL_BUTTON_LEFT, true); }},
            {"bone to be cut", pressing_until(looks(40)), [] { button(SDL_BUTTON_LEFT, false); }}};
  }
  // Declares the work done, and answers the question.
  static std::vector<Script::Step> done() {
    return {{"a picture", looks(5), [] { press(SDLK_RETURN, KMOD_LCTRL); }},
            {"the question", looks(5), [] { press(SDLK_RETURN); }}};
  }
  [[nodiscard]] bool told(const std::string& text) const {
    return desk_->status_text.find(text) != std::string::npos;
  }
  static void add(std::vector<Script::Step>& steps, std::vector<Script::Step> more) {
    for (Script::Step& one : more) steps.push_back(std::move(one));
  }
  [[nodiscard]] std::vector<KeptSession> kept() const { return kept_sessions(folder_ / "state"); }
  std::string learner_;
};

// By the rubric that the case names, which lies beside it.
TEST_F(ReviewWindow, TheLearnerMarksHimselfThenSeesTheMarksAndTheEvidence) {
  {
    std::ifstream in(folder_ / "block.toml");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    in.close();
    std::ofstream(folder_ / "block.toml") << "rubric = \"mine.toml\"\n" << text;
    std::ofstream(folder_ / "mine.toml") << R"([rubric]
name = "mine"
version = 1
case = "block.toml"
[[item]]
id = "groove.mine"
part = "product"
measure = "removed"
region = "groove"
share = 0.9
source = "this test"
say = "Clear the groove."
)";
  }
  auto steps = cut();
  add(steps, done());
  int y = 100;
  add(steps,
      {{"own marks", on(Page::self_marks), nullptr},
       {"a picture", looks(5), [] { click(100, 162); }},  // the first item: met
       {"a picture", looks(5), [] { click(110, 683); }},  // show what burr found
       {"the marks", [&] { return desk_->page == Page::review && told("items met"); }, nullptr},
       {"evidence that plays",
        asking_until(on(Page::replay), [&y] { click(1180, y = y < 620 ? y + 14 : 100); }), nullptr},
       {"a while", looks(20), [] { press(SDLK_ESCAPE); }},
       {"the marks again", on(Page::review), nullptr},
       {"a picture", looks(5), [] { press(SDLK_ESCAPE); }},
       {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  work_by(record::Mode::learn, std::move(steps));
  ASSERT_EQ(kept().size(), 1U) << "nothing was cut: the test shows nothing";
  EXPECT_TRUE(kept()[0].marks);
  const auto player = record::Player::open(kept()[0].file.string());
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_EQ((*player)->ending(), record::Ending::declared_done);
  std::vector<std::string> own;
  for (const record::CourseEvent& event : (*player)->course())
    if (event.kind == record::CourseKind::self_mark) own.push_back(event.what + " " + event.value);
  EXPECT_EQ(own, std::vector<std::string>{"groove.mine met"});

  // the bar that shows how far burr is only grows, and is not full before the end
  struct Shares final : Progress {
    std::vector<double> all;
    void report(double fraction, std::string_view /*stage*/) override { all.push_back(fraction); }
    [[nodiscard]] bool cancelled() const override { return false; }
  } shares;
  const auto again = report::marked(kept()[0].file.string(), kept()[0].rubric, {}, shares);
  ASSERT_TRUE(again) << again.error().text;
  ASSERT_GT(shares.all.size(), 2U);
  EXPECT_TRUE(std::is_sorted(shares.all.begin(), shares.all.end()));
  EXPECT_LT(shares.all[shares.all.size() / 4], 0.7);
  EXPECT_LT(shares.all.back(), 1);
}

// The pieces of bone that were moved stand at the left, above the advice.
TEST_F(ReviewWindow, ShowsThePiecesThatWereMoved) {
  report::Report report;
  report.nothing_next = "nothing";
  const auto written = [&] {  // light pixels of the left column
    ReviewState state;
    state.report = &report;
    const render::Scene empty;
    for (int n = 0; n < 3; ++n)
      EXPECT_TRUE(desk_->show(
          empty, [&] { static_cast<void>(draw_review(desk_->ui(), state)); }, true));
    const render::Image image = desk_->renderer().shown();
    long light = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width / 3; ++x)
        light +=
            image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x))] > 120
                ? 1
                : 0;
    return light;
  };
  const long without = written();
  report.pieces = {{"piece 1", "412 mm3, moved 5.0 mm and turned 2.0 degrees; gap 0.7 mm"}};
  const long one = written();
  EXPECT_GT(one, without + 500);
  report.pieces.emplace_back("piece 2", "81 mm3, moved 1.0 mm");
  EXPECT_GT(written(), one + 50);
}

// Enter goes on from the own marks. A full report whose page is closed early is still written, and the
// start page says where.
TEST_F(ReviewWindow, EnterGoesOnAndAReportThatIsNotWaitedForIsWritten) {
  const char* set = std::getenv("PATH");
  const std::string path = set != nullptr ? set : "";
  ::setenv("PATH", "/nowhere", 1);  // no browser
  auto steps = cut();
  add(steps, done());
  std::string goes_on, written;
  add(steps,
      {{"own marks", on(Page::self_marks), nullptr},
       {"a picture", looks(5), [] { press(SDLK_RETURN); }},
       {"the marks", [&] { return desk_->page == Page::review && told("items met"); },
        [] { click(125, 683); }},
       {"it writes", [&] { return told(word(Word::review_writes)); }, [] { press(SDLK_ESCAPE); }},
       {"the start page", on(Page::start), [&] { goes_on = desk_->news; }},
       {"written", [&] { return desk_->news != goes_on; },
        [&] {
          written = desk_->news;
          click(400, 638);
        }},
       {"the line is clicked away", [&] { return desk_->news.empty(); },
        [] { press(SDLK_ESCAPE); }}});
  work_by(record::Mode::learn, std::move(steps));
  ::setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(kept().size(), 1U);
  const std::string page = fs::path(kept()[0].file).replace_extension(".html").string();
  EXPECT_EQ(goes_on, say(Word::review_goes_on, page));
  EXPECT_EQ(written, say(Word::review_written, page));
  EXPECT_TRUE(fs::exists(page));
}

// It waits while the store is locked, and is taken in at the next start.
TEST_F(ReviewWindow, TheSessionOfALearnerComesIntoTheStoreByItself) {
  desk_->store = folder_ / "school.sqlite";
  const auto place = school::place_of(desk_->store, desk_->places());
  ASSERT_TRUE(place) << place.error().text;
  auto store = school::Store::open(*place);
  ASSERT_TRUE(store) << store.error().text;
  school::Learner learner;
  learner.id = learner_ = "kestrel-27";
  ASSERT_TRUE(school::add(**store, learner, {}));
  ASSERT_TRUE((*store)->database().begin());  // another program writes
  auto steps = cut();
  add(steps, done());
  std::string told_of;
  add(steps, {{"own marks", on(Page::self_marks), nullptr},
              {"a picture", looks(5), [] { click(100, 162); }},  // the first item: met
              {"a picture", looks(5), [] { press(SDLK_RETURN); }},
              {"the end", on(Page::review), [] { press(SDLK_ESCAPE); }},
              {"the start page", on(Page::start), nullptr},
              {"it waits", [&] { return !desk_->news.empty(); },
               [&] {
                 told_of = desk_->news;
                 press(SDLK_ESCAPE);
               }}});
  work_by(record::Mode::exam, std::move(steps));
  EXPECT_NE(told_of.find("another program writes"), std::string::npos) << told_of;
  std::vector<std::string> notices;
  const auto waits = school::waiting(*place, notices);
  ASSERT_EQ(waits.size(), 1U);
  ASSERT_TRUE(waits[0].session) << "it is scored already";
  EXPECT_EQ(waits[0].session->learner, "kestrel-27");
  (*store)->database().rollback();

  enter_waiting(*desk_);
  learner_.clear();
  const auto there = [&] {
    const auto rows = school::sessions_of(**store, "kestrel-27");
    return rows && rows->size() == 1;
  };
  work_by(record::Mode::free, {{"the session", there, [] { press(SDLK_ESCAPE); }}});
  EXPECT_TRUE(school::waiting(*place, notices).empty());
  const auto rows = school::sessions_of(**store, "kestrel-27");
  ASSERT_TRUE(rows && rows->size() == 1);
  EXPECT_TRUE(rows->front().finished);
  EXPECT_FALSE(rows->front().guided);
  EXPECT_EQ(rows->front().mode, "exam");
  const auto items = school::items_of(**store, rows->front().id);
  ASSERT_TRUE(items) << items.error().text;
  EXPECT_FALSE(items->empty());
  EXPECT_EQ(std::count_if(items->begin(), items->end(),
                          [](const auto& one) { return one.self_mark == "met"; }),
            1);
}

// A scan without a case has no steps: what guides through them ends with the case.
TEST_F(ReviewWindow, AScanOfOnesOwnIsNotInTheModeOfTheCaseBefore) {
  const auto mode_of = [&](const fs::path& file, record::Mode mode) {
    record::Identity identity;
    identity.mode = mode;
    StartPage page(*desk_, mill_help_rows, {}, identity);
    drop(file);
    auto choice = page.ask("", 20);
    EXPECT_TRUE(choice && choice->open);
    return choice && choice->open ? choice->open->identity.mode : record::Mode::free;
  };
  using record::Mode;
  EXPECT_EQ(mode_of(scan(), Mode::learn), Mode::free);
  EXPECT_EQ(mode_of(scan(), Mode::practise), Mode::free);
  EXPECT_EQ(mode_of(scan(), Mode::exam), Mode::exam);
  EXPECT_EQ(mode_of(folder_ / "block.toml", Mode::learn), Mode::learn);
}

TEST_F(ReviewWindow, AnExamEndsWithoutMarks) {
  auto steps = cut();
  add(steps, done());
  bool marked = false;
  add(steps,
      {{"own marks", on(Page::self_marks), [] { press(SDLK_ESCAPE); }},
       {"the end", on(Page::review), nullptr},
       // longer than the marks of the block take
       {"a while", looks(60),
        [&] {
          marked = told("items");
          click(1190, 354);
        }},
       {"still there", [&] { return desk_->page == Page::review; }, [] { press(SDLK_ESCAPE); }},
       {"the start page", on(Page::start), nullptr},
       {"a picture", looks(5), [] { click(1190, 354); }},  // where "Marks" would be
       {"a while", [&] { return desk_->page == Page::start || desk_->page == Page::milling; },
        [] { press(SDLK_ESCAPE); }}});
  work_by(record::Mode::exam, std::move(steps));
  EXPECT_FALSE(marked);
  ASSERT_EQ(kept().size(), 1U);
  EXPECT_FALSE(kept()[0].marks) << "the start page must not show them either";
}

// The test runs itself once more as the process that is killed while it mills.
TEST_F(ReviewWindow, AKilledSessionIsOfferedAgainAndMarkedAsUnfinished) {
  if (std::getenv(kState) != nullptr) {
    auto steps = cut();
    steps.push_back({"a while", looks(20), [] { std::raise(SIGKILL); }});
    return work_by(record::Mode::learn, std::move(steps));
  }
  {
    ::setenv(kState, folder_.c_str(), 1);
    ::setenv("TMPDIR", folder_.c_str(), 1);  // what it leaves is removed with this folder
    std::string program = "/proc/self/exe", filter = "--gtest_filter=ReviewWindow.AKilledSession*";
    std::array<char*, 3> words = {program.data(), filter.data(), nullptr};
    pid_t victim = 0;
    int status = 0;
    ASSERT_EQ(::posix_spawn(&victim, program.c_str(), nullptr, nullptr, words.data(), environ), 0);
    ::unsetenv(kState);
    ::unsetenv("TMPDIR");
    ASSERT_EQ(::waitpid(victim, &status, 0), victim);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
  }
  ASSERT_EQ(kept().size(), 1U);
  EXPECT_FALSE(kept()[0].clean);
  EXPECT_TRUE(kept()[0].marks);

  const std::string command =
      test::build_dir() + "/burr --quiet score '" + kept()[0].file.string() + "' 2>&1";
  std::string said;
  FILE* out = ::popen(command.c_str(), "r");
  ASSERT_NE(out, nullptr);
  std::array<char, 4096> some{};
  while (std::fgets(some.data(), some.size(), out) != nullptr) said += some.data();
  EXPECT_EQ(::pclose(out), 0) << said;
  EXPECT_NE(said.find("unfinished"), std::string::npos) << said;

  bool told_unfinished = false;
  work_by(record::Mode::learn,
          {{"the start page", on(Page::start), nullptr},
           {"a picture", looks(5), [] { click(1190, 354); }},
           {"the marks", [&] { return desk_->page == Page::review && told("items met"); },
            [&] {
              told_unfinished = told("Unfinished");
              press(SDLK_ESCAPE);
            }},
           {"the start page", on(Page::start), nullptr},
           {"a picture", looks(5), [] { click(900, 354); }},  // goes on with it
           {"milling", on(Page::milling), nullptr},
           {"a picture", looks(5), [] { leave_work(); }},
           {"the start page", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  EXPECT_TRUE(told_unfinished);
}

TEST(Questions, EveryBuiltInCaseHasSomeAndOtherCasesNone) {
  for (const std::string& name : scenario::built_in_cases()) {
    const auto work = scenario::read_case(name);
    ASSERT_TRUE(work) << work.error().text;
    const auto parts = report::questions_on(*work);
    ASSERT_FALSE(parts.empty()) << name;
    for (const report::QuestionPart& part : parts)
      for (const report::Question& one : part.items) EXPECT_FALSE(one.text.empty()) << one.id;
  }
  scenario::Case other;
  other.name = "no-such-case";
  EXPECT_TRUE(report::questions_on(other).empty());
}

}  // namespace
}  // namespace burr::app
