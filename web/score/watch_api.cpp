// What the page's third worker calls (pages/mill/watch_worker.js): how near the burr is to what must not be cut, whether it is in it, and
// one sentence about technique; ten times a second or more, so none of it waits for a measurement of a step. All of it is the
// window's own code (window/mill/mill_steps.cpp, mill_status.cpp), with a bone of its own: distances are those before the first cut.
//
//     watch_open(case, mode, voxel_mm), watch_allowed()
//     then: a tick::TickRow into watch_row(), watch_look(heard); watch_step(id) when another step begins
//
// One thread. Texts are JSON, in the module's memory until the next call of the same function.
#include <emscripten.h>

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "burr/base/progress.h"
#include "burr/guidance/injury.h"
#include "burr/guidance/suits.h"
#include "burr/guidance/technique.h"
#include "burr/phantom/phantoms.h"
#include "burr/record/course.h"
#include "burr/record/identity.h"
#include "burr/record/private_text.h"
#include "burr/report/scored.h"
#include "burr/scenario/case.h"
#include "burr/scoring/rubric.h"
#include "burr/tick/rows.h"
#include "burr/words/anatomy.h"
#include "burr/words/words.h"
#include "burr/workshop/allowed.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/spared_distance.h"
#include "work_of_page.h"

namespace {

using namespace burr;
using nlohmann::ordered_json;

constexpr double kNear = 1e-3,
                 kFarAgain = 1.3e-3;  // of what must not be cut, as mill_diary.cpp  [m]

struct Watch {
  scenario::CaseLesson lesson;
  workshop::Allowed allowed;
  workshop::SparedDistance spared;
  double voxel = 0;  // [m]
  const scenario::Step* step = nullptr;
  guidance::InjuryWatch injury;
  guidance::Technique technique;
  double removed_before = 0;
  std::string near;  // the structure that the user is warned of; empty: none
};

std::unique_ptr<Watch> watch;
tick::TickRow newest;
std::string failure, answer;

const char* text_of(const ordered_json& what) {
  answer = what.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return answer.c_str();
}
bool refused(const Error& error) {
  failure = error.text;
  return false;
}

bool open_watch(const char* name, const std::string& mode, double voxel_mm) {
  auto work = scenario::read_case(name);
  if (!work) return refused(work.error());
  const auto rubric = scoring::read_rubric(work->name);
  if (!rubric) return refused(rubric.error());
  auto lesson = report::lesson_for(*work, *rubric);
  if (!lesson) return refused(lesson.error());
  auto made = std::make_unique<Watch>();
  made->lesson = std::move(*lesson);
  made->allowed = workshop::allowed_in(record::mode_of(mode).value_or(record::Mode::free),
                                       made->lesson.feedback, true);
  made->voxel = 1e-3 * voxel_mm;
  NoProgress quiet;
  auto bone = phantom::phantom(work->phantom, voxel_mm, quiet, 0, 1);
  if (!bone) return refused(bone.error());
  auto spared = workshop::SparedDistance::make(
      **bone, workshop::to_spare((*bone)->tissues(), work->spare), quiet);
  if (!spared) return refused(spared.error());
  made->spared = std::move(*spared);
  watch = std::move(made);
  words::take_titles_of(&watch->lesson);
  return true;
}

ordered_json event(record::CourseKind kind, const char* what, const std::string& where) {
  return {{"kind", record::word_of(kind)},
          {"what", what},
          {"where", record::fit_for_a_note(where) ? where : std::string("a structure")}};
}

// As Mill::look_at_technique(). The page has one burr: it does not advise another kind, nor a tool of the rack.
std::string advice(Watch& w, const std::optional<workshop::SparedDistance::Near>& nearest,
                   ordered_json& events) {
  if (!w.allowed.technique) return {};
  guidance::Technique::Moment now;
  now.t = static_cast<double>(newest.tick) / web::kRate;
  now.cutting = newest.contact.touching && newest.spindle_rad_s != 0 &&
                newest.ledger.removed > std::exchange(w.removed_before, newest.ledger.removed);
  now.force = newest.contact.force.norm();
  if (nearest) now.nearest = nearest->distance;
  now.diameter = 2 * newest.tool.radius;
  if (w.step != nullptr) {
    now.tool = w.step->tool;
    if (w.step->kind) now.kind = *w.step->kind;
  }
  using Cue = guidance::Technique::Cue;
  const Cue cue = w.technique.look(now, w.step);
  if (w.technique.fresh())
    events.push_back(
        event(record::CourseKind::help_shown, "technique", guidance::Technique::name(cue)));
  if (cue == Cue::gentler) return words::word(words::Word::cue_gentler);
  return cue != Cue::none && w.step != nullptr
             ? words::say(words::Word::cue_tool, guidance::suits(*w.step))
             : std::string();
}

// As Mill::look_at_injury(): what is said when the burr is stopped.
std::string stop(Watch& w, const std::optional<workshop::SparedDistance::Near>& nearest,
                 ordered_json& events) {
  constexpr double kTurning = 0.05;  // of full speed
  const bool turning = newest.spindle_rad_s > kTurning * newest.tool.full_speed;
  bool begins = false;
  if (nearest)
    begins = w.injury.look(nearest->name, nearest->distance, turning, w.voxel);
  else
    w.injury.nothing_near();
  if (!begins || w.allowed.injury != workshop::Injury::stop) return {};
  events.push_back(event(record::CourseKind::warning, "injury", nearest->name));
  return words::say(words::Word::injury_stop, words::anatomy(nearest->name));
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* watch_why() { return failure.c_str(); }
EMSCRIPTEN_KEEPALIVE int watch_open(const char* name, const char* mode, double voxel_mm) {
  watch.reset();
  return open_watch(name, mode, voxel_mm) ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE void watch_speak(const char* language) { words::speak(language); }

// {distance, far}: whether the figure is shown, and its title while nothing is near.
EMSCRIPTEN_KEEPALIVE const char* watch_allowed() {
  return text_of({{"distance", watch->allowed.distance && !watch->spared.empty()},
                  {"far", words::word(words::Word::nearest_far)}});
}

EMSCRIPTEN_KEEPALIVE void watch_step(const char* id) {
  watch->step = nullptr;
  for (const scenario::Step& step : watch->lesson.steps)
    if (step.id == id) watch->step = &step;
}

EMSCRIPTEN_KEEPALIVE void* watch_row() { return &newest; }

// For tests: a row of a burr that turns at full speed, with its middle here  [m].
EMSCRIPTEN_KEEPALIVE void watch_put(double x, double y, double z, double radius) {
  newest.contact.proxy = math::Vec3(x, y, z);
  newest.tool.radius = radius;
  newest.spindle_rad_s = newest.tool.full_speed = 1000;
}

// heard: the sound is on. {nearest: {title, mm} or null, to_spare [m] or null, injured, stop, advice, events}
EMSCRIPTEN_KEEPALIVE const char* watch_look(int heard) {
  Watch& w = *watch;
  auto nearest = w.spared.nearest(newest.contact.proxy);
  if (nearest) nearest->distance -= newest.tool.radius;
  ordered_json out, events = ordered_json::array();
  out["stop"] = stop(w, nearest, events);
  out["advice"] = advice(w, nearest, events);
  out["injured"] = w.injury.is_in() && w.allowed.injury != workshop::Injury::silent;
  out["nearest"] = nullptr;
  out["to_spare"] = nullptr;
  if (nearest && w.allowed.distance)
    out["nearest"] = {{"title", words::say(words::Word::nearest, words::anatomy(nearest->name))},
                      {"mm", 1e3 * nearest->distance}};
  // as Loudspeaker::update()
  if (nearest && (out["injured"] == true || nearest->distance < w.allowed.tone_below))
    out["to_spare"] = nearest->distance;
  // as Mill's diary: he is warned by the figure, or by the tone
  const bool warned = w.allowed.distance || (heard != 0 && w.allowed.tone_below >= kNear);
  const bool is_near =
      warned && nearest && nearest->distance < (w.near.empty() ? kNear : kFarAgain);
  if (is_near && w.near != nearest->name)
    events.push_back(event(record::CourseKind::warning, "near", nearest->name));
  w.near = is_near ? nearest->name : std::string();
  out["events"] = std::move(events);
  return text_of(out);
}

}  // extern "C"
