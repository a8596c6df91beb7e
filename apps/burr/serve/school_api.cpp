#include "serve/school_api.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/version.h"
#include "burr/school/export.h"
#include "burr/school/practice.h"
#include "burr/school/sessions.h"
#include "burr/school/study/curve.h"
#include "burr/scoring/measure_list.h"
#include "burr/scoring/rubric.h"
#include "school/practice_words.h"
#include "shared/front_words.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;
using net::Request;
using net::Response;
using school::Store;

constexpr std::size_t kMostOthers = 40;  // sessions to compare with
constexpr std::size_t kMostAudit = 500;

Response answer(const Json& content) {
  Response out;
  out.body = json_line(content);
  return out;
}

Response trouble(const Error& error) {
  return net::refusal(error.trouble == Trouble::io ? 503 : 500, error.text);
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json or_null(const std::optional<std::int64_t>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json parts_of(const std::vector<school::ScoreRow>& scores) {
  Json out = Json::object();
  for (const school::ScoreRow& score : scores)  // the newest first
    if (!out.contains(score.part))
      out[score.part] = {{"met", score.met},
                         {"assessable", score.assessable},
                         {"items", score.items},
                         {"gates", score.gates_broken},
                         {"total", or_null(score.total)}};
  return out;
}

Json brief(const school::SessionRow& session) {
  return {{"id", session.id},
          {"learner", session.learner},
          {"case", session.case_name},
          {"started_ms", session.started_ms},
          {"attempt", session.attempt},
          {"mode", session.mode},
          {"seconds", session.seconds},
          {"guided", session.guided},
          {"finished", session.finished},
          {"sealed", session.sealed()}};
}

// ---- views

Response overview_of(Store& store, school::PracticeMemo& memo) {
  // the page is open for days
  if (const Status looked = store.look_again(); !looked) return trouble(looked.error());
  const auto learners = school::learners(store, false);
  if (!learners) return trouble(learners.error());
  const auto cohorts = school::cohorts(store);
  if (!cohorts) return trouble(cohorts.error());
  const auto cases = store.database().rows("SELECT DISTINCT name FROM case_def ORDER BY name");
  if (!cases) return trouble(cases.error());
  Json out = {{"version", base::version()},
              {"read_only", store.reads_only()},
              {"notices", in_options(store.notices())},
              {"cases", Json::array()},
              {"cohorts", Json::array()},
              {"learners", Json::array()}};
  for (const school::Row& row : *cases) out["cases"].push_back(school::text(row[0]));
  for (const school::Cohort& one : *cohorts)
    out["cohorts"].push_back(
        {{"id", one.id}, {"title", one.title}, {"members", one.members.size()}});
  const auto practice = school::practice(store, "", &memo);
  if (!practice) return trouble(practice.error());
  const std::int64_t today = school::day_here(school::now_ms());
  std::map<std::string, Json> again;  // of the case that was practised last
  for (const school::LearnerPractice& one : *practice)
    again[one.learner] = practice_json(one.cases.front(), today);
  for (const school::LearnerRow& one : *learners)
    out["learners"].push_back({{"id", one.learner.id},
                               {"level", one.learner.level},
                               {"sessions", one.sessions},
                               {"unguided", one.unguided},
                               {"last_ms", or_null(one.last_ms)},
                               {"practice", std::move(again[one.learner.id])}});
  return answer(out);
}

// The hash of the rubric with which a session of this case was scored last.
std::string rubric_of_case(Store& store, const std::string& case_name) {
  const auto rows = store.database().rows(
      "SELECT score.rubric_hash FROM score JOIN session ON session.id = score.session_id JOIN "
      "case_def ON case_def.hash = "
      "session.case_hash WHERE case_def.name = $1 ORDER BY score.made_ms DESC LIMIT 1",
      {case_name});
  return !rows || rows->empty() ? std::string() : school::text((*rows)[0][0]);
}

Response cohort(Store& store, const Request& request, school::PracticeMemo& memo) {
  const auto all = school::cohorts(store);
  if (!all) return trouble(all.error());
  const auto found = std::find_if(all->begin(), all->end(), [&](const school::Cohort& one) {
    return one.id == request.asked("id");
  });
  if (found == all->end()) return net::refusal(404, "there is no such cohort");
  const std::string case_name = request.asked("case");
  const auto cells = school::items_of_cohort(store, found->id, case_name);
  if (!cells) return trouble(cells.error());
  Json out = {{"title", found->title},  {"members", found->members}, {"items", Json::array()},
              {"cells", Json::array()}, {"shares", Json::array()},   {"practice", Json::array()}};
  auto words = words_of(store, rubric_of_case(store, case_name));
  std::set<std::string> items;
  for (const school::Cell& cell : *cells) {
    if (items.insert(cell.item).second)
      out["items"].push_back({{"id", cell.item}, {"say", words[cell.item]}});
    out["cells"].push_back({{"learner", cell.learner},
                            {"item", cell.item},
                            {"met", cell.met},
                            {"assessable", cell.assessable}});
  }
  for (const school::ItemShare& one : school::shares(*cells))
    out["shares"].push_back(
        {{"item", one.item}, {"people", one.people}, {"share", or_null(one.share_met)}});
  const auto practice = school::practice(store, "", &memo);
  if (!practice) return trouble(practice.error());
  const std::set<std::string> members(found->members.begin(), found->members.end());
  const std::int64_t today = school::day_here(school::now_ms());
  for (const school::LearnerPractice& one : *practice)
    for (const school::CasePractice& of : one.cases)
      if (of.case_name == case_name && members.contains(one.learner)) {
        out["practice"].push_back(practice_json(of, today));
        out["practice"].back()["learner"] = one.learner;
      }
  return answer(out);
}

// The share of the assessable items that was met [0..1]; null: none was assessable.
Json share_met(const Json& parts, const char* part) {
  if (!parts.contains(part)) return nullptr;
  const double of = parts[part]["assessable"];
  return of > 0 ? Json(parts[part]["met"].get<double>() / of) : Json(nullptr);
}

Json curve_of(const std::vector<school::study::Attempt>& attempts) {
  const school::study::Curve curve = school::study::fit_curve(attempts);
  if (curve.kind == school::study::CurveKind::points) return nullptr;
  int last = 1;
  for (const auto& attempt : attempts) last = std::max(last, attempt.number);
  last = std::min(last, 200);
  Json out = {{"a", curve.a},
              {"n90", or_null(curve.n90)},
              {"line", Json::array()},
              {"band", Json::array()}};
  for (int n = 1; n <= last; ++n) out["line"].push_back(curve.at(n));
  for (const auto& at : school::study::band(attempts, curve, last))
    out["band"].push_back({at.low, at.high});
  return out;
}

Response learner(Store& store, const Request& request, school::PracticeMemo& memo) {
  const std::string id = request.asked("id");
  const auto there = store.database().rows("SELECT level FROM learner WHERE id = $1", {id});
  if (!there) return trouble(there.error());
  if (there->empty()) return net::refusal(404, "there is no such learner");
  const auto sessions = school::sessions_of(store, id);
  if (!sessions) return trouble(sessions.error());
  Json out = {{"id", id},
              {"level", school::text((*there)[0][0])},
              {"cases", Json::array()},
              {"practice", Json::array()},
              {"sessions", Json::array()}};
  const auto practice = school::practice(store, id, &memo);
  if (!practice) return trouble(practice.error());
  for (const school::LearnerPractice& one : *practice)
    for (const school::CasePractice& of : one.cases)
      out["practice"].push_back(practice_json(of, school::day_here(school::now_ms())));
  std::map<std::string, Json> cases;
  for (const school::SessionRow& session : *sessions) {
    const auto scores = school::scores_of(store, session.id);
    if (!scores) return trouble(scores.error());
    Json one = brief(session);
    one["parts"] = parts_of(*scores);
    if (!one["parts"].empty())
      cases[session.case_name].push_back({{"attempt", session.attempt},
                                          {"guided", session.guided},
                                          {"finished", session.finished},
                                          {"product", share_met(one["parts"], "product")},
                                          {"process", share_met(one["parts"], "process")}});
    out["sessions"].push_back(std::move(one));
  }
  std::reverse(out["sessions"].begin(), out["sessions"].end());  // the newest first
  for (auto& [name, points] : cases) {
    Json one = {{"name", name}, {"unguided", 0}, {"points", points}, {"curves", Json::object()}};
    for (const char* part : {"product", "process"}) {
      std::vector<school::study::Attempt> attempts;
      for (const Json& point : points)
        if (!point[part].is_null() && point["finished"].get<bool>())
          attempts.push_back(
              {point["attempt"], "", 100 * point[part].get<double>(), point["guided"]});
      one["curves"][part] = curve_of(attempts);
    }
    one["unguided"] = std::count_if(points.begin(), points.end(), [](const Json& point) {
      return !point["guided"].get<bool>() && point["finished"].get<bool>();
    });
    out["cases"].push_back(std::move(one));
  }
  return answer(out);
}

// "0.84 mm" where the measure is known.
Json shown(const Json& evidence, const std::optional<double>& value) {
  if (!value) return nullptr;
  const scoring::Measure* measure =
      scoring::measure_named(evidence.value("measure", std::string()));
  return measure != nullptr ? Json(scoring::text_of(measure->quantity, *value)) : Json(*value);
}

Json item_of(const school::ItemRow& item, std::map<std::string, Json>& words, int& calibrated) {
  const Json evidence = Json::parse(item.evidence_json, nullptr, false);
  Json out = {{"id", item.id},         {"part", item.part},      {"say", words[item.id]},
              {"result", item.result}, {"self", item.self_mark}, {"evidence", Json::array()}};
  if (!evidence.is_object()) return out;
  out["value"] = shown(evidence, item.value);
  out["threshold"] = item.threshold ? Json((evidence.value("at_least", true) ? "≥ " : "≤ ") +
                                           (shown(evidence, item.threshold).is_string()
                                                ? shown(evidence, item.threshold).get<std::string>()
                                                : fmt::format("{:.3g}", *item.threshold)))
                                    : Json(nullptr);
  const bool gate = evidence.value("gate", false);
  out["gate"] = gate;
  if (item.result == "unmet") {
    const auto* measure = scoring::measure_named(evidence.value("measure", std::string()));
    const bool earned = evidence.value("earned", true);
    if (!earned) out["result"] = "too early";
    out["harm"] = earned && (gate || (measure != nullptr && measure->guards));
  }
  out["borderline"] = evidence.value("borderline", false);
  out["reason"] = evidence.value("reason", std::string());
  if (evidence.contains("at_s")) out["evidence"].push_back(evidence["at_s"]);
  if (const auto place = evidence.find("place_m"); place != evidence.end() && place->is_array()) {
    out["place_mm"] = Json::array();  // LPS
    for (const Json& x : *place)
      if (x.is_number()) out["place_mm"].push_back(std::round(1e4 * x.get<double>()) / 10);
  }
  calibrated += evidence.value("calibrated", false) ? 1 : 0;
  return out;
}

Response session(Store& store, const Request& request) {
  const auto all = school::sessions_of(store, "");
  if (!all) return trouble(all.error());
  const auto found = std::find_if(all->begin(), all->end(), [&](const school::SessionRow& one) {
    return one.id == request.asked("id");
  });
  if (found == all->end()) return net::refusal(404, "there is no such session");
  const auto items = school::items_of(store, found->id);
  if (!items) return trouble(items.error());
  const auto scores = school::scores_of(store, found->id);
  if (!scores) return trouble(scores.error());
  auto words = words_of(store, scores->empty() ? std::string() : scores->front().rubric_hash);
  Json out = brief(*found);
  out["device"] = found->device;
  out["voxel_um"] = found->voxel_um;
  out["engine"] = found->engine;
  // where it lies on a disk is nobody's business here; its name is enough to find it
  out["recording"] = found->recording_uri.substr(found->recording_uri.rfind('/') + 1);
  out["parts"] = parts_of(*scores);
  out["items"] = Json::array();
  int calibrated = 0;
  for (const school::ItemRow& item : *items)
    out["items"].push_back(item_of(item, words, calibrated));
  out["calibrated"] = calibrated;
  out["others"] = Json::array();
  for (const bool own : {true, false})  // the learner's own first
    for (auto other = all->rbegin(); other != all->rend() && out["others"].size() < kMostOthers;
         ++other)
      if (other->id != found->id && other->case_name == found->case_name &&
          (other->learner == found->learner) == own)
        out["others"].push_back(
            {{"id", other->id}, {"learner", other->learner}, {"started_ms", other->started_ms}});
  return answer(out);
}

Response audit_of(Store& store) {
  const auto rows = school::audit(store);
  if (!rows) return trouble(rows.error());
  Json out = {{"rows", Json::array()}};
  for (auto row = rows->rbegin(); row != rows->rend() && out["rows"].size() < kMostAudit; ++row)
    out["rows"].push_back(
        {{"ms", row->ms}, {"who", row->who}, {"what", row->what}, {"subject", row->subject}});
  return answer(out);
}

Response csv(Store& store) {
  const auto file = school::session_table(store);
  if (!file) return trouble(file.error());
  Response out;
  out.type = "text/csv; charset=utf-8";
  out.body = file->text;
  return out;
}

}  // namespace

std::map<std::string, nlohmann::ordered_json> words_of(Store& store,
                                                       const std::string& rubric_hash) {
  std::map<std::string, Json> out;
  const auto rows = store.database().rows("SELECT text FROM rubric WHERE hash = $1", {rubric_hash});
  if (!rows || rows->empty()) return out;
  const auto rubric = scoring::parse_rubric(school::text((*rows)[0][0]), "rubric");
  if (!rubric) return out;
  for (const scoring::Item& item : rubric->items)
    for (const auto& [language, text] : item.say.by_language) out[item.id][language] = text;
  return out;
}

Response answer_of_school(Store& store, const Request& request, school::PracticeMemo& memo) {
  if (request.method == "POST") return net::refusal(405, "nothing can be changed here");
  if (request.path == "/api/overview") return overview_of(store, memo);
  if (request.path == "/api/cohort") return cohort(store, request, memo);
  if (request.path == "/api/learner") return learner(store, request, memo);
  if (request.path == "/api/session") return session(store, request);
  if (request.path == "/api/audit") return audit_of(store);
  if (request.path == "/api/sessions.csv") return csv(store);
  return net::refusal(404, "there is nothing at this address");
}

}  // namespace burr::app
