// What a mode offers at the window, and what it refuses, whatever key is pressed.
#include <fstream>
#include <iterator>
#include <set>

#include "burr/record/diary.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/session_words.h"
#include "support/test_places.h"
#include "user.h"

namespace burr::app {
namespace {

// what takes work back, or does it twice
constexpr tick::CommandKind kBack[] = {tick::CommandKind::undo, tick::CommandKind::redo,
                                       tick::CommandKind::reset, tick::CommandKind::mirror_i};

class Modes : public Window {
 protected:
  // A session on the practice block in this mode, with a recording; the script plays the user.
  struct Played {
    std::multiset<tick::CommandKind> commands;
    std::set<double> tools;  // values of the commands that choose what the burr does
    std::vector<std::string> course;
    double opacity = 0;
  };
  Played play(record::Mode mode, std::vector<Script::Step> steps) {
    WorkOptions work;
    work.volume.source = "block";
    work.volume.voxel_mm = 0.5;
    work.identity.mode = mode;
    NoProgress quiet;
    auto ready = open_ready(work, quiet);
    EXPECT_TRUE(ready) << ready.error().text;
    sim::Session& session = *ready->session;
    record::SessionInfo info;
    sim::describe(session.settings(), session.hand().spec(), info);
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.content_hash = session.bone().content_hash();
    record::Recorder recorder(session.settings().servo.rate_hz, 8192, true);
    const std::string file = (folder_ / "s.mcap").string();
    EXPECT_TRUE(recorder.start(file, info));
    session.set_recorder(&recorder);
    record::Diary diary(recorder, session.settings().servo.rate_hz);

    WindowOptions options;
    options.work_case = ready->work_case;
    options.lesson = ready->lesson;
    options.mode = ready->mode;
    options.allowed = ready->allowed;
    options.diary = &diary;
    Script script(std::move(steps), desk_->status_text);
    Played played;
    desk_->after_frame = [&] {
      script.look();
      played.opacity = ready->scene.look.opacity;
    };
    const auto left = mill(*desk_, session, ready->hands, *ready->worker, ready->scene, options);
    desk_->after_frame = {};
    EXPECT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
    session.set_recorder(nullptr);
    EXPECT_TRUE(recorder.finish());

    auto player = record::Player::open(file);
    EXPECT_TRUE(player) << player.error().text;
    auto cursor = (*player)->steps();
    for (record::Step step; cursor.next(step);)
      for (const tick::Command& command : step.commands) {
        played.commands.insert(command.kind);
        if (command.kind == tick::CommandKind::tool_mode) played.tools.insert(command.value);
      }
    for (const record::CourseEvent& event : (*player)->course())
      played.course.push_back(std::string(record::word_of(event.kind)) + " " + event.what +
                              (event.where.empty() ? "" : " " + event.where));
    return played;
  }
  // the window says so
  [[nodiscard]] std::function<bool()> told(Word says) const {
    return [this, says] { return desk_->status_text.find(word(says)) != std::string::npos; };
  }
  static bool has(const Played& played, const std::string& event) {
    return std::find(played.course.begin(), played.course.end(), event) != played.course.end();
  }
  // Presses all keys that an exam refuses, some pictures apart.
  static std::vector<Script::Step> refused_keys() {
    std::vector<Script::Step> steps = {{"a picture", looks(5), {}}};
    for (const SDL_Keycode code :
         {SDLK_u, SDLK_y, SDLK_r, SDLK_4, SDLK_5, SDLK_x, SDLK_t, SDLK_a, SDLK_j})
      steps.push_back({"a key", looks(2), [code] { press(code); }});
    steps.push_back({"a key", looks(2), [] { press(SDLK_x, KMOD_LSHIFT); }});
    steps.push_back({"a key", looks(2), [] { press(SDLK_x, KMOD_LCTRL); }});
    return steps;
  }
};

TEST_F(Modes, AnExamUndoesBringsBackAndShowsNothing) {
  auto steps = refused_keys();
  steps.push_back({"refused", told(Word::refused_exam), [] { leave_work(); }});
  const Played exam = play(record::Mode::exam, std::move(steps));
  for (const tick::CommandKind kind : kBack)
    EXPECT_EQ(exam.commands.count(kind), 0U) << static_cast<int>(kind);
  for (const tick::CommandKind kind :
       {tick::CommandKind::mirror_j, tick::CommandKind::mirror_k, tick::CommandKind::mirror_off})
    EXPECT_EQ(exam.commands.count(kind), 0U) << static_cast<int>(kind);
  EXPECT_TRUE(exam.tools.empty());
  EXPECT_EQ(exam.opacity, 1);
  for (const std::string& event : exam.course) {
    EXPECT_EQ(event.find("step_"), std::string::npos) << event;
    EXPECT_EQ(event.find("target"), std::string::npos) << event;
    EXPECT_EQ(event.find("labels"), std::string::npos) << event;
    EXPECT_EQ(event.find("see-through"), std::string::npos) << event;
  }
}

// The same keys; so the test above can fail.
TEST_F(Modes, FreeWorkDoesAllThat) {
  auto steps = refused_keys();
  steps.push_back({"done", looks(3), [] { leave_work(); }});
  const Played freely = play(record::Mode::free, std::move(steps));
  for (const tick::CommandKind kind : kBack)
    EXPECT_GT(freely.commands.count(kind), 0U) << static_cast<int>(kind);
  EXPECT_EQ(freely.tools.size(), 2U) << "original and smooth";
  EXPECT_LT(freely.opacity, 1);
  EXPECT_TRUE(has(freely, "help_shown labels"));
  EXPECT_TRUE(has(freely, "help_shown target groove"));
}

TEST_F(Modes, LearningHasStepsAndALitTargetAndTheRecordingCountsBoth) {
  const Played learn =
      play(record::Mode::learn, {{"a picture", looks(5), [] { press(SDLK_o); }},
                                 {"the steps", looks(3), [] { press(SDLK_a); }},
                                 {"lit", looks(3), [] { press(SDLK_a); }},
                                 {"dark", looks(3), [] { press(SDLK_j); }},
                                 {"the second step", looks(3), [] { press(SDLK_j); }},
                                 {"all done", told(Word::steps_all_done), [] { leave_work(); }}});
  const std::vector<std::string> in_order = {
      "step_begun groove",         "help_shown steps", "help_shown target groove",
      "help_hidden target groove", "step_done groove", "step_done second-groove"};
  auto at = learn.course.begin();
  for (const std::string& event : in_order) {
    at = std::find(at, learn.course.end(), event);
    EXPECT_NE(at, learn.course.end()) << event;
  }
}

// Nobody sees a score while he works: the page for milling cannot compute one. Marks come from the
// page at the end of a case, which only the order of pages knows.
TEST(Scores, TheWindowKnowsNothingOfThemButWhetherAStepIsDone) {
  const fs::path window = fs::path(test::source_dir()) / "apps/burr/window";
  int files = 0, reviews = 0;
  for (const auto& entry : fs::recursive_directory_iterator(window)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    std::string text{std::istreambuf_iterator<char>(file), {}};
    ++files;
    for (const char* header : {"step_done.h", "step_target.h"}) {
      const std::string allowed = "#include \"burr/scoring/" + std::string(header) + '"';
      for (std::size_t at = text.find(allowed); at != text.npos; at = text.find(allowed))
        text.erase(at, allowed.size());
    }
    EXPECT_EQ(text.find("burr/scoring/"), text.npos) << entry.path();
    const std::string folder = entry.path().parent_path().filename().string();
    if (folder == "review") {
      ++reviews;
      continue;
    }
    // who marks products sees them from the sides from which a report shows them; the score is not made
    if (folder == "rate") {
      for (const std::string view : {"\"burr/report/product_views.h\"", "\"burr/report/scored.h\"",
                                     "\"burr/report/piece_words.h\""})
        if (const auto at = text.find(view); at != text.npos) text.erase(at, view.size());
      EXPECT_EQ(text.find(" scored("), text.npos) << entry.path();
      EXPECT_EQ(text.find("Scored"), text.npos) << entry.path();
    }
    // autosave.cpp asks whether there is a rubric
    if (entry.path().filename() != "autosave.cpp") {
      EXPECT_EQ(text.find("\"burr/report/"), text.npos) << entry.path();
    }
    if (folder != "shell") {  // the order of pages
      EXPECT_EQ(text.find("window/review/"), text.npos) << entry.path();
    }
  }
  EXPECT_GT(files, 50);
  EXPECT_GE(reviews, 8);
}

}  // namespace
}  // namespace burr::app
