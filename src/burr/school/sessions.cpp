#include "burr/school/sessions.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/school/enrolled.h"
#include "burr/school/outbox.h"

namespace burr::school {
namespace {

Value or_null(const std::optional<double>& value) { return value ? Value(*value) : Value(); }

std::optional<double> maybe(const Value& value) {
  if (is_null(value)) return std::nullopt;
  return number(value);
}

Status ran(const Result<std::int64_t>& done) { return done ? fine() : Status(done.error()); }

Status define(Database& to, const SessionRecord& record) {
  // the same order everywhere, so that two stations never wait for each other
  const Defined& work = record.work_case;
  if (!work.hash.empty())
    if (const Status done = ran(to.run("INSERT INTO case_def (hash, name, version, text) VALUES "
                                       "($1, $2, $3, $4) ON CONFLICT DO NOTHING",
                                       {work.hash, work.name, work.version, work.text}));
        !done)
      return done;
  const Defined& rubric = record.rubric;
  if (rubric.hash.empty()) return fine();
  return ran(
      to.run("INSERT INTO rubric (hash, name, version, calibrated, text) VALUES "
             "($1, $2, $3, $4, $5) ON CONFLICT DO NOTHING",
             {rubric.hash, rubric.name, rubric.version, rubric.calibrated, rubric.text}));
}

Result<bool> insert_session(Database& to, const SessionRecord& record, const std::string& id,
                            const std::string& standing) {
  const auto made = to.run(
      "INSERT INTO session (id, learner_id, case_hash, started_ms, seconds, mode, guided, "
      "finished, "
      "attempt, device, device_max_n, voxel_um, engine, recording_hash, recording_uri, standing) "
      "VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16) "
      "ON CONFLICT DO NOTHING",
      {id, record.learner, record.work_case.hash.empty() ? Value() : Value(record.work_case.hash),
       record.started_ms, record.seconds, record.mode, std::int64_t{record.guided},
       std::int64_t{record.finished}, record.attempt, record.device, or_null(record.device_max_n),
       record.voxel_um, record.engine, record.recording_hash, record.recording_uri, standing});
  if (!made) return made.error();
  return *made > 0;
}

Result<bool> insert_score(Database& to, const SessionRecord& record, const ScoreRecord& score) {
  const std::string id = score_id(record, score);
  const auto made = to.run(
      "INSERT INTO score (id, session_id, rubric_hash, engine, part, total, gates_broken, "
      "assessable_weight, made_ms) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9) "
      "ON CONFLICT DO NOTHING",
      {id, session_id(record), record.rubric.hash, record.scored_by, score.part,
       or_null(score.total), score.gates_broken, score.assessable_weight, score.made_ms});
  if (!made) return made.error();
  if (*made == 0) return false;
  for (const ItemRecord& item : score.items)
    if (const Status done = ran(to.run(
            "INSERT INTO item (score_id, item_id, result, value, threshold, margin, evidence_json) "
            "VALUES ($1, $2, $3, $4, $5, $6, $7)",
            {id, item.id, item.result, or_null(item.value), or_null(item.threshold),
             or_null(item.margin), item.evidence_json}));
        !done)
      return done.error();
  return true;
}

Status insert_rest(Database& to, const SessionRecord& record, const std::string& id) {
  for (const MetricRecord& one : record.metrics)
    if (const Status done =
            ran(to.run("INSERT INTO metric (session_id, name, unit, value) VALUES ($1, $2, $3, $4) "
                       "ON CONFLICT DO NOTHING",
                       {id, one.name, one.unit, one.value}));
        !done)
      return done;
  for (const SelfMarkRecord& one : record.self_marks)
    if (const Status done =
            ran(to.run("INSERT INTO self_mark (session_id, item_id, mark) VALUES ($1, $2, $3) "
                       "ON CONFLICT DO NOTHING",
                       {id, one.item, one.mark}));
        !done)
      return done;
  return fine();
}

// A session that was continued is one session: what was entered of its recording before it went on
// gives way. What a person has marked stays: it is about that work. So does what is sealed: nobody takes back an exam
// by going on with it.
Status take_out_earlier(Database& to, const SessionRecord& record, Entered& entered) {
  for (const std::string& hash : record.goes_on_with) {
    const auto found = to.rows(
        "SELECT id FROM session WHERE recording_hash = $1 AND learner_id = $2 AND NOT EXISTS "
        "(SELECT 1 FROM rater_mark WHERE rater_mark.session_id = session.id) AND NOT EXISTS "
        "(SELECT 1 FROM seal WHERE seal.session_id = session.id)",
        {hash, record.learner});
    if (!found) return found.error();
    for (const Row& row : *found) {
      const std::string id = text(row[0]);
      for (const Sql each :
           {Sql("DELETE FROM item WHERE score_id IN (SELECT id FROM score WHERE session_id = $1)"),
            Sql("DELETE FROM score WHERE session_id = $1"),
            Sql("DELETE FROM metric WHERE session_id = $1"),
            Sql("DELETE FROM self_mark WHERE session_id = $1"),
            Sql("DELETE FROM session WHERE id = $1")})
        if (const Status done = ran(to.run(each, {id})); !done) return done;
      ++entered.taken_out;
    }
  }
  return fine();
}

// What is sealed keeps its seal, and its date is that of the store's clock; also of a session that came in before, without.
Status insert_seal(Store& store, const SessionRecord& record, const std::string& id, bool fresh) {
  const auto kept = keep_seal(store, record);
  if (!kept) return kept.error();
  if (*kept == fresh) return fine();
  if (fresh)
    return error(Trouble::usage,
                 "its nonce belongs to another session of the store; enter each session once");
  return ran(store.database().run("UPDATE session SET standing = $2, started_ms = $3 WHERE id = $1",
                                  {id, std::string(standing::kSealed), record.seal->given_ms}));
}

}  // namespace

Result<Entered> enter(Store& store, const SessionRecord& given) {
  if (const Status may = store.may_write(); !may) return may.error();
  Database& to = store.database();
  SessionRecord record = given;
  const std::string id = session_id(record);
  auto change = Transaction::begin(to);
  if (!change) return change.error();
  const auto known = has(store, record.learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage,
                 fmt::format("{}: there is no such learner in the store; `school::add` enters one",
                             base::printable(record.learner)));
  if (const Status done = define(to, record); !done) return done.error();
  Entered entered;
  const auto standing = check_seal(store, record);
  if (!standing) return standing.error();
  entered.standing = *standing;
  const bool sealed = *standing == standing::kSealed;
  if (sealed) record.started_ms = record.seal->given_ms;
  const auto fresh = insert_session(to, record, id, *standing);
  if (!fresh) return fresh.error();
  entered.session = *fresh;
  if (!*fresh) {
    const auto whose = to.rows("SELECT learner_id FROM session WHERE id = $1", {id});
    if (!whose) return whose.error();
    if (whose->empty() || text((*whose)[0][0]) != record.learner)
      return error(Trouble::usage, "this recording is in the store as that of another learner");
  }
  if (sealed)
    if (const Status kept = insert_seal(store, record, id, *fresh); !kept) return kept.error();
  for (const ScoreRecord& score : record.scores) {
    const auto made = insert_score(to, record, score);
    if (!made) return made.error();
    entered.scores += *made ? 1 : 0;
  }
  if (const Status done = insert_rest(to, record, id); !done) return done.error();
  if (const Status done = take_out_earlier(to, record, entered); !done) return done.error();
  if (entered.session)  // a session that is scored anew says nothing anew
    if (const Status queued = queue_session(store, record); !queued) return queued.error();
  if (entered.session || entered.scores > 0)
    if (const Status noted = store.note("session entered", id, Store::By::computer); !noted)
      return noted.error();
  if (const Status done = change->commit(); !done) return done.error();
  return entered;
}

Result<std::vector<LearnerRow>> learners(Store& store, bool with_names) {
  const auto found = store.database().rows(
      "SELECT learner.id, learner.level, learner.handed, learner.created_ms, "
      "learner.retain_until_ms, learner.consent_research, count(session.id), "
      "max(session.started_ms) FROM learner LEFT JOIN session ON session.learner_id = learner.id "
      "GROUP BY learner.id, learner.level, learner.handed, learner.created_ms, "
      "learner.retain_until_ms, learner.consent_research ORDER BY learner.id");
  if (!found) return found.error();
  const auto counts = store.database().rows(
      "SELECT learner_id, max(n) FROM (SELECT session.learner_id, case_def.name, count(*) AS n "
      "FROM session LEFT JOIN case_def ON case_def.hash = session.case_hash "
      "WHERE session.guided = 0 AND session.finished = 1 "
      "GROUP BY session.learner_id, case_def.name) AS by_case GROUP BY learner_id");
  if (!counts) return counts.error();
  std::map<std::string, std::int64_t> unguided;
  for (const Row& row : *counts) unguided[text(row[0])] = whole(row[1]);
  std::map<std::string, Person> people;
  if (with_names) {
    const auto named =
        store.database().rows("SELECT learner_id, name, mail, external_id FROM names.person");
    if (!named) return named.error();
    for (const Row& row : *named) people[text(row[0])] = {text(row[1]), text(row[2]), text(row[3])};
  }
  std::vector<LearnerRow> all;
  for (const Row& row : *found) {
    LearnerRow one;
    one.learner.id = text(row[0]);
    one.learner.level = text(row[1]);
    one.learner.handed = text(row[2]);
    one.learner.created_ms = whole(row[3]);
    if (!is_null(row[4])) one.learner.retain_until_ms = whole(row[4]);
    one.learner.consent_research = whole(row[5]) != 0;
    one.sessions = whole(row[6]);
    if (!is_null(row[7])) one.last_ms = whole(row[7]);
    one.unguided = unguided[one.learner.id];
    one.person = people[one.learner.id];
    all.push_back(std::move(one));
  }
  return all;
}

Result<std::vector<SessionRow>> sessions_of(Store& store, const std::string& learner) {
  // counted here: sessions come in late and in any order
  const auto found = store.database().rows(
      "SELECT session.id, session.learner_id, case_def.name, session.mode, session.device, "
      "session.engine, session.recording_uri, session.recording_hash, session.started_ms, "
      "ROW_NUMBER() OVER (PARTITION BY session.learner_id, case_def.name "
      "ORDER BY session.started_ms, session.id), session.seconds, session.voxel_um, "
      "session.guided, session.finished, COALESCE(session.standing, '') "
      "FROM session LEFT JOIN case_def ON case_def.hash = session.case_hash "
      "WHERE session.learner_id = $1 OR $2 = 1 ORDER BY session.started_ms, session.id",
      {learner, std::int64_t{learner.empty()}});
  if (!found) return found.error();
  std::vector<SessionRow> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), text(row[3]), text(row[4]),
                   text(row[5]), text(row[6]), text(row[7]), whole(row[8]), whole(row[9]),
                   number(row[10]), number(row[11]), whole(row[12]) != 0, whole(row[13]) != 0,
                   is_null(row[14]) || text(row[14]).empty() ? standing::kNoSeal : text(row[14])});
  return all;
}

Result<std::vector<ScoreRow>> scores_of(Store& store, const std::string& session) {
  const auto found = store.database().rows(
      "SELECT score.session_id, score.rubric_hash, rubric.name, score.engine, score.part, "
      "score.total, score.gates_broken, "
      "(SELECT count(*) FROM item WHERE score_id = score.id AND result = 'met'), "
      "(SELECT count(*) FROM item WHERE score_id = score.id AND result <> 'not assessable'), "
      "(SELECT count(*) FROM item WHERE score_id = score.id), score.made_ms "
      "FROM score JOIN rubric ON rubric.hash = score.rubric_hash WHERE score.session_id = $1 "
      "ORDER BY score.made_ms DESC, score.part DESC",
      {session});
  if (!found) return found.error();
  std::vector<ScoreRow> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), text(row[3]), text(row[4]),
                   maybe(row[5]), whole(row[6]), whole(row[7]), whole(row[8]), whole(row[9]),
                   whole(row[10])});
  return all;
}

Result<std::vector<ItemRow>> items_of(Store& store, const std::string& session) {
  const auto found = store.database().rows(
      "SELECT score.part, item.item_id, item.result, item.value, item.threshold, item.margin, "
      "item.evidence_json, self_mark.mark FROM score JOIN item ON item.score_id = score.id "
      "LEFT JOIN self_mark ON self_mark.session_id = score.session_id "
      "AND self_mark.item_id = item.item_id "
      "WHERE score.session_id = $1 AND NOT EXISTS (SELECT 1 FROM score AS later "
      "WHERE later.session_id = score.session_id AND later.part = score.part "
      "AND (later.made_ms > score.made_ms OR (later.made_ms = score.made_ms "
      "AND later.id > score.id))) ORDER BY score.part DESC, item.item_id",
      {session});
  if (!found) return found.error();
  std::vector<ItemRow> all;
  for (const Row& row : *found)
    all.push_back({text(row[0]), text(row[1]), text(row[2]), maybe(row[3]), maybe(row[4]),
                   maybe(row[5]), text(row[6]), text(row[7])});
  return all;
}

Result<std::vector<Cell>> items_of_cohort(Store& store, const std::string& cohort_id,
                                          const std::string& case_name, std::int64_t last) {
  // of each learner the last sessions; of each session its newest score of each part
  const auto found = store.database().rows(
      "WITH recent AS (SELECT session.learner_id, session.id, ROW_NUMBER() OVER (PARTITION BY "
      "session.learner_id ORDER BY session.started_ms DESC, session.id) AS place "
      "FROM cohort_member JOIN session ON session.learner_id = cohort_member.learner_id "
      "JOIN case_def ON case_def.hash = session.case_hash "
      "WHERE cohort_member.cohort_id = $1 AND case_def.name = $2 AND session.guided = 0 "
      "AND session.finished = 1 AND EXISTS (SELECT 1 FROM score WHERE score.session_id = "
      "session.id)) "
      "SELECT recent.learner_id, item.item_id, item.result FROM recent "
      "JOIN score ON score.session_id = recent.id JOIN item ON item.score_id = score.id "
      "WHERE recent.place <= $3 AND NOT EXISTS (SELECT 1 FROM score AS later "
      "WHERE later.session_id = score.session_id AND later.part = score.part "
      "AND (later.made_ms > score.made_ms OR (later.made_ms = score.made_ms "
      "AND later.id > score.id)))",
      {cohort_id, case_name, last});
  if (!found) return found.error();
  std::map<std::pair<std::string, std::string>, Cell> cells;
  for (const Row& row : *found) {
    const std::string learner = text(row[0]), item = text(row[1]), result = text(row[2]);
    Cell& cell = cells[{learner, item}];
    cell.learner = learner;
    cell.item = item;
    ++cell.sessions;
    cell.met += result == "met" ? 1 : 0;
    cell.assessable += result != "not assessable" ? 1 : 0;
  }
  std::vector<Cell> all;
  for (auto& [key, cell] : cells) all.push_back(std::move(cell));
  return all;
}

std::vector<ItemShare> shares(const std::vector<Cell>& cells) {
  struct Sum {
    std::int64_t people = 0;
    double share = 0;
  };
  std::map<std::string, Sum> sums;
  for (const Cell& cell : cells) {
    Sum& sum = sums[cell.item];
    if (cell.assessable == 0) continue;
    ++sum.people;
    sum.share += static_cast<double>(cell.met) / static_cast<double>(cell.assessable);
  }
  std::vector<ItemShare> all;
  for (const auto& [item, sum] : sums) {
    ItemShare one{item, sum.people, std::nullopt};
    if (sum.people >= kFewestPeople) one.share_met = sum.share / static_cast<double>(sum.people);
    all.push_back(std::move(one));
  }
  return all;
}

Result<std::vector<AuditRow>> audit(Store& store) {
  const auto found =
      store.database().rows("SELECT ms, who, what, subject FROM audit ORDER BY ms, what, subject");
  if (!found) return found.error();
  std::vector<AuditRow> all;
  for (const Row& row : *found)
    all.push_back({whole(row[0]), text(row[1]), text(row[2]), text(row[3])});
  return all;
}

}  // namespace burr::school
