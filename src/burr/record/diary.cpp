#include "burr/record/diary.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "burr/record/private_text.h"

namespace burr::record {
namespace {

constexpr double kViewsPerSecond = 10;
constexpr std::string_view kUnnamed = "a structure";

}  // namespace

Diary::Diary(Recorder& recorder, double rate_hz)
    : recorder_(recorder),
      pause_ticks_(static_cast<std::uint64_t>(std::ceil(rate_hz / kViewsPerSecond))) {}

void Diary::tell(std::uint64_t tick, CourseKind kind, const std::string& what,
                 const std::string& where, const std::string& value) {
  // a note that cannot be written ends no session; the texts here are burr's own
  static_cast<void>(recorder_.note(CourseEvent{tick, kind, what, where, value}));
}

void Diary::write(const View& view) {
  static_cast<void>(recorder_.note(view));
  written_ = view;
  now_.reset();
}

void Diary::look(const Sight& sight) {
  const std::uint64_t tick = sight.view.tick;
  if (ended_) return;
  if (written_ && same_sight(*written_, sight.view))
    now_.reset();
  else if (!written_ || tick >= written_->tick + pause_ticks_)
    write(sight.view);
  else
    now_ = sight.view;

  for (const std::string& help : sight.helps)
    if (!helps_.contains(help)) tell(tick, CourseKind::help_shown, help);
  for (const std::string& help : helps_)
    if (!sight.helps.contains(help)) tell(tick, CourseKind::help_hidden, help);
  helps_ = sight.helps;
  if (sight.near != near_ && !sight.near.empty())
    // the warning counts even if the bone's own name for the structure may not be recorded
    tell(tick, CourseKind::warning, "near",
         fit_for_a_note(sight.near) ? sight.near : std::string(kUnnamed));
  near_ = sight.near;
  if (sight.paused != paused_) {
    if (!paused_.empty()) tell(tick, CourseKind::resume, paused_);
    if (!sight.paused.empty()) tell(tick, CourseKind::pause, sight.paused);
  }
  paused_ = sight.paused;
}

void Diary::declare_done(std::uint64_t tick, bool done) {
  if (done == done_ || ended_) return;
  done_ = done;
  tell(tick, done ? CourseKind::done : CourseKind::reopened, "");
}

void Diary::end(std::uint64_t tick, Ending ending) {
  if (ended_) return;
  if (now_) write(View(*now_));
  if (done_) ending = Ending::declared_done;
  tell(tick, CourseKind::ended, "", "", word_of(ending));
  ended_ = true;
}

}  // namespace burr::record
