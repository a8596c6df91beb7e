#include "window/mill/mill_case.h"

#include <utility>

#include "burr/guidance/suits.h"
#include "burr/record/private_text.h"
#include "shared/word_names.h"
#include "window/mill/steps_panel.h"

namespace burr::app {
namespace {

constexpr double kNear = 1e-3, kFarAgain = 1.3e-3;  // of what must not be cut  [m]

}  // namespace

MillCase::MillCase(volume::Bone& bone, double rate_hz, render::Scene& scene,
                   const WindowOptions& options, const tick::TickRow& row, MillNotes& notes)
    : bone_(bone), rate_hz_(rate_hz), scene_(scene), options_(options), row_(row), notes_(notes) {
  if (options_.lesson) steps_ = guidance::Steps(options_.lesson->steps);
  if (steps_offered()) steps_.take_up(options_.left.course);
  take_titles_of(options_.lesson ? &*options_.lesson : nullptr);
}

void MillCase::begin() {
  if (!steps_.empty()) watch_.emplace(bone_, *options_.lesson);
  if (options_.diary == nullptr || !options_.left.declared_done) return;
  options_.diary->was_declared_done();
  if (!options_.done_ends) notes_.note(word(Word::done_declared));
}

void MillCase::end(bool time_over) {
  if (options_.diary != nullptr)
    options_.diary->end(row_.tick, time_over ? record::Ending::time_up : record::Ending::broke_off);
  light_.off(scene_);
  watch_.reset();
}

bool MillCase::allows(Action action) const {
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

void MillCase::say_refused() {
  notes_.note(word(options_.mode == record::Mode::exam ? Word::refused_exam : Word::refused_case));
}

void MillCase::tell(const guidance::Steps::Events& events) {
  if (events.empty()) return;
  light_off();  // it was the target of another step
  press_.reset();
  ++turns_;
  for (const guidance::Steps::Event& one : events) write(one.kind, one.what, {}, one.value);
}

// A note that cannot be written ends no session; the texts are burr's own.
void MillCase::write(record::CourseKind kind, const std::string& what, const std::string& where,
                     const std::string& value) {
  if (options_.diary != nullptr)
    static_cast<void>(options_.diary->note({row_.tick, kind, what, where, value}));
}

// The first step has a tick of its own. In an exam the user sees no steps and declares none.
void MillCase::look_at_steps(bool asks_done) {
  if (steps_offered() && !std::exchange(steps_begun_, true)) tell(steps_.begin());
  look_at_measure(asks_done);
}

// A step whose `done` is reached is ticked off, unless the user opened it again.
void MillCase::look_at_measure(bool asks_done) {
  if (!watch_ || !steps_begun_ || options_.mode == record::Mode::free) return;
  const auto now = steps_.current();
  // while the question "is the work done?" is open no measurement begins: the user would wait for its end
  const bool looks = now && !steps_.was_reopened(*now) && !asks_done;
  watch_->look(looks ? now : std::nullopt);
  const auto done = watch_->take();
  if (!done || done != steps_.current()) return;
  const std::string& title = steps_[*done].title.in(spoken().code);
  notes_.note(say(Word::steps_ticked, title.empty() ? steps_[*done].id : title));
  tell(steps_.declare_done(true));
}

void MillCase::step_done() {
  if (steps_.empty()) return notes_.note(word(Word::steps_none));
  if (!steps_offered()) return say_refused();
  wanted_ = true;
  tell(steps_.declare_done());
  if (steps_.now() == nullptr) notes_.note(word(Word::steps_all_done));
}

void MillCase::light_target() {
  if (steps_.empty()) return notes_.note(word(Word::steps_none));
  if (!options_.allowed.target) return say_refused();
  const bool lights = !light_.is_on() && steps_.now() != nullptr;
  if (!lights && !light_.is_on()) return;
  if (lights) {
    lit_step_ = steps_.id(*steps_.current());
    wanted_ = true;
    ++turns_;
    light_step();
  } else {
    light_.off(scene_);
  }
  write(lights ? record::CourseKind::help_shown : record::CourseKind::help_hidden, "target",
        lit_step_);
}

void MillCase::light_step() {
  const bool known = target_ && target_->step == steps_.current();
  light_.on(guidance::marks_of(*steps_.now(), *options_.lesson, bone_.tissues(),
                               known ? &target_->target : nullptr),
            scene_);
}

bool MillCase::follows() const {
  return steps_offered() && (options_.allowed.steps == workshop::Offer::always || wanted_);
}

void MillCase::seek_target(double radius) {
  if (watch_) watch_->seek({steps_.current().value_or(0), radius});
}

std::optional<guidance::StepWatch::Seen> MillCase::look_at_target() {
  auto seen = watch_ ? watch_->seen() : std::nullopt;
  if (!seen) return seen;
  target_ = seen;
  if (light_.is_on() && steps_.current() == seen->step) light_step();
  return seen;
}

void MillCase::look_at_technique(const Nearest& nearest, const scenario::RackTool* tool) {
  if (!options_.allowed.technique) return;
  guidance::Technique::Moment now;
  now.t = static_cast<double>(row_.tick) / rate_hz_;
  now.cutting = row_.contact.touching && row_.spindle_rad_s != 0 &&
                row_.ledger.removed > std::exchange(removed_before_, row_.ledger.removed);
  now.force = row_.contact.force.norm();
  if (nearest) now.nearest = nearest->distance;
  now.diameter = 2 * scene_.burr.radius;
  if (tool != nullptr) now.tool = tool->name;
  now.kind = scene_.burr.diamond ? tool::BurrKind::diamond : tool::BurrKind::cutting;
  cue_ = technique_.look(now, steps_.now());
  if (technique_.fresh())
    write(record::CourseKind::help_shown, "technique", guidance::Technique::name(cue_));
}

std::string MillCase::cue_text() const {
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

// A turning burr in what must not be cut. It begins once, and again only after the burr was out of it.
bool MillCase::look_at_injury(const Nearest& nearest, double full_speed) {
  constexpr double kTurning = 0.05;  // of full speed
  const bool turning = row_.spindle_rad_s > kTurning * full_speed;
  bool begins = false;
  if (nearest)
    begins = injury_.look(nearest->name, nearest->distance, turning, bone_.grid().voxel);
  else
    injury_.nothing_near();
  const bool heard = options_.allowed.injury != workshop::Injury::silent;
  if (options_.loudspeaker != nullptr) options_.loudspeaker->injury(injury_.is_in() && heard);
  return begins && options_.allowed.injury == workshop::Injury::stop;
}

// No flash: it would startle a hand that is in the wrong place already.
void MillCase::say_injury(const std::string& structure) {
  notes_.note(say(Word::injury_stop, anatomy(structure)));
  write(record::CourseKind::warning, "injury",
        record::fit_for_a_note(structure) ? structure : "a structure");
}

void MillCase::draw_steps_panel(Ui& ui) {
  StepsState state = {.offers_light = options_.allowed.target, .press = press_};
  if (light_.is_on()) state.lit = &light_.marks();
  const StepsPressed pressed = draw_steps(ui, steps_, state);
  if (pressed.done) step_done();
  if (pressed.light) light_target();
  if (!pressed.row) return;
  wanted_ = true;
  tell(steps_.choose(*pressed.row));
}

void MillCase::keep_diary(record::Sight sight, const Nearest& nearest, bool panels) {
  if (options_.diary == nullptr) return;
  // the user is warned by the colour and the mark at the figure, or by the tone
  const bool seen = panels && options_.allowed.distance;
  const bool heard = options_.allowed.tone_below >= kNear && options_.loudspeaker != nullptr &&
                     options_.loudspeaker->is_on();
  if ((seen || heard) && nearest && nearest->distance < (near_.empty() ? kNear : kFarAgain))
    near_ = nearest->name;
  else
    near_.clear();
  sight.near = near_;
  options_.diary->look(sight);
}

MillCase::Done MillCase::declare_done(bool asked) {
  const auto answer = [this](Word says) {
    notes_.note(word(says));
    return Done::answered;
  };
  if (options_.diary == nullptr) return answer(Word::done_not_recorded);
  if (!options_.done_ends) {
    const bool done = !options_.diary->declared_done();
    options_.diary->declare_done(row_.tick, done);
    return answer(done ? Word::done_declared : Word::done_taken_back);
  }
  if (asked) return Done::ends;
  // where nothing was done there is nothing to mark
  if (!(options_.earlier.removed > 0) && row_.ledger.removed <= 0 && row_.ledger.added <= 0)
    return answer(Word::done_nothing);
  return Done::asks;
}

void MillCase::mark_done() { options_.diary->declare_done(row_.tick, true); }

std::size_t MillCase::open_steps() const {
  return steps_offered() && options_.mode != record::Mode::free
             ? steps_.size() - steps_.done_count()
             : 0;
}

}  // namespace burr::app
