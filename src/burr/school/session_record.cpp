#include "burr/school/session_record.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "burr/record/identity.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> maybe(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return std::nullopt;
  return found->get<double>();
}

Json json_of(const Defined& one) {
  return {{"hash", one.hash},
          {"name", one.name},
          {"version", one.version},
          {"calibrated", one.calibrated},
          {"text", one.text}};
}

Defined defined_of(const Json& json) {
  return {json.at("hash"), json.at("name"), json.at("text"), json.at("version"),
          json.at("calibrated")};
}

Json json_of(const ScoreRecord& score) {
  Json items = Json::array();
  for (const ItemRecord& item : score.items)
    items.push_back({{"id", item.id},
                     {"result", item.result},
                     {"value", json_of(item.value)},
                     {"threshold", json_of(item.threshold)},
                     {"margin", json_of(item.margin)},
                     {"evidence", item.evidence_json}});
  return {{"part", score.part},
          {"total", json_of(score.total)},
          {"gates_broken", score.gates_broken},
          {"assessable_weight", score.assessable_weight},
          {"made_ms", score.made_ms},
          {"items", items}};
}

ScoreRecord score_of(const Json& json) {
  ScoreRecord score;
  score.part = json.at("part");
  score.total = maybe(json, "total");
  score.gates_broken = json.at("gates_broken");
  score.assessable_weight = json.at("assessable_weight");
  score.made_ms = json.at("made_ms");
  for (const Json& one : json.at("items"))
    score.items.push_back({one.at("id"), one.at("result"), maybe(one, "value"),
                           maybe(one, "threshold"), maybe(one, "margin"), one.at("evidence")});
  return score;
}

SessionRecord record_of(const Json& json) {
  SessionRecord record;
  record.learner = json.at("learner");
  record.work_case = defined_of(json.at("case"));
  record.rubric = defined_of(json.at("rubric"));
  record.scored_by = json.at("scored_by");
  record.started_ms = json.at("started_ms");
  record.seconds = json.at("seconds");
  record.mode = json.at("mode");
  record.guided = json.at("guided");
  record.finished = json.at("finished");
  record.attempt = json.at("attempt");
  record.device = json.at("device");
  record.device_max_n = maybe(json, "device_max_n");
  record.voxel_um = json.at("voxel_um");
  record.engine = json.at("engine");
  record.recording_hash = json.at("recording_hash");
  record.recording_uri = json.at("recording_uri");
  record.goes_on_with = json.value("goes_on_with", std::vector<std::string>());
  for (const Json& one : json.at("scores")) record.scores.push_back(score_of(one));
  for (const Json& one : json.at("metrics"))
    record.metrics.push_back({one.at("name"), one.at("unit"), one.at("value")});
  for (const Json& one : json.at("self_marks"))
    record.self_marks.push_back({one.at("item"), one.at("mark")});
  return record;
}

}  // namespace

std::string session_id(const SessionRecord& record) {
  return uuid_of(kBurrSpace, "recording " + record.recording_hash);
}

std::string score_id(const SessionRecord& record, const ScoreRecord& score) {
  return uuid_of(session_id(record),
                 record.rubric.hash + " " + record.scored_by + " " + score.part);
}

std::string to_json(const SessionRecord& record) {
  Json scores = Json::array(), metrics = Json::array(), marks = Json::array();
  for (const ScoreRecord& score : record.scores) scores.push_back(json_of(score));
  for (const MetricRecord& one : record.metrics)
    metrics.push_back({{"name", one.name}, {"unit", one.unit}, {"value", one.value}});
  for (const SelfMarkRecord& one : record.self_marks)
    marks.push_back({{"item", one.item}, {"mark", one.mark}});
  const Json json = {{"learner", record.learner},
                     {"case", json_of(record.work_case)},
                     {"rubric", json_of(record.rubric)},
                     {"scored_by", record.scored_by},
                     {"started_ms", record.started_ms},
                     {"seconds", record.seconds},
                     {"mode", record.mode},
                     {"guided", record.guided},
                     {"finished", record.finished},
                     {"attempt", record.attempt},
                     {"device", record.device},
                     {"device_max_n", json_of(record.device_max_n)},
                     {"voxel_um", record.voxel_um},
                     {"engine", record.engine},
                     {"recording_hash", record.recording_hash},
                     {"recording_uri", record.recording_uri},
                     {"goes_on_with", record.goes_on_with},
                     {"scores", scores},
                     {"metrics", metrics},
                     {"self_marks", marks}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

Result<SessionRecord> session_from_json(std::string_view text, const std::string& where) {
  try {
    SessionRecord record = record_of(Json::parse(text));
    if (!record::check_pseudonym(record.learner) || record.recording_hash.size() != 40)
      return error(fmt::format("{}: is no session of a learner", where));
    return record;
  } catch (const Json::exception&) {
    return error(fmt::format("{}: is no session of a learner, or it is torn", where));
  }
}

}  // namespace burr::school
