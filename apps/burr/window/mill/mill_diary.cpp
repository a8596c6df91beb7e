// What the recording keeps of the page: what the user saw, which help was on, pauses and the end.
#include "burr/record/diary.h"
#include "burr/render/stereo.h"
#include "burr/workshop/seen.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {
namespace {

constexpr double kNear = 1e-3, kFarAgain = 1.3e-3;  // of what must not be cut  [m]

}  // namespace

void Mill::keep_diary() {
  if (options_.diary == nullptr || !ticks_.begun()) return;
  record::Sight sight;
  const render::Camera* worn = headset_.cameras();
  sight.view = worn != nullptr ? workshop::view_of(worn[0], worn[1], row_.tick)
                               : workshop::view_of(scene_.camera, row_.tick);
  sight.view.see_through = 1 - scene_.look.opacity;
  sight.view.colours = labels_;
  sight.view.slices = slices_shown_ && panels_;
  sight.view.panels = panels_;
  sight.view.two_eyes = worn != nullptr || desk_.settings.stereo != render::Stereo::off;

  if (labels_) sight.helps.insert("labels");
  if (sight.view.slices) sight.helps.insert("slices");
  if (scene_.look.opacity < 1) sight.helps.insert("see-through");
  if (leaf_ == Leaf::task && panels_ && options_.work_case) sight.helps.insert("task");
  if (leaf_ == Leaf::steps && panels_ && steps_offered()) sight.helps.insert("steps");
  if (panels_ && (leaf_ == Leaf::structures || !pins_.empty())) sight.helps.insert("names");
  if (!notes_.empty()) sight.helps.insert("instructor");
  // the user is warned by the colour and the mark at the figure, or by the tone
  const bool seen = panels_ && options_.allowed.distance;
  const bool heard = options_.allowed.tone_below >= kNear && options_.loudspeaker != nullptr &&
                     options_.loudspeaker->is_on();
  if ((seen || heard) && nearest_ && nearest_->distance < (near_.empty() ? kNear : kFarAgain))
    near_ = nearest_->name;
  else
    near_.clear();
  sight.near = near_;
  if (page_open()) sight.paused = "page";
  if (lifts_.stopped) sight.paused = "stopped";
  options_.diary->look(sight);
}

void Mill::declare_done() {
  if (options_.diary == nullptr) return note(word(Word::done_not_recorded));
  if (options_.done_ends) {
    if (pages_->asks_done()) return end_as_done();
    // where nothing was done there is nothing to mark
    if (row_.ledger.removed <= 0 && row_.ledger.added <= 0) return note(word(Word::done_nothing));
    lift();
    return pages_->ask_done();
  }
  const bool done = !options_.diary->declared_done();
  options_.diary->declare_done(row_.tick, done);
  note(word(done ? Word::done_declared : Word::done_taken_back));
}

void Mill::end_as_done() {
  options_.diary->declare_done(row_.tick, true);
  closed_ = Closed::done;
  open_ = false;
}

// An exam shows no steps, so nobody is reminded of them.
std::size_t Mill::open_steps() const {
  return steps_offered() && options_.mode != record::Mode::free
             ? steps_.size() - steps_.done_count()
             : 0;
}

void Mill::end_diary() {
  if (options_.diary == nullptr) return;
  static_cast<void>(session_.view(row_));
  options_.diary->end(row_.tick, time_over_ ? record::Ending::time_up : record::Ending::broke_off);
}

}  // namespace burr::app
