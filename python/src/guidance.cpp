// What burr offers and warns of in a mode of a session: the table that the program's window follows.
// There are no fixtures that push the hand.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "burr/record/identity.h"
#include "burr/scenario/open_lesson.h"
#include "burr/sound/synth.h"
#include "burr/workshop/allowed.h"
#include "common.h"
#include "scene_setup.h"

namespace burr::python {
namespace {

using namespace py::literals;

const char* word_of(workshop::Offer offer) {
  switch (offer) {
    case workshop::Offer::never:
      break;
    case workshop::Offer::on_demand:
      return "on_demand";
    case workshop::Offer::always:
      return "always";
  }
  return "never";
}

const char* word_of(workshop::Injury injury) {
  switch (injury) {
    case workshop::Injury::silent:
      break;
    case workshop::Injury::sound:
      return "sound";
    case workshop::Injury::stop:
      return "stop";
  }
  return "silent";
}

py::dict allowed(const SceneSetup& scene, const std::string& mode, std::uint32_t attempt) {
  record::Identity identity;
  const auto known = record::mode_of(mode);
  if (!known)
    raise(fmt::format("mode \"{}\" is not known; use free, learn, practise or exam", mode));
  identity.mode = *known;
  identity.attempt = attempt;
  scenario::Feedback feedback;
  if (scene.work) feedback = take(scenario::lesson_of(*scene.work)).feedback;
  const workshop::Allowed all =
      workshop::allowed_in(identity.mode, feedback, workshop::guided_in(identity, feedback));
  return py::dict(
      "steps"_a = word_of(all.steps), "target"_a = all.target, "distance"_a = all.distance,
      "tone_below_mm"_a = 1e3 * std::min(all.tone_below, sound::SynthSettings{}.warn_from),
      "injury"_a = word_of(all.injury), "technique"_a = all.technique, "back"_a = all.back,
      "measure"_a = all.measure, "colours"_a = all.colours, "see_through"_a = all.see_through,
      "marks"_a = all.marks);
}

}  // namespace

void add_guidance(py::class_<SceneSetup>& scene) {
  scene.def("allowed", &allowed, "mode"_a = "free", py::kw_only(), "attempt"_a = 0,
            "What the program offers and warns of in this mode (docs/use/window_steps.md).");
}

}  // namespace burr::python
