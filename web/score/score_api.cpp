// What the page's second worker calls (pages/mill/score_worker.js): the steps of the case while somebody
// cuts, and at the end the questions, the score and the report. All of it is the window's own code.
//
//     score_cases(), score_case(name): the cases that there are, and the bone of one
//     score_open(case, mode, voxel_mm), score_words(), score_begin()
//     then: score_steps(); score_take(changed bricks), score_look(); score_done(), score_choose()
//     at the end: score_questions(); the recording as kFile, score_mark(), score_marks(), score_page()
//
// One thread. Texts are JSON, in the module's memory until the next call of the same function. 0 and
// nullptr: score_why() says why.
#include <emscripten.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/guidance/step_marks.h"
#include "burr/guidance/steps.h"
#include "burr/guidance/suits.h"
#include "burr/phantom/phantoms.h"
#include "burr/record/bone_blob.h"
#include "burr/record/identity.h"
#include "burr/record/session_info.h"
#include "burr/report/make_report.h"
#include "burr/report/questions.h"
#include "burr/report/report_page.h"
#include "burr/report/score_words.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"
#include "burr/scenario/case.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/step_done.h"
#include "burr/scoring/step_target.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/words/anatomy.h"
#include "burr/words/words.h"
#include "burr/workshop/allowed.h"
#include "work_of_page.h"

namespace {

using namespace burr;
using nlohmann::ordered_json;

constexpr const char* kFile = "/burr.mcap";  // in the module's own file system
constexpr std::size_t kReserveBricks = 2048;

struct Course {
  scenario::Case work;
  scenario::CaseLesson lesson;
  record::Mode mode = record::Mode::free;
  workshop::Allowed allowed;
  guidance::Steps steps;
  std::unique_ptr<volume::Bone> before, now;
  std::optional<report::Scored> scored;
  report::ReportSettings settings;
  std::optional<report::Report> report;
};

std::unique_ptr<Course> course;
std::string why, text;
std::vector<std::uint8_t> bone;  // that score_case() was last asked for

const char* as_text(const ordered_json& what) {
  text = what.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return text.c_str();
}

bool failed(const Error& error) {
  why = error.text;
  return false;
}

ordered_json json_of(const guidance::Steps::Events& events) {
  ordered_json all = ordered_json::array();
  for (const guidance::Steps::Event& one : events)
    all.push_back({{"kind", record::word_of(one.kind)}, {"what", one.what}, {"value", one.value}});
  return all;
}

ordered_json json_of(const report::ReportMark& mark) {
  constexpr const char* kTones[] = {"good", "bad", "open", "none"};
  return {{"word", mark.word}, {"tone", kTones[static_cast<std::size_t>(mark.tone)]}};
}

// The page makes it by the same formula (core_api.cpp), or gets it from score_case().
Result<std::unique_ptr<volume::Bone>> bone_of(const scenario::Case& work, double voxel_mm) {
  NoProgress quiet;
  return phantom::phantom(work.phantom, voxel_mm, quiet, kReserveBricks, 1);
}

bool open_case(const char* name, const std::string& mode, double voxel_mm) {
  auto made = std::make_unique<Course>();
  auto work = scenario::read_case(name);
  if (!work) return failed(work.error());
  made->work = std::move(*work);
  const auto rubric = scoring::read_rubric(made->work.name);
  if (!rubric) return failed(rubric.error());
  auto lesson = report::lesson_for(made->work, *rubric);
  if (!lesson) return failed(lesson.error());
  made->lesson = std::move(*lesson);
  made->mode = record::mode_of(mode).value_or(record::Mode::free);
  made->allowed = workshop::allowed_in(made->mode, made->lesson.feedback, true);
  made->steps = guidance::Steps(made->lesson.steps);
  auto before = bone_of(made->work, voxel_mm);
  if (!before) return failed(before.error());
  made->before = std::move(*before);
  made->now = volume::copy_of(*made->before);
  course = std::move(made);
  words::take_titles_of(&course->lesson);
  return true;
}

bool steps_offered() {
  return !course->steps.empty() && course->allowed.steps != workshop::Offer::never;
}

// What the panel of the window says about the current step (window/mill/steps_panel.cpp).
ordered_json json_of_steps() {
  const guidance::Steps& steps = course->steps;
  const auto title_of = [](const scenario::Step& step) {
    const std::string& title = step.title.in(words::spoken().code);
    return title.empty() ? step.id : title;
  };
  ordered_json out;
  constexpr const char* kOffers[] = {"never", "on demand", "always"};
  out["offer"] =
      steps_offered() ? kOffers[static_cast<std::size_t>(course->allowed.steps)] : "never";
  out["back"] = course->allowed.back;
  out["marks"] = course->allowed.marks;
  out["target"] = course->allowed.target && !steps.empty();
  out["open"] =
      steps_offered() && course->mode != record::Mode::free ? steps.size() - steps.done_count() : 0;
  if (const scenario::Step* now = steps.now(); now != nullptr) {
    ordered_json& one = out["now"];
    one["id"] = now->id;
    one["count"] = words::say(words::Word::steps_count, *steps.current() + 1, steps.size());
    one["title"] = title_of(*now);
    one["say"] = now->say.in(words::spoken().code);
    const std::string tool = guidance::suits(*now);
    one["tool"] = tool.empty() ? "" : words::say(words::Word::steps_tool, tool);
    one["spare"] = now->spare.empty()
                       ? ""
                       : words::say(words::Word::task_spare, words::anatomy_list(now->spare));
    one["measured"] = now->done.has_value() && !steps.was_reopened(*steps.current());
  }
  out["rows"] = ordered_json::array();
  for (std::size_t n = 0; n < steps.size(); ++n)
    out["rows"].push_back({{"id", steps[n].id},
                           {"title", title_of(steps[n])},
                           {"done", steps.is_done(n)},
                           {"current", steps.current() == n}});
  return out;
}

ordered_json json_of(const report::ReportItem& item) {
  ordered_json row;
  row["id"] = item.id;
  row["text"] = item.text;
  row["gate"] = item.gate;
  row["harm"] = item.harm;
  row["self"] = json_of(item.self);
  row["machine"] = json_of(item.machine);
  row["figures"] = item.figures;
  row["default"] = item.default_word;
  row["remarks"] = item.remarks;
  row["at_s"] = nullptr;
  if (item.at_s) row["at_s"] = *item.at_s;
  row["at_end"] = item.at_end;
  row["place"] = nullptr;
  if (item.place) row["place"] = {item.place->x(), item.place->y(), item.place->z()};  // [m]
  return row;
}

ordered_json json_of(const report::Report& report) {
  ordered_json out;
  out["title"] = report.title;
  out["unfinished"] = report.unfinished;
  out["self"] = report.self;
  out["has_self"] = report.has_self;
  out["you"] = report.you;
  out["machine"] = report.machine;
  out["head"] = report.head;
  out["gates"] = ordered_json::array();
  for (const report::ReportGate& gate : report.gates)
    out["gates"].push_back(
        {{"text", gate.text}, {"when", gate.when}, {"mark", json_of(gate.mark)}});
  out["held"] = report.safety;
  out["parts"] = ordered_json::array();
  for (const report::ReportPart& part : report.parts) {
    ordered_json one = {{"title", part.title}, {"met", part.met}, {"note", part.note}};
    one["items"] = ordered_json::array();
    for (const report::ReportItem& item : part.items) one["items"].push_back(json_of(item));
    out["parts"].push_back(std::move(one));
  }
  out["next"] = ordered_json::array();
  for (const report::ReportAdvice& advice : report.next)
    out["next"].push_back({{"say", advice.say}, {"why", advice.why}});
  out["nothing_next"] = report.nothing_next;
  out["small"] = report.small;
  return out;
}

// The report in the language that is spoken now.
bool make_report() {
  NoProgress quiet;
  auto report = report::report_on(*course->scored, course->settings, quiet);
  if (!report) return failed(report.error());
  course->report = std::move(*report);
  return true;
}

bool mark_recording() {
  auto judged = report::judged_by(kFile, "");
  if (!judged) return failed(judged.error());
  course->settings = {};
  course->settings.most_pictures = 0;
  course->settings.self = report::recorded_self_marks(*judged->player, judged->rubric);
  NoProgress quiet;
  auto made = report::scored(std::move(*judged), {}, quiet);
  if (!made) return failed(made.error());
  course->scored = std::move(*made);
  return make_report();
}

// A name as the window writes it beside a mark.
std::string text_of(const guidance::StepMark& mark) {
  using words::Word;
  if (mark.name.empty()) return {};
  const std::string name = words::place_name(mark.name);
  switch (mark.kind) {
    case guidance::MarkKind::target:
      return words::say(Word::mark_target, name);
    case guidance::MarkKind::plane:
      return words::say(Word::mark_plane, name);
    case guidance::MarkKind::spare:
      return words::say(Word::mark_spare, name);
    case guidance::MarkKind::place:
      break;
  }
  return name;
}

ordered_json json_of(const math::Vec3& p) { return {p.x(), p.y(), p.z()}; }

ordered_json json_of(guidance::MarkKind kind, const std::vector<volume::TissueId>& tissues) {
  const guidance::MarkColour colour = guidance::colour_of(kind);
  return {{"ids", tissues}, {"colour", {colour.red, colour.green, colour.blue}}};
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* score_why() { return why.c_str(); }

// The built-in cases: [{name, title, voxel_mm}], that of the page first.
EMSCRIPTEN_KEEPALIVE const char* score_cases() {
  ordered_json out = ordered_json::array();
  for (const std::string& name : scenario::built_in_cases()) {
    const auto work = scenario::read_case(name);
    const auto rubric = scoring::read_rubric(name);
    if (!work || !rubric) continue;
    const auto lesson = report::lesson_for(*work, *rubric);
    const std::string title = lesson ? lesson->title.in(words::spoken().code) : std::string();
    ordered_json one = {{"name", name},
                        {"title", title.empty() ? work->title : title},
                        {"voxel_mm", scenario::voxel_mm(*work)}};
    if (name == web::kCase)
      out.insert(out.begin(), std::move(one));
    else
      out.push_back(std::move(one));
  }
  return as_text(out);
}

// What a worker needs to begin with a case (web/case.py writes the same of the page's), and its bone: score_bone().
EMSCRIPTEN_KEEPALIVE const char* score_case(const char* name, double voxel_mm) {
  const auto work = scenario::read_case(name);
  if (!work) {
    failed(work.error());
    return nullptr;
  }
  const auto rubric = scoring::read_rubric(work->name);
  if (!rubric) {
    failed(rubric.error());
    return nullptr;
  }
  const double voxel = voxel_mm > 0 ? voxel_mm : scenario::voxel_mm(*work);
  auto made = bone_of(*work, voxel);
  if (!made) {
    failed(made.error());
    return nullptr;
  }
  bone = record::bone_to_blob(**made);
  ordered_json out = {{"name", work->name}, {"text", work->text}};
  out["rubric_hash"] = record::hex(rubric->text_hash).substr(2);
  out["phantom"] = "phantom:" + work->phantom;
  out["spare"] = work->spare;
  out["targets"] = ordered_json::array();
  for (const scenario::Target& one : work->targets)
    out["targets"].push_back(
        {{"tissue", one.tissue}, {"goal", scenario::word_of(one.goal)}, {"share", one.share}});
  out["voxel_mm"] = voxel;
  out["burr_mm"] = scenario::burr_mm(*work);
  out["diamond"] = work->burr.kind == tool::BurrKind::diamond;
  out["rpm"] = scenario::rpm(*work);
  const math::Vec3 at = work->at.value_or(math::Vec3::Zero());
  const math::Vec3 into = work->into.value_or(math::Vec3(0, 0, -1));
  out["at"] = {at.x(), at.y(), at.z()};
  out["into"] = {into.x(), into.y(), into.z()};
  return as_text(out);
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* score_bone() { return bone.data(); }
EMSCRIPTEN_KEEPALIVE int score_bone_size() { return static_cast<int>(bone.size()); }

// The case on its bone, before the first cut.
EMSCRIPTEN_KEEPALIVE int score_open(const char* name, const char* mode, double voxel_mm) {
  course.reset();
  return open_case(name, mode, voxel_mm) ? 1 : 0;
}

EMSCRIPTEN_KEEPALIVE void score_speak(const char* language) { words::speak(language); }

// The texts of the window that begin with one of these: {key: text}.
EMSCRIPTEN_KEEPALIVE const char* score_words() {
  constexpr const char* kKeys[] = {
#define BURR_WORD(key) #key,
#include "burr/words/word_keys.h"
#undef BURR_WORD
  };
  constexpr std::string_view kWanted[] = {"steps_",  "done_",    "self_",      "review_",
                                          "report_", "refused_", "exam_begins"};
  ordered_json out;
  for (std::size_t n = 0; n < std::size(kKeys); ++n)
    if (std::any_of(std::begin(kWanted), std::end(kWanted), [&](std::string_view start) {
          return std::string_view(kKeys[n]).starts_with(start);
        }))
      out[kKeys[n]] = words::word(static_cast<words::Word>(n));
  return as_text(out);
}

EMSCRIPTEN_KEEPALIVE const char* score_steps() { return as_text(json_of_steps()); }

// These three give what is to be written into the recording.
EMSCRIPTEN_KEEPALIVE const char* score_begin() {
  return as_text(json_of(steps_offered() ? course->steps.begin() : guidance::Steps::Events{}));
}
EMSCRIPTEN_KEEPALIVE const char* score_done(int measured) {
  return as_text(json_of(steps_offered() ? course->steps.declare_done(measured != 0)
                                         : guidance::Steps::Events{}));
}
EMSCRIPTEN_KEEPALIVE const char* score_choose(int n) {
  return as_text(json_of(steps_offered() ? course->steps.choose(static_cast<std::size_t>(n))
                                         : guidance::Steps::Events{}));
}

// What the current step is about, to be shown: {step, marks: [{kind, at [m], radius [m], text}], lines: [[a, b]], tissues:
// [{ids, colour}]}; null: nothing may be.
EMSCRIPTEN_KEEPALIVE const char* score_light() {
  const scenario::Step* now = course->steps.now();
  if (now == nullptr || !course->allowed.target) return as_text(nullptr);
  ordered_json out = {{"step", course->steps.id(*course->steps.current())}};
  NoProgress quiet;
  scoring::TargetFinder finder(*course->before, course->lesson, quiet);
  constexpr double kAnyBurr = 1e-3;  // its room is not asked for
  const auto target = finder.find(*now, *course->now, kAnyBurr);
  const guidance::StepMarks marks =
      guidance::marks_of(*now, course->lesson, course->now->tissues(), target ? &*target : nullptr);
  out["marks"] = ordered_json::array();
  for (const guidance::StepMark& mark : marks.marks)
    out["marks"].push_back({{"kind", guidance::word_of(mark.kind)},
                            {"at", json_of(mark.at)},
                            {"radius", mark.radius},
                            {"text", text_of(mark)}});
  out["lines"] = ordered_json::array();
  for (const auto& line : marks.outline)
    out["lines"].push_back({json_of(line[0]), json_of(line[1])});
  out["tissues"] = {json_of(guidance::MarkKind::target, marks.target),
                    json_of(guidance::MarkKind::spare, marks.spare)};
  return as_text(out);
}

// Bricks that have changed, one after the other: core_api.cpp's Changed.
EMSCRIPTEN_KEEPALIVE void score_take(const std::uint8_t* bytes, int count) {
  volume::Bone& now = *course->now;
  for (int n = 0; n < count; ++n, bytes += sizeof(web::ChangedBrick)) {
    web::ChangedBrick one;
    std::memcpy(&one, bytes, sizeof one);
    if (one.brick < 0 || one.brick >= now.brick_count()) continue;
    if (now.ensure_slot(one.brick) == volume::kNoSlot) continue;
    volume::BrickField field;
    std::copy(std::begin(one.field), std::end(one.field), field.voxel);
    now.write_brick(one.brick, field);
  }
  now.commit_ahead();
}

// 1: the current step has reached its measure.
EMSCRIPTEN_KEEPALIVE int score_look() {
  const auto current = course->steps.current();
  if (!current || course->steps.was_reopened(*current)) return 0;
  NoProgress quiet;
  const auto reached = scoring::step_done(course->steps[*current], course->lesson, *course->before,
                                          *course->now, quiet);
  return reached && *reached ? 1 : 0;
}

EMSCRIPTEN_KEEPALIVE const char* score_questions() {
  ordered_json out = ordered_json::array();
  for (const report::QuestionPart& part : report::questions_on(course->work)) {
    ordered_json one = {{"title", part.title}, {"items", ordered_json::array()}};
    for (const report::Question& item : part.items)
      one["items"].push_back({{"id", item.id}, {"text", item.text}, {"gate", item.gate}});
    out.push_back(std::move(one));
  }
  return as_text(out);
}

// Scores the recording kFile. It takes seconds.
EMSCRIPTEN_KEEPALIVE int score_mark() { return mark_recording() ? 1 : 0; }

// {report, score}: what the page shows, and what `burr score --json` says.
EMSCRIPTEN_KEEPALIVE const char* score_marks() {
  if (!make_report()) return nullptr;
  ordered_json out;
  out["report"] = json_of(*course->report);
  out["score"] =
      ordered_json::parse(report::score_json(course->scored->judged.rubric, course->scored->score));
  return as_text(out);
}

// The report as one HTML page, with a picture of the bone at the end.
EMSCRIPTEN_KEEPALIVE const char* score_page(const char* png, int bytes, int width, int height,
                                            const char* caption) {
  if (!make_report()) return nullptr;
  report::Report& report = *course->report;
  if (bytes > 0) {
    report.sides_legend.clear();  // the picture is in the bone's own colours
    report::ReportSides& side = report.sides.emplace_back();
    side.pictures.push_back(
        {std::string(png, static_cast<std::size_t>(bytes)), caption, width, height});
  }
  text = report::page_of(report);
  return text.c_str();
}

}  // extern "C"
