#include "burr/school/export.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>

#include "burr/base/printable.h"
#include "burr/base/table_cell.h"
#include "burr/school/forget.h"
#include "burr/school/pending.h"

namespace burr::school {
namespace {

using Json = nlohmann::ordered_json;

struct Table {
  const char* name;
  const char* columns;  // with commas
  Sql all;
};
struct TableOf {
  const char* name;
  const char* columns;
  Sql of;  // $1: the learner
};

constexpr Table kAll[] = {
    {"learner", "id,created_ms,level,handed,retain_until_ms,consent_research",
     "SELECT id, created_ms, level, handed, retain_until_ms, consent_research FROM learner "
     "ORDER BY id"},
    {"cohort", "id,title", "SELECT id, title FROM cohort ORDER BY title"},
    {"cohort_member", "cohort_id,learner_id",
     "SELECT cohort_id, learner_id FROM cohort_member ORDER BY cohort_id, learner_id"},
    {"case_def", "hash,name,version",
     "SELECT hash, name, version FROM case_def ORDER BY name, hash"},
    {"rubric", "hash,name,version,calibrated",
     "SELECT hash, name, version, calibrated FROM rubric ORDER BY name, hash"},
    {"session",
     "id,learner_id,case_hash,started_ms,seconds,mode,guided,finished,attempt,device,device_max_n,"
     "voxel_um,engine,recording_hash,standing",
     "SELECT id, learner_id, case_hash, started_ms, seconds, mode, guided, finished, ROW_NUMBER() "
     "OVER (PARTITION BY learner_id, case_def.name ORDER BY started_ms, id), device, device_max_n, "
     "voxel_um, engine, recording_hash, standing FROM session LEFT JOIN case_def "
     "ON case_def.hash = session.case_hash ORDER BY started_ms, id"},
    {"station", "name,key,kind,enrolled_ms,revoked_ms",  // not by whom: a login is a name
     "SELECT name, key, kind, enrolled_ms, revoked_ms FROM station ORDER BY enrolled_ms, name"},
    {"seal", "session_id,nonce,station,given_ms,ended_ms,bone_hash,head,start_signature,signature",
     "SELECT session_id, nonce, station, given_ms, ended_ms, bone_hash, head, start_signature, "
     "signature FROM seal ORDER BY given_ms, session_id"},
    {"score", "id,session_id,rubric_hash,engine,part,total,gates_broken,assessable_weight,made_ms",
     "SELECT id, session_id, rubric_hash, engine, part, total, gates_broken, assessable_weight, "
     "made_ms FROM score ORDER BY session_id, part, id"},
    {"item", "score_id,item_id,result,value,threshold,margin,evidence_json",
     "SELECT score_id, item_id, result, value, threshold, margin, evidence_json FROM item "
     "ORDER BY score_id, item_id"},
    {"metric", "session_id,name,unit,value",
     "SELECT session_id, name, unit, value FROM metric ORDER BY session_id, name"},
    {"self_mark", "session_id,item_id,mark",
     "SELECT session_id, item_id, mark FROM self_mark ORDER BY session_id, item_id"},
    {"rater_mark", "id,session_id,rater_id,item_id,mark,blinded,reason,made_ms",
     "SELECT id, session_id, rater_id, item_id, mark, blinded, reason, made_ms FROM rater_mark "
     "ORDER BY session_id, rater_id, item_id"},
    {"standard", "id,rubric_hash,part,method,cut,n_low,n_high,judges,fp,fn,text,set_by,made_ms",
     "SELECT id, rubric_hash, part, method, cut, n_low, n_high, judges, fp, fn, text, set_by, "
     "made_ms FROM standard ORDER BY made_ms, id"},
    {"decision", "id,session_set_json,learner_id,standard_id,outcome,confirmed_by,reason,made_ms",
     "SELECT id, session_set_json, learner_id, standard_id, outcome, confirmed_by, reason, made_ms "
     "FROM decision ORDER BY made_ms, learner_id"},
};

constexpr TableOf kOf[] = {
    {"person", "learner_id,name,mail,external_id",
     "SELECT learner_id, name, mail, external_id FROM names.person WHERE learner_id = $1"},
    {"learner", "id,created_ms,level,handed,retain_until_ms,consent_research",
     "SELECT id, created_ms, level, handed, retain_until_ms, consent_research FROM learner "
     "WHERE id = $1"},
    {"cohort", "id,title",
     "SELECT cohort.id, cohort.title FROM cohort JOIN cohort_member "
     "ON cohort_member.cohort_id = cohort.id WHERE cohort_member.learner_id = $1 ORDER BY title"},
    {"case_def", "hash,name,version",
     "SELECT hash, name, version FROM case_def WHERE hash IN "
     "(SELECT case_hash FROM session WHERE learner_id = $1) ORDER BY name"},
    {"session",
     "id,learner_id,case_hash,started_ms,seconds,mode,guided,finished,attempt,device,device_max_n,"
     "voxel_um,engine,recording_hash,recording_uri,standing",
     "SELECT id, learner_id, case_hash, started_ms, seconds, mode, guided, finished, ROW_NUMBER() "
     "OVER (PARTITION BY case_def.name ORDER BY started_ms, id), device, device_max_n, voxel_um, "
     "engine, recording_hash, recording_uri, standing FROM session LEFT JOIN case_def "
     "ON case_def.hash = session.case_hash WHERE learner_id = $1 ORDER BY started_ms, id"},
    {"seal", "session_id,nonce,station,given_ms,ended_ms,bone_hash,head,start_signature,signature",
     "SELECT session_id, nonce, station, given_ms, ended_ms, bone_hash, head, start_signature, "
     "signature FROM seal WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1) "
     "ORDER BY given_ms"},
    {"nonce", "nonce,station,mode,case_hash,rubric_hash,given_ms",
     "SELECT nonce, station, mode, case_hash, rubric_hash, given_ms FROM nonce "
     "WHERE learner_id = $1 ORDER BY given_ms"},
    {"score", "id,session_id,rubric_hash,engine,part,total,gates_broken,assessable_weight,made_ms",
     "SELECT id, session_id, rubric_hash, engine, part, total, gates_broken, assessable_weight, "
     "made_ms FROM score WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1) "
     "ORDER BY session_id, part"},
    {"item", "score_id,item_id,result,value,threshold,margin,evidence_json",
     "SELECT score_id, item_id, result, value, threshold, margin, evidence_json FROM item "
     "WHERE score_id IN (SELECT score.id FROM score JOIN session ON session.id = score.session_id "
     "WHERE session.learner_id = $1) ORDER BY score_id, item_id"},
    {"metric", "session_id,name,unit,value",
     "SELECT session_id, name, unit, value FROM metric WHERE session_id IN "
     "(SELECT id FROM session WHERE learner_id = $1) ORDER BY session_id, name"},
    {"self_mark", "session_id,item_id,mark",
     "SELECT session_id, item_id, mark FROM self_mark WHERE session_id IN "
     "(SELECT id FROM session WHERE learner_id = $1) ORDER BY session_id, item_id"},
    {"rater_mark", "id,session_id,item_id,mark,blinded,reason,made_ms",  // not who: another person
     "SELECT id, session_id, item_id, mark, blinded, reason, made_ms FROM rater_mark "
     "WHERE session_id IN (SELECT id FROM session WHERE learner_id = $1) "
     "ORDER BY session_id, item_id"},
    {"decision", "session_set_json,learner_id,standard_id,outcome,confirmed_by,reason,made_ms",
     "SELECT session_set_json, learner_id, standard_id, outcome, confirmed_by, reason, made_ms "
     "FROM decision WHERE learner_id = $1 ORDER BY made_ms"},
    {"audit", "ms,what,subject",
     "SELECT ms, what, subject FROM audit WHERE subject = $1 OR subject IN "
     "(SELECT id FROM session WHERE learner_id = $1) ORDER BY ms"},
};

std::string csv_of(const char* columns, const std::vector<Row>& rows) {
  std::string out = std::string(columns) + "\r\n";
  for (const Row& row : rows)
    for (std::size_t n = 0; n < row.size(); ++n)
      out += base::table_cell(written(row[n])) + (n + 1 < row.size() ? "," : "\r\n");
  return out;
}

Json json_of(std::string_view columns, const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= columns.size();) {
    const std::size_t end = std::min(columns.find(',', at), columns.size());
    names.emplace_back(columns.substr(at, end - at));
    at = end + 1;
  }
  Json all = Json::array();
  for (const Row& row : rows) {
    Json one;
    for (std::size_t n = 0; n < row.size() && n < names.size(); ++n) {
      if (const auto* whole_number = std::get_if<std::int64_t>(&row[n]))
        one[names[n]] = *whole_number;
      else if (const auto* real = std::get_if<double>(&row[n]))
        one[names[n]] = *real;
      else if (is_null(row[n]))
        one[names[n]] = nullptr;
      else
        one[names[n]] = text(row[n]);
    }
    all.push_back(std::move(one));
  }
  return all;
}

// Statements for elsewhere, and sessions that wait on this computer.
Status add_what_waits(Store& store, const std::string& learner, std::vector<TextFile>& files,
                      Json& json) {
  constexpr const char* kColumns = "id,statement_json,state,tries,next_ms";
  auto rows = store.database().rows(
      "SELECT id, statement_json, state, tries, next_ms FROM outbox ORDER BY id");
  if (!rows) return rows.error();
  std::erase_if(*rows, [&](const Row& row) { return !is_about(text(row[1]), learner); });
  json["outbox"] = json_of(kColumns, *rows);
  if (!rows->empty()) files.push_back({"outbox.csv", csv_of(kColumns, *rows)});
  json["waiting"] = Json::array();
  std::vector<std::string> nobody_asks;
  for (const Waiting& one : waiting(store.place(), nobody_asks)) {
    if (one.session && one.session->learner == learner)
      json["waiting"].push_back(Json::parse(to_json(*one.session)));
    if (one.recording && one.recording->learner == learner)
      json["waiting"].push_back({{"recording", one.recording->file}});
  }
  return fine();
}

}  // namespace

Result<std::vector<TextFile>> all_tables(Store& store) {
  std::vector<TextFile> files;
  for (const Table& table : kAll) {
    const auto rows = store.database().rows(table.all);
    if (!rows) return rows.error();
    files.push_back({std::string(table.name) + ".csv", csv_of(table.columns, *rows)});
  }
  if (!store.reads_only())
    if (const Status noted = store.note("all exported", ""); !noted) return noted.error();
  return files;
}

Result<TextFile> session_table(Store& store) {
  for (const Table& table : kAll) {
    if (std::string_view(table.name) != "session") continue;
    const auto rows = store.database().rows(table.all);
    if (!rows) return rows.error();
    if (!store.reads_only())
      if (const Status noted = store.note("sessions exported", ""); !noted) return noted.error();
    return TextFile{"session.csv", csv_of(table.columns, *rows)};
  }
  return error("there is no table of sessions");
}

Result<std::vector<TextFile>> tables_of(Store& store, const std::string& learner) {
  const auto known = has(store, learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such learner; `school::learners` lists them",
                             base::printable(learner)));
  std::vector<TextFile> files;
  Json json;
  for (const TableOf& table : kOf) {
    const auto rows = store.database().rows(table.of, {learner});
    if (!rows) return rows.error();
    json[table.name] = json_of(table.columns, *rows);
    if (!rows->empty())
      files.push_back({std::string(table.name) + ".csv", csv_of(table.columns, *rows)});
  }
  const Status more = add_what_waits(store, learner, files, json);
  if (!more) return more.error();
  files.push_back(
      {"learner.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"});
  if (!store.reads_only())
    if (const Status noted = store.note("learner exported", learner); !noted) return noted.error();
  return files;
}

}  // namespace burr::school
