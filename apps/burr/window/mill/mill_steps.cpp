// The steps of the case on the page, and what the mode of the session allows.
#include <optional>
#include <string>
#include <utility>

#include "burr/guidance/suits.h"
#include "burr/record/diary.h"
#include "burr/record/private_text.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/steps_panel.h"
#include "window/parts/see_through.h"

namespace burr::app {

bool Mill::allows(Action action) const {
  switch (action) {
    case Action::back:
    case Action::smooth:
    case Action::undo:
    case Action::redo:
    case Action::reset:
    case Action::mirror:
      return options_.allowed.back;
    case Action::measure:
      return options_.allowed.measure;
    case Action::cut:
    case Action::add:
    case Action::touch:
    case Action::export_:
    case Action::smaller:
    case Action::larger:
    case Action::slower:
    case Action::faster:
    case Action::settings:
    case Action::help:
    case Action::leave:
    case Action::kind:
    case Action::coolant:
    case Action::slices:
    case Action::keep:
    case Action::suction:
    case Action::views:
    case Action::structures:
    case Action::task:
    case Action::picture:
    case Action::sound:
    case Action::menu:
    case Action::rack:
    case Action::beside:  // these: of the page that plays a recording
    case Action::compare:
    case Action::earlier:
    case Action::later:
    case Action::step_back:
    case Action::step_on:
    case Action::stroke_back:
    case Action::stroke_on:
    case Action::first_view:
    case Action::labels:
    case Action::hide:
    case Action::play:
    case Action::film_from:
    case Action::film_until:
      return true;
    case Action::see_through:
      return options_.allowed.see_through;
  }
  return true;
}

void Mill::say_refused() {
  note(word(options_.mode == record::Mode::exam ? Word::refused_exam : Word::refused_case));
}

void Mill::toggle_labels() {
  if (!options_.allowed.colours) return say_refused();
  show_labels(!labels_);
}

void Mill::step_opacity(bool back) {
  if (!options_.allowed.see_through) return say_refused();
  note(step_see_through(scene_, back));
}

void Mill::tell(const guidance::Steps::Events& events) {
  if (events.empty()) return;
  if (light_.is_on()) light_target();  // it was the target of another step
  if (options_.diary == nullptr) return;
  for (const guidance::Steps::Event& one : events)
    static_cast<void>(options_.diary->note({row_.tick, one.kind, one.what, {}, one.value}));
}

// In the first picture of the session, so that the first step has a tick. In an exam the user sees no
// steps and declares none.
void Mill::begin_steps() {
  if (!steps_offered() || steps_begun_) return;
  steps_begun_ = true;
  tell(steps_.begin());
}

// A step whose `done` is reached is ticked off, unless the user opened it again.
void Mill::look_at_measure() {
  if (!watch_ || !steps_begun_) return;
  const auto now = steps_.current();
  // while the question "is the work done?" is open no measurement begins: the user would wait for its end
  const bool looks = now && !steps_.was_reopened(*now) && !pages_->asks_done();
  watch_->look(looks ? now : std::nullopt);
  const auto done = watch_->take();
  if (!done || done != steps_.current()) return;
  const std::string& title = steps_[*done].title.in(spoken().code);
  note(say(Word::steps_ticked, title.empty() ? steps_[*done].id : title));
  tell(steps_.declare_done(true));
}

void Mill::step_done() {
  if (steps_.empty()) return note(word(Word::steps_none));
  if (!steps_offered()) return say_refused();
  tell(steps_.declare_done());
  if (steps_.now() == nullptr) note(word(Word::steps_all_done));
}

// Lights the target of the current step, or puts the light out. The recording counts it.
void Mill::light_target() {
  if (steps_.empty()) return note(word(Word::steps_none));
  if (!options_.allowed.target) return say_refused();
  const bool lights = !light_.is_on() && steps_.now() != nullptr;
  if (!lights && !light_.is_on()) return;
  if (lights) {
    lit_step_ = steps_.id(*steps_.current());
    light_.on(*steps_.now(), *options_.lesson, session_.bone_tissues(), scene_);
  } else {
    light_.off(scene_);
  }
  if (options_.diary != nullptr)
    static_cast<void>(options_.diary->note(
        {row_.tick, lights ? record::CourseKind::help_shown : record::CourseKind::help_hidden,
         "target", lit_step_}));
}

void Mill::look_at_technique() {
  cue_ = guidance::Technique::Cue::none;
  if (!options_.allowed.technique || !ticks_.begun()) return;
  guidance::Technique::Moment now;
  now.t = static_cast<double>(row_.tick) / session_.settings().servo.rate_hz;
  now.cutting = row_.contact.touching && row_.spindle_rad_s != 0 &&
                row_.ledger.removed > std::exchange(removed_before_, row_.ledger.removed);
  now.force = row_.contact.force.norm();
  if (nearest_) now.nearest = nearest_->distance;
  now.diameter = 2 * scene_.burr.radius;
  if (const scenario::RackTool* tool = rack_.tool(row_.tool.number)) now.tool = tool->name;
  now.kind = scene_.burr.diamond ? tool::BurrKind::diamond : tool::BurrKind::cutting;
  cue_ = technique_.look(now, steps_.now());
  if (technique_.fresh() && options_.diary != nullptr)
    static_cast<void>(options_.diary->note(
        {row_.tick, record::CourseKind::help_shown, "technique", guidance::Technique::name(cue_)}));
}

// A turning burr in what must not be cut. The message comes once, and again only after the burr was out of it. No flash: it
// would startle a hand that is in the wrong place already.
void Mill::look_at_injury() {
  constexpr double kTurning = 0.05;  // of full speed
  const bool turning = row_.spindle_rad_s > kTurning * drill_.full_speed();
  bool begins = false;
  if (nearest_)
    begins =
        injury_.look(nearest_->name, nearest_->distance, turning, session_.bone().grid().voxel);
  else
    injury_.nothing_near();
  const bool heard = options_.allowed.injury != workshop::Injury::silent;
  if (options_.loudspeaker != nullptr) options_.loudspeaker->injury(injury_.is_in() && heard);
  if (!begins || options_.allowed.injury != workshop::Injury::stop) return;
  lift();
  if (hands_.real != nullptr && !lifts_.stopped) stop_or_go_on();
  note(say(Word::injury_stop, anatomy(nearest_->name)));
  if (options_.diary != nullptr)
    static_cast<void>(options_.diary->note(
        {row_.tick, record::CourseKind::warning, "injury",
         record::fit_for_a_note(nearest_->name) ? nearest_->name : std::string("a structure")}));
}

std::string Mill::cue_text() const {
  switch (cue_) {
    case guidance::Technique::Cue::none:
      break;
    case guidance::Technique::Cue::gentler:
      return word(Word::cue_gentler);
    case guidance::Technique::Cue::kind:
    case guidance::Technique::Cue::larger:
    case guidance::Technique::Cue::smaller:
      return steps_.now() != nullptr ? say(Word::cue_tool, guidance::suits(*steps_.now()))
                                     : std::string();
  }
  return {};
}

void Mill::draw_steps_panel() {
  const StepsPressed pressed =
      draw_steps(desk_.ui(), steps_, options_.allowed.target, light_.is_on());
  if (pressed.done) step_done();
  if (pressed.light) light_target();
  if (pressed.row) tell(steps_.choose(*pressed.row));
}

}  // namespace burr::app
