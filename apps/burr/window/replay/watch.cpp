#include "window/replay/watch.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "burr/render/picture.h"
#include "burr/scenario/open_lesson.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/parts/export_page.h"
#include "window/parts/measuring.h"
#include "window/replay/comparison.h"
#include "window/replay/replay_view.h"
#include "window/replay/split_view.h"
#include "window/ui/file_dialog.h"

namespace burr::app {
namespace {

// After this time without input or change the window is drawn this often: a film that is being made
// then has the processor.
constexpr auto kRestsAfter = std::chrono::seconds(1);
constexpr auto kAtRest = std::chrono::milliseconds(100);

}  // namespace

// The names of structures are those of the recorded case.
void Watch::take_titles() const {
  take_titles_of(nullptr);
  const auto& info = recorded_.player->info().work_case;
  if (!info) return;
  if (const auto lesson = scenario::parse_lesson(info->text, info->name)) take_titles_of(&*lesson);
}

Result<Closed> Watch::run() {
  desk_.page = Page::replay;
  desk_.renderer().title("burr");
  export_.emplace(desk_, nullptr, scene_, options_.folder, [this] {
    recorded_.film.effects = desk_.settings.effects;
    recorded_.film.plan.from = now_.film_from;
    recorded_.film.plan.until = now_.film_until;
    return std::optional(recorded_.film);
  });
  first_view_ = scene_.camera;
  first_.emplace(recorded_, desk_.renderer().software(), desk_.governor);
  if (!options_.beside.empty()) {
    const Status opened = open_beside(options_.beside);
    if (!opened && opened.error().trouble != Trouble::interrupted) return opened.error();
  }
  now_.film_until = first_->line().seconds;
  if (!workshop::read_spared(recorded_.player->info()).empty()) facts_.emplace(recorded_);
  now_.t = std::max(0.0, options_.from);
  now_.playing = options_.from < 0 || options_.until > options_.from;
  stop_at_ = options_.until > options_.from ? options_.until : seconds();

  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start, last = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    const Clock::time_point began = Clock::now();
    take_events();
    // playing continues, unless the user drags along the time line
    const double passed = std::chrono::duration<double>(began - last).count();
    last = began;
    if (now_.playing && !scrubbing_) now_.t += now_.pace * std::min(passed, 0.25);
    if (now_.playing && !scrubbing_ && now_.t >= std::min(stop_at_, seconds())) {
      now_.t = std::min(stop_at_, seconds());
      now_.playing = false;
    }
    if (now_.t >= seconds()) {
      now_.t = seconds();
      if (!scrubbing_) now_.playing = false;
    }
    // a slow computer shows fewer moments; the session does not take longer
    first_->want(now_.t);
    if (second_) second_->want(now_.t - now_.shift);
    if (ExportPage::Note ended = export_->step(); !ended.text.empty())
      note(std::move(ended.text), ended.stays);
    const bool writes = !export_->progress().empty();
    if (writes && !writing_) note({});  // the line is for what is being written now
    writing_ = writes;
    if (!note_stays_ && Clock::now() - noted_ > std::chrono::seconds(6)) note({});
    shown = show();
    if (now_.playing || scrubbing_ || !first_->settled() || (second_ && !second_->settled()) ||
        !desk_.renderer().refined())
      stirred_ = Clock::now();
    // not while the panels are drawn: it may be the second bone's end, which is being shown
    if (const auto pressed = std::exchange(pressed_, std::nullopt)) act(*pressed);
    if (std::exchange(picture_, false)) {
      const Result<std::string> left = desk_.leave_picture(options_.folder);
      note(left ? say(Word::picture_left, *left) : in_options(left.error()).text);
    }
    frame = std::max(frame + std::chrono::microseconds(16'667), Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    if (at_rest())
      SDL_WaitEventTimeout(nullptr, static_cast<int>(kAtRest.count()));  // an event ends the wait
    else if (wait.count() > 0)
      SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  export_.reset();
  close_beside();
  facts_.reset();
  first_.reset();
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return closed_;
}

// Draws one picture: of one recording, or of both in halves of the window.
Status Watch::show() {
  // dust would lie over the colours
  const bool effects = desk_.settings.effects && !(comparison_ && compare_ == Compare::colours);
  first_->look(effects, now_.playing, desk_.settings.left_handed);
  if (second_) second_->look(effects, now_.playing, desk_.settings.left_handed);
  tell();
  now_.buttons.clear();
  now_.table = {};
  const bool notes = !note_.empty() && Clock::now() - noted_ < std::chrono::seconds(3);
  const auto over =
      panels_ || page_open() || notes ? [this] { panels(); } : std::function<void()>();
  Status shown = fine();
  if (second_) {
    follow();
    shown = pair_->draw({&scene_, &second_->scene()}, desk_.renderer().width(),
                        desk_.renderer().height());
    desk_.renderer().make_current();
    first_->drawn(pair_->took_s(0), pair_->redrawn(0));
    second_->drawn(pair_->took_s(1), pair_->redrawn(1));
    if (shown) shown = desk_.show(pair_->both(), over);
  } else {
    const Clock::time_point drawing = Clock::now();
    shown = desk_.show(scene_, over);
    first_->drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
                  desk_.renderer().figures().redrawn);
  }
  now_.shown = first_->shown();
  now_.known = first_->known();
  now_.force = first_->force();
  now_.removed = first_->removed();
  now_.diameter = 2 * first_->tool_of_values().radius;
  now_.behind = first_->behind() || (second_ && second_->behind());
  now_.beside = second_.has_value();
  now_.shown_beside = second_ ? second_->shown() : 0;
  now_.removed_beside = second_ ? second_->removed() : 0;
  now_.note = !export_->trouble().empty() ? export_->trouble()
              : !trouble_.empty()         ? trouble_
                                          : note_;
  now_.note_stays = note_stays_ && !note_.empty();
  now_.panels = panels_;
  now_.help = help_;
  now_.exporting = export_->shown();
  if (options_.seen != nullptr) *options_.seen = now_;
  return shown;
}

// ---- the second recording

Status Watch::open_beside(const std::string& file) {
  if (!options_.open)
    return error(Trouble::usage, file + ": a second recording cannot be opened here");
  bool closed = false;
  auto opened = options_.open(file, closed);
  desk_.page = Page::replay;
  if (closed) open_ = false;
  if (!opened) return opened.error();
  close_beside();
  beside_ = std::make_unique<Recorded>(std::move(*opened));
  second_.emplace(*beside_, desk_.renderer().software(), desk_.governor);
  second_->show_labels(labels_);
  second_view_ = beside_->scene.camera;
  // if both have the same bone, both are seen from the same viewpoint
  if (same_grid(recorded_.bone->grid(), beside_->bone->grid())) second_view_ = first_view_;
  pair_.emplace();
  if (!facts_) facts_.emplace(recorded_);
  comparison_ = std::make_unique<Comparison>(*first_, *second_);
  return fine();
}

void Watch::close_beside() {
  comparison_.reset();
  pair_.reset();
  second_.reset();
  beside_.reset();
  now_.shift = 0;
}

// Shows distances, the table of losses, the colours of the difference, and slices.
void Watch::tell() {
  if (facts_) facts_->step();
  const Facts* first = facts_ ? facts_->facts() : nullptr;
  if (comparison_) {
    comparison_->step(first);
    comparison_->colour(compare_ == Compare::colours);
  }
  draw_slices();
  now_.measured = first != nullptr && (!comparison_ || comparison_->right() != nullptr);
  const bool coloured = comparison_ && comparison_->coloured();
  if (coloured == std::exchange(now_.coloured, coloured)) return;
  // the tools would hide what they cut
  first_->scene().burr.visible = !coloured;
  if (second_) second_->scene().burr.visible = !coloured;
}

// Slices of both at the same place, in a column at the right of each half.
void Watch::draw_slices() {
  const int height = desk_.renderer().height();
  const int wide = second_ ? desk_.renderer().width() / 2 : desk_.renderer().width();
  const int bottom = static_cast<int>(184 * desk_.ui().unit());
  const ReplayView& of = now_.slices == 2 && second_ ? *second_ : *first_;
  const math::Vec3 place = of.place();
  first_->slices().update(scene_, place, now_.slices != 0, labels_, wide, height, bottom);
  if (second_)
    second_->slices().update(second_->scene(), place, now_.slices != 0, labels_,
                             desk_.renderer().width() - wide, height, bottom);
}

void Watch::next_comparison() {
  if (!second_) return ask_beside();
  if (!comparison_) return;
  compare_ = compare_ == Compare::none    ? Compare::table
             : compare_ == Compare::table ? Compare::colours
                                          : Compare::none;
  if (compare_ == Compare::colours && now_.measured && !comparison_->comparable())
    note(word(Word::beside_other_bone));
}

void Watch::next_slices() {
  now_.slices = (now_.slices + 1) % (second_ ? 3 : 2);
  if (now_.slices != 0)
    note(word(now_.slices == 2 ? Word::slices_right
              : second_        ? Word::slices_left
                               : Word::slices_burr));
}

void Watch::ask_beside() {
  if (second_) return close_beside();
  dialog_.ask(word(Word::dialog_second), FileDialog::Wanted::recordings);
  SDL_StartTextInput();
}

void Watch::shift(double by) {
  if (!second_) return note(word(Word::replay_second_first));
  // limits: the second begins no later than the first ends, and ends no earlier than the first
  // begins
  now_.shift = std::clamp(now_.shift + by, -second_->line().seconds, first_->line().seconds);
  note(say(Word::replay_shifted, now_.shift));
}

// Moves the second camera like the first: the same turn, shift and zoom since the start.
void Watch::follow() {
  render::Camera camera = scene_.camera;
  camera.target = second_view_.target + (camera.target - first_view_.target);
  camera.distance *= second_view_.distance / first_view_.distance;
  camera.azimuth += second_view_.azimuth - first_view_.azimuth;
  constexpr double kHighest = 1.55;  // just below the pole
  camera.elevation = std::clamp(camera.elevation + second_view_.elevation - first_view_.elevation,
                                -kHighest, kHighest);
  second_->scene().camera = camera;
  second_->scene().look.opacity = scene_.look.opacity;
}

bool Watch::at_rest() const { return Clock::now() - stirred_ > kRestsAfter; }

double Watch::stroke_before(double t) const {
  const double first = first_->line().stroke_before(t).value_or(0);
  if (!second_) return first;
  return std::max(first,
                  second_->line().stroke_before(t - now_.shift).value_or(-now_.shift) + now_.shift);
}

double Watch::stroke_after(double t) const {
  const double first = first_->line().stroke_after(t).value_or(seconds());
  if (!second_) return first;
  const auto other = second_->line().stroke_after(t - now_.shift);
  return other ? std::min(first, *other + now_.shift) : first;
}

Result<Closed> watch(Desk& desk, Recorded& recorded, const WatchOptions& options) {
  return Watch(desk, recorded, options).run();
}

}  // namespace burr::app
