#include "window/mill/mill_station.h"

#include <string>
#include <utility>

#include "burr/render/pick.h"
#include "shared/word_names.h"
#include "window/station/station_link.h"

namespace burr::app {

void MillStation::talk() {
  StationLink* link = desk_.station.get();
  if (link == nullptr) return;
  render::Renderer& renderer = desk_.renderer();
  StationLink::Words words;
  words.learner = desk_.station_learner;
  words.work = options_.title;
  words.mode = record::word_of(options_.mode);
  if (case_.steps_offered() && case_.step() != nullptr)
    words.step = case_.step()->title.in(spoken().code);
  words.seconds = static_cast<double>(row_.tick) / session_.settings().servo.rate_hz;
  words.force = row_.contact.force.norm();
  link->is(std::move(words));
  if (link->wants_picture()) {
    Shown shown{link->offer(renderer.shown()), scene_.camera, renderer.width(), renderer.height()};
    shown_[shown.number % shown_.size()] = shown;
  }
  for (StationLink::Message& message : link->news()) {
    const Shown& then = shown_[message.picture % shown_.size()];
    std::optional<render::Hit> hit;
    if (message.mark && then.number == message.picture)
      hit = render::pick(
          scene_, render::ray_through(then.camera, (*message.mark)[0] * then.width,
                                      (*message.mark)[1] * then.height, then.width, then.height));
    if (hit)
      marks_.mark(hit->p, std::move(message.text));
    else
      marks_.say(message.text.empty() ? word(Word::instructor_missed) : std::move(message.text));
  }
  // a line in the window says when the instructor begins to watch
  if (link->watched() != std::exchange(was_watched_, link->watched()) && was_watched_)
    notes_.note(word(Word::instructor_watches));
  if (std::string trouble = link->trouble();
      trouble != std::exchange(trouble_, trouble) && !trouble.empty())
    notes_.note(say(Word::instructor_away, trouble));
}

}  // namespace burr::app
