#include "burr/record/course.h"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/record/private_text.h"

namespace burr::record {
namespace {

using nlohmann::json;

constexpr std::array kKinds = {
    std::pair{CourseKind::step_begun, "step_begun"},
    std::pair{CourseKind::step_done, "step_done"},
    std::pair{CourseKind::step_reopened, "step_reopened"},
    std::pair{CourseKind::help_shown, "help_shown"},
    std::pair{CourseKind::help_hidden, "help_hidden"},
    std::pair{CourseKind::warning, "warning"},
    std::pair{CourseKind::question, "question"},
    std::pair{CourseKind::answer, "answer"},
    std::pair{CourseKind::pause, "pause"},
    std::pair{CourseKind::resume, "resume"},
    std::pair{CourseKind::complication, "complication"},
    std::pair{CourseKind::self_mark, "self_mark"},
    std::pair{CourseKind::done, "done"},
    std::pair{CourseKind::reopened, "reopened"},
    std::pair{CourseKind::ended, "ended"},
    std::pair{CourseKind::continued, "continued"},
};
constexpr std::array kEndings = {std::pair{Ending::declared_done, "declared done"},
                                 std::pair{Ending::time_up, "time up"},
                                 std::pair{Ending::broke_off, "broke off"}};

std::string text_of(const json& object, const char* name) {
  const auto at = object.find(name);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace

const char* word_of(CourseKind kind) {
  for (const auto& [each, word] : kKinds)
    if (each == kind) return word;
  return "";
}

const char* word_of(Ending ending) {
  for (const auto& [each, word] : kEndings)
    if (each == ending) return word;
  return "";
}

std::optional<Ending> ending_of(std::string_view word) {
  for (const auto& [ending, each] : kEndings)
    if (word == each) return ending;
  return std::nullopt;
}

Status check(const CourseEvent& event) {
  for (const std::string* text : {&event.what, &event.where, &event.value})
    if (!fit_for_a_note(*text))
      return error(Trouble::internal,
                   fmt::format("recording: a text of the event {} is too long, or looks like a "
                               "path, a UID or an address, which must not be recorded",
                               word_of(event.kind)));
  if (event.kind == CourseKind::ended && !ending_of(event.value))
    return error(Trouble::internal, "recording: an end must say how the session ended");
  return fine();
}

std::string to_json(const CourseEvent& event) {
  json object = {{"tick", event.tick}, {"event", word_of(event.kind)}};
  if (!event.what.empty()) object["what"] = event.what;
  if (!event.where.empty()) object["where"] = event.where;
  if (!event.value.empty()) object["value"] = event.value;
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool course_from_json(std::string_view text, CourseEvent& event) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return false;
  const auto tick = object.find("tick");
  if (tick == object.end() || !tick->is_number_unsigned()) return false;
  CourseEvent read;
  read.tick = tick->get<std::uint64_t>();
  read.what = text_of(object, "what");
  read.where = text_of(object, "where");
  read.value = text_of(object, "value");
  const std::string name = text_of(object, "event");
  for (const auto& [kind, word] : kKinds)
    if (name == word) {
      read.kind = kind;
      if (!check(read)) return false;
      event = std::move(read);
      return true;
    }
  return false;
}

std::string course_schema() {
  json kinds = json::array(), endings = json::array();
  for (const auto& [kind, word] : kKinds) kinds.push_back(word);
  for (const auto& [ending, word] : kEndings) endings.push_back(word);
  const json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "burr.Course"},
      {"description", "What happened in the session besides milling."},
      {"type", "object"},
      {"properties",
       {{"tick", {{"type", "integer"}}},
        {"event", {{"enum", kinds}}},
        {"what", {{"type", "string"}, {"description", "id of a step, item or question; help"}}},
        {"where", {{"type", "string"}, {"description", "structure or panel"}}},
        {"value",
         {{"type", "string"},
          {"description", "answer; met, unmet, unknown; of ended: " + endings.dump()}}}}}};
  return schema.dump(1);
}

}  // namespace burr::record
