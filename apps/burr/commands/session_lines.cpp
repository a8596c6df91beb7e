#include "commands/session_lines.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>

#include "burr/base/printable.h"
#include "shared/counted.h"

namespace burr::app {
namespace {

using record::CourseKind;

std::string course_text(const std::vector<record::CourseEvent>& course) {
  std::map<CourseKind, std::size_t> count;
  for (const record::CourseEvent& event : course) ++count[event.kind];
  struct Line {
    CourseKind kind;
    const char *one, *many;
  };
  std::string text;
  for (const Line& line :
       {Line{CourseKind::step_begun, "step begun", "steps begun"},
        Line{CourseKind::step_done, "step done", "steps done"},
        Line{CourseKind::step_reopened, "step reopened", "steps reopened"},
        Line{CourseKind::help_shown, "time help was shown", "times help was shown"},
        Line{CourseKind::warning, "warning", "warnings"},
        Line{CourseKind::question, "question", "questions"},
        Line{CourseKind::pause, "pause", "pauses"},
        Line{CourseKind::complication, "complication", "complications"},
        Line{CourseKind::self_mark, "self-mark", "self-marks"}})
    if (const std::size_t n = count[line.kind]; n > 0)
      text += (text.empty() ? "" : ", ") + counted(n, line.one, line.many);
  return text.empty() ? "no steps, help or warnings" : text;
}

std::string ending_text(const record::Player& player) {
  if (const auto ending = player.ending()) return record::word_of(*ending);
  return player.finished() ? "the recording does not say how" : "cut off";
}

}  // namespace

std::string session_text(record::Player& player) {
  std::string text;
  if (const auto& who = player.info().identity) {
    text += fmt::format("  mode {}, learner {}", record::word_of(who->mode),
                        who->learner.empty() ? "not given" : base::printable(who->learner));
    if (who->attempt > 0) text += fmt::format(", attempt {}", who->attempt);
    text += fmt::format("; labels {}\n", record::hex(who->labels_hash));
    for (const std::string& name : who->accepted_labels)
      text += fmt::format("  the label \"{}\" was accepted in spite of its faults\n",
                          base::printable(name));
  }
  if (const auto& second = player.info().second)
    text +=
        fmt::format("  second hand: {}, {}\n", base::printable(second->device),
                    second->tools.empty() ? "a suction tube that feels the bone"
                                          : "tool " + base::printable(second->tools.front().name));
  for (const record::SessionInfo& part : player.continued())
    text += fmt::format("  left and continued at {:.1f} s\n",
                        static_cast<double>(part.first_tick) / player.info().rate_hz);
  if (player.has_course())
    text += fmt::format("  ended: {}; {}, {}\n", ending_text(player),
                        counted(player.views().size(), "view"), course_text(player.course()));
  if (const std::string lacks = player.lacks(); !lacks.empty()) text += "  note: " + lacks + "\n";
  return text;
}

nlohmann::json session_json(record::Player& player) {
  nlohmann::json out = {
      {"identity", nullptr}, {"shaft", nullptr}, {"ending", nullptr}, {"second_hand", nullptr}};
  if (const auto& second = player.info().second) {
    nlohmann::json& other = out["second_hand"];
    other = {{"device", second->device}, {"tool", nullptr}};
    if (!second->tools.empty()) other["tool"] = second->tools.front().name;
  }
  if (const auto& who = player.info().identity) {
    nlohmann::json& one = out["identity"];
    one = {{"mode", record::word_of(who->mode)},
           {"learner", nullptr},
           {"attempt", who->attempt},
           {"case_hash", record::hex(who->case_hash)},
           {"rubric_hash", record::hex(who->rubric_hash)},
           {"labels_hash", record::hex(who->labels_hash)},
           {"accepted_labels", who->accepted_labels}};
    if (!who->learner.empty()) one["learner"] = who->learner;
  }
  out["continued_at_s"] = nlohmann::json::array();
  for (const record::SessionInfo& part : player.continued())
    out["continued_at_s"].push_back(static_cast<double>(part.first_tick) / player.info().rate_hz);
  if (const auto& shaft = player.info().shaft)
    out["shaft"] = {{"radius_m", shaft->radius}, {"length_m", shaft->length}};
  if (const auto ending = player.ending()) out["ending"] = record::word_of(*ending);
  out["views"] = player.views().size();
  nlohmann::json course = nlohmann::json::array();
  for (const record::CourseEvent& event : player.course())
    course.push_back(nlohmann::json::parse(record::to_json(event)));
  out["course"] = std::move(course);
  out["lacks"] = player.lacks();
  return out;
}

}  // namespace burr::app
