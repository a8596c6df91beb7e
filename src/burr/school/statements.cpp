#include "burr/school/statements.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/school/uuid.h"

namespace burr::school {
namespace {

using Json = nlohmann::ordered_json;

std::string key(const char* name) { return std::string(kProfile) + "/" + name; }

Json verb(const char* name) {
  return {{"id", std::string("http://adlnet.gov/expapi/verbs/") + name},
          {"display", {{"en", name}}}};
}

Json agent(const std::string& home_page, const std::string& name) {
  return {{"objectType", "Agent"}, {"account", {{"homePage", home_page}, {"name", name}}}};
}

Json activity(const std::string& case_name) {
  return {{"objectType", "Activity"},
          {"id", activity_of(case_name)},
          {"definition",
           {{"type", "http://adlnet.gov/expapi/activities/simulation"},
            {"name", {{"en", case_name.empty() ? "a case without a name" : case_name}}}}}};
}

Json context(const std::string& session) {
  return {{"registration", session},
          {"platform", "burr"},
          {"contextActivities",
           {{"category",
             {{{"id", kProfile},
               {"definition", {{"type", "http://adlnet.gov/expapi/activities/profile"}}}}}}}}};
}

Statement finished(Json statement) {
  std::string id = statement["id"];
  return {std::move(id), statement.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Json base(const SessionRecord& record, const std::string& home_page, const char* name,
          const std::string& step, double at_s) {
  const std::string session = session_id(record);
  return {{"id", uuid_of(session, step.empty() ? name : std::string(name) + " " + step)},
          {"actor", agent(home_page, record.learner)},
          {"verb", verb(name)},
          {"object", activity(record.work_case.name)},
          {"context", context(session)},
          {"timestamp", iso_time(record.started_ms + std::llround(1000 * at_s))}};
}

bool is_uuid(const std::string& text) {
  if (text.size() != 36) return false;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool hyphen = n == 8 || n == 13 || n == 18 || n == 23;
    if (hyphen ? text[n] != '-' : std::isxdigit(static_cast<unsigned char>(text[n])) == 0)
      return false;
  }
  return true;
}

struct Step {
  std::string id;
  double at = 0;  // [s]
};
std::vector<Step> steps_of(const SessionRecord& record) {
  std::vector<Step> steps;
  for (const MetricRecord& one : record.metrics)
    if (one.name.rfind(kStepDone, 0) == 0)
      steps.push_back({one.name.substr(kStepDone.size()), one.value});
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.at < b.at; });
  return steps;
}

Json extensions(const SessionRecord& record) {
  Json out = {{key("guided"), record.guided},      {key("mode"), record.mode},
              {key("rubric"), record.rubric.name}, {key("rubric-hash"), record.rubric.hash},
              {key("engine"), record.engine},      {key("attempt"), record.attempt}};
  for (const ScoreRecord& score : record.scores) {
    if (score.total) out[key((score.part + "-points").c_str())] = *score.total;
    out[key((score.part + "-gates-broken").c_str())] = score.gates_broken;
  }
  return out;
}

Json score_of(const SessionRecord& record) {
  for (const ScoreRecord& score : record.scores)
    if (score.part == "product" && score.total) {
      const double points = std::clamp(*score.total, 0.0, 100.0);
      return {{"scaled", points / 100}, {"raw", points}, {"min", 0}, {"max", 100}};
    }
  return nullptr;
}

}  // namespace

std::string iso_time(std::int64_t ms) {
  const std::int64_t part = (ms % 1000 + 1000) % 1000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(static_cast<std::time_t>((ms - part) / 1000)), part);
}

std::string iso_duration(double seconds) {
  // two decimals: a store may keep no more
  return fmt::format("PT{:.2f}S", std::isfinite(seconds) && seconds > 0 ? seconds : 0.0);
}

std::string activity_of(const std::string& case_name) {
  std::string out = std::string(kProfile) + "/cases/";
  if (case_name.empty()) return out + "unnamed";
  for (const char c : case_name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '-' || c == '_';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::vector<Statement> statements_of(const SessionRecord& record, const std::string& home_page) {
  std::vector<Statement> out;
  out.push_back(finished(base(record, home_page, "initialized", "", 0)));
  double before = 0;
  for (const Step& step : steps_of(record)) {
    Json one = base(record, home_page, "progressed", step.id, step.at);
    // no score here: the specification wants none on progress
    one["result"] = {{"duration", iso_duration(step.at - before)},
                     {"extensions", {{key("step"), step.id}}}};
    before = step.at;
    out.push_back(finished(std::move(one)));
  }
  Json last = base(record, home_page, record.finished ? "completed" : "exited", "", record.seconds);
  last["result"] = {{"completion", record.finished},
                    {"duration", iso_duration(record.seconds)},
                    {"extensions", extensions(record)}};
  if (Json score = score_of(record); record.finished && !score.is_null())
    last["result"]["score"] = std::move(score);
  out.push_back(finished(std::move(last)));
  return out;
}

std::optional<Statement> statement_of(const Decided& decision, const std::string& case_name,
                                      const std::string& home_page) {
  const bool pass = decision.outcome == "pass", fail = decision.outcome == "fail";
  if (decision.confirmed_by.empty() || decision.sessions.empty() || (!pass && !fail))
    return std::nullopt;
  if (!is_uuid(decision.sessions.back())) return std::nullopt;  // no session of burr's
  const std::string& session = decision.sessions.back();
  const char* name = pass ? "passed" : "failed";
  return finished(
      {{"id", uuid_of(session, fmt::format("{} {} {}", name, decision.standard, decision.made_ms))},
       {"actor", agent(home_page, decision.learner)},
       {"verb", verb(name)},
       {"object", activity(case_name)},
       {"result",
        {{"success", pass},
         {"extensions",
          {{key("standard"), decision.standard},
           {key("sessions"), decision.sessions},
           {key("decided-by"), "a person"}}}}},
       {"context", context(session)},
       {"timestamp", iso_time(decision.made_ms)}});
}

Statement voiding(const std::string& id, const std::string& home_page) {
  return finished({{"id", uuid_of(id, "voided")},
                   {"actor", agent(home_page, "burr")},
                   {"verb", verb("voided")},
                   {"object", {{"objectType", "StatementRef"}, {"id", id}}}});
}

}  // namespace burr::school
