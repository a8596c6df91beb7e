#include "window/review/review.h"

#include <SDL2/SDL.h>
#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "burr/render/picture.h"
#include "burr/report/marked.h"
#include "burr/report/questions.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/review/full_report.h"
#include "window/review/review_page.h"
#include "window/review/self_marks_page.h"
#include "window/ui/loading.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

// Draws a page until it has an answer; nothing moves on it, so thirty pictures a second are enough.
// closed: the user closed the window, or burr was interrupted.
// enter: what the key does; not while the keyboard is used to choose a button.
Status show_until(Desk& desk, const std::function<bool()>& draw,
                  const std::function<void()>& escape, const std::function<void()>& enter,
                  double seconds, bool& closed) {
  const render::Scene empty;
  const Clock::time_point start = Clock::now();
  bool answered = false;
  closed = false;
  while (!answered && !closed) {
    const Clock::time_point frame = Clock::now();
    SDL_Event event;
    while (desk.next(event)) {
      if (event.type == SDL_QUIT) closed = true;
      if (event.type != SDL_KEYDOWN) continue;
      const SDL_Keycode key = event.key.keysym.sym;
      if (key == SDLK_ESCAPE) escape();
      if ((key == SDLK_RETURN || key == SDLK_KP_ENTER) && !ImGui::GetIO().NavVisible) enter();
    }
    const Status shown = desk.show(
        empty, [&] { answered = draw() || answered; }, true);
    if (!shown) return shown;
    const bool over = seconds > 0 && Clock::now() - start >= std::chrono::duration<double>(seconds);
    closed = closed || interrupted() || over;
    const auto left = std::chrono::milliseconds(33) - (Clock::now() - frame);
    if (left.count() > 0)
      SDL_Delay(
          static_cast<Uint32>(std::chrono::duration_cast<std::chrono::milliseconds>(left).count()));
  }
  return fine();
}

// What only the user knows about the bone: a scan of his own. The recording finds a formula, a case and
// an embedded bone by itself.
scenario::BoneRecipe own_scan(const scenario::BoneRecipe& volume) {
  std::error_code nobody_asks;
  const std::filesystem::path source = volume.source;
  return std::filesystem::exists(source, nobody_asks) && source.extension() != ".toml"
             ? volume
             : scenario::BoneRecipe();
}

class Review {
 public:
  Review(Desk& desk, const ReviewOptions& options)
      : desk_(desk),
        options_(options),
        volume_(own_scan(options.volume)),
        full_(std::make_shared<FullReport>(
            options.file, options.rubric, volume_,
            std::filesystem::path(options.file).replace_extension(".html").string())) {
    if (!options.marks) return;
    marking_ = std::make_unique<Loading<report::Report>>(
        [file = options.file, rubric = options.rubric, volume = volume_](Progress& progress) {
          return report::marked(file, rubric, volume, progress);
        });
  }

  Result<Closed> run() {
    for (;;) {
      desk_.page = Page::review;
      desk_.renderer().title("burr");
      const report::ReportItem* seen = nullptr;
      bool closed = false, leaves = false;
      pressed_ = {};
      const Status shown = show_until(
          desk_,
          [&] {
            draw();
            seen = pressed_.item;
            return leaves || seen != nullptr || pressed_.close || pressed_.again;
          },
          [&] { leaves = true; }, [] {}, options_.seconds, closed);
      if (!shown) return shown.error();
      if (closed) return leave_with(Closed::window);
      if (pressed_.again) return leave_with(Closed::again);
      if (seen == nullptr) return leave_with(Closed::page);
      auto played = play(*seen);
      if (!played) return played.error();
      if (*played == Closed::window) return leave_with(Closed::window);
    }
  }

 private:
  Result<Closed> leave_with(Closed how) {
    leave_report();
    if (options_.screenshot.empty()) return how;
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
    return how;
  }

  // A report that is not written yet goes on without this page, and the start page says so. The
  // terminal does too, because burr may end before.
  void leave_report() {
    if (!full_->writes()) return;
    desk_.news = say(Word::review_goes_on, full_->page());
    fmt::print(stderr, "{}\n", desk_.news);
    desk_.under_way.emplace_back([&desk = desk_, report = full_] {
      report->step(desk.page == Page::start);  // nobody wants a browser over a session
      if (report->writes()) return false;
      desk.news = report->note();
      return true;
    });
  }

  void draw() {
    if (marking_ && marking_->finished()) {
      auto made = marking_->take();
      marking_.reset();
      if (made)
        report_ = std::move(*made);
      else
        trouble_ = in_options(made.error()).text;
    }
    full_->step();
    ReviewState state;
    state.title = options_.title;
    state.report = report_ ? &*report_ : nullptr;
    state.progress = marking_ ? marking_->progress().now().fraction : 0;
    state.trouble = trouble_;
    state.exam = !options_.marks;
    state.repeats = options_.repeats;
    state.writes = full_->writes();
    state.note = note_.empty() ? full_->note() : note_;
    desk_.status_text = state.note;
    if (report_) {
      desk_.status_text += " " + report_->unfinished;
      for (const report::ReportPart& part : report_->parts) desk_.status_text += " " + part.met;
    }
    pressed_ = draw_review(desk_.ui(), state);
    if (pressed_.full) {
      note_.clear();
      full_->ask();
    }
  }

  Result<Closed> play(const report::ReportItem& item) {
    note_.clear();
    ReviewMoment moment;
    moment.volume = volume_;
    moment.at = *item.at_s;
    moment.place = item.place;
    moment.towards = report_->towards;
    moment.note = item.text + "   " + word(Word::review_back);
    return options_.show(moment, note_);
  }

  Desk& desk_;
  const ReviewOptions& options_;
  scenario::BoneRecipe volume_;
  ReviewPressed pressed_;
  std::optional<report::Report> report_;
  std::string trouble_, note_;
  std::shared_ptr<FullReport> full_;
  std::unique_ptr<Loading<report::Report>> marking_;  // last: its thread ends first
};

}  // namespace

std::string rubric_for(const scenario::Case& work) { return report::rubric_of(work); }

bool has_marks(const scenario::Case& work) { return !report::questions_on(work).empty(); }

Result<bool> ask_self_marks(Desk& desk, const scenario::Case& work, record::Diary& diary,
                            std::uint64_t tick, double seconds) {
  SelfMarksPage page(report::questions_on(work));
  desk.page = Page::self_marks;
  desk.renderer().title("burr");
  using Pressed = SelfMarksPage::Pressed;
  Pressed pressed = Pressed::nothing;
  bool closed = false;
  const Status shown = show_until(
      desk,
      [&] {
        if (pressed == Pressed::nothing) pressed = page.draw(desk.ui());
        return pressed != Pressed::nothing;
      },
      [&] { pressed = Pressed::skipped; }, [&] { pressed = Pressed::finished; }, seconds, closed);
  if (!shown) return shown.error();
  // also when the window was closed: what was marked is marked
  if (pressed != Pressed::skipped)
    for (const auto& [id, mark] : page.marks())
      static_cast<void>(diary.note({tick, record::CourseKind::self_mark, id, {}, mark}));
  return !closed;
}

Result<Closed> review(Desk& desk, const ReviewOptions& options) {
  return Review(desk, options).run();
}

}  // namespace burr::app
