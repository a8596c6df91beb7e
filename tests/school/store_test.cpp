// The store of learners, in a file and on a server: the same tests for both.
#include "burr/school/store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/table_cell.h"
#include "burr/school/audit_check.h"
#include "burr/school/export.h"
#include "burr/school/forget.h"
#include "burr/school/pending.h"
#include "burr/school/sessions.h"
#include "burr/school/store_schema.h"
#include "burr/school/uuid.h"
#include "school/made.h"
#include "support/postgres_server.h"

namespace burr::school {
namespace {

using test::Folder;
using test::made_session;
using test::PostgresServer;

// One server for all tests of this program; each test has a fresh database.
PostgresServer& server() {
  static PostgresServer one;
  return one;
}

enum class Where { file, server };

class StoreTest : public ::testing::TestWithParam<Where> {
 protected:
  void SetUp() override {
    place_ = test::place_in(folder_);
    if (GetParam() == Where::file) return open();
    BURR_NEEDS_POSTGRES(server());
    place_.address = server().address();
    auto raw = open_postgres(place_.address, "server", {});
    ASSERT_TRUE(raw) << raw.error().text;
    for (const Sql one : {Sql("DROP SCHEMA IF EXISTS public CASCADE"), Sql("CREATE SCHEMA public"),
                          Sql("DROP SCHEMA IF EXISTS names CASCADE")})
      ASSERT_TRUE((*raw)->run(one));
    open();
  }
  void open() {
    auto opened = Store::open(place_);
    ASSERT_TRUE(opened) << opened.error().text;
    store_ = std::move(*opened);
  }
  Store& store() { return *store_; }
  void add_learner(const std::string& id, const Person& person = {}) {
    Learner learner;
    learner.id = id;
    learner.level = "PGY2";
    const Status added = add(store(), learner, person);
    ASSERT_TRUE(added) << added.error().text;
  }
  std::int64_t count(Sql sql) { return whole((*store().database().rows(sql))[0][0]); }

  Folder folder_;
  StorePlace place_;
  std::unique_ptr<Store> store_;
};
INSTANTIATE_TEST_SUITE_P(Both, StoreTest, ::testing::Values(Where::file, Where::server),
                         [](const auto& about) {
                           return about.param == Where::file ? "File" : "Server";
                         });

TEST_P(StoreTest, KeepsALearnerAndTheNameApart) {
  add_learner("kestrel-27", {"Ada O'Neil; DROP TABLE learner", "ada@example.org", "S-1"});
  add_learner("otter-5");
  const auto plain = learners(store(), false);
  ASSERT_TRUE(plain) << plain.error().text;
  ASSERT_EQ(plain->size(), 2U);
  EXPECT_EQ((*plain)[0].learner.id, "kestrel-27");
  EXPECT_EQ((*plain)[0].learner.level, "PGY2");
  EXPECT_TRUE((*plain)[0].person.empty());
  const auto named = learners(store(), true);
  ASSERT_TRUE(named) << named.error().text;
  EXPECT_EQ((*named)[0].person.name, "Ada O'Neil; DROP TABLE learner");
  EXPECT_TRUE((*named)[1].person.empty());
  EXPECT_EQ(count("SELECT count(*) FROM names.person"), 1);  // no row where no name was given
}

TEST_P(StoreTest, RefusesBadLearners) {
  add_learner("kestrel-27");
  Learner learner;
  for (const char* id : {"Ada Lovelace", "ada@example.org", "kestrel-27", ""}) {
    learner.id = id;
    EXPECT_FALSE(add(store(), learner, {})) << id;
  }
  learner.id = "kestrel-28";
  learner.level = "professor";
  EXPECT_FALSE(add(store(), learner, {}));
  EXPECT_EQ(count("SELECT count(*) FROM learner"), 1);
  const auto made = new_pseudonym(store());
  ASSERT_TRUE(made) << made.error().text;
  learner.id = *made;
  learner.level = "surgeon";
  EXPECT_TRUE(add(store(), learner, {})) << *made;
}

TEST_P(StoreTest, KeepsEveryNumberOfASessionToTheBit) {
  add_learner("kestrel-27");
  const SessionRecord given = made_session("kestrel-27", "a");
  const auto entered = enter(store(), given);
  ASSERT_TRUE(entered) << entered.error().text;
  EXPECT_TRUE(entered->session);
  EXPECT_EQ(entered->scores, 2U);
  const auto sessions = sessions_of(store(), "kestrel-27");
  ASSERT_TRUE(sessions) << sessions.error().text;
  ASSERT_EQ(sessions->size(), 1U);
  const SessionRow& row = sessions->front();
  EXPECT_EQ(row.id, session_id(given));
  EXPECT_EQ(row.case_name, "block");
  EXPECT_EQ(row.seconds, given.seconds);
  EXPECT_EQ(row.started_ms, given.started_ms);
  EXPECT_EQ(row.attempt, 1);
  EXPECT_TRUE(row.finished);
  EXPECT_FALSE(row.guided);
  const auto items = items_of(store(), row.id);
  ASSERT_TRUE(items) << items.error().text;
  ASSERT_EQ(items->size(), 4U);
  EXPECT_EQ((*items)[0].id, "floor");
  EXPECT_EQ((*items)[0].value, 0.1 + 0.2);
  EXPECT_EQ((*items)[0].self_mark, "met");
  EXPECT_EQ((*items)[0].evidence_json, "{\"tick\":12}");
  EXPECT_FALSE((*items)[1].value);
  EXPECT_EQ((*items)[2].margin, -1e-3);
  EXPECT_EQ((*items)[3].part, "process");
  const auto scores = scores_of(store(), row.id);
  ASSERT_TRUE(scores) << scores.error().text;
  ASSERT_EQ(scores->size(), 2U);
  EXPECT_EQ((*scores)[0].total, 66.5);
  EXPECT_EQ((*scores)[0].met, 1);
  EXPECT_EQ((*scores)[0].assessable, 2);
  EXPECT_FALSE((*scores)[1].total);
}

TEST_P(StoreTest, TheSameRecordingIsTheSameSession) {
  add_learner("kestrel-27");
  add_learner("otter-5");
  SessionRecord one = made_session("kestrel-27", "a");
  ASSERT_TRUE(enter(store(), one));
  const auto again = enter(store(), one);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->session);
  EXPECT_EQ(again->scores, 0U);
  one.scored_by = "0.2.0";  // a newer burr scores it again
  for (ScoreRecord& score : one.scores) score.made_ms += 1000;
  one.scores[0].items[1].result = "met";
  const auto newer = enter(store(), one);
  ASSERT_TRUE(newer) << newer.error().text;
  EXPECT_FALSE(newer->session);
  EXPECT_EQ(newer->scores, 2U);
  EXPECT_EQ(count("SELECT count(*) FROM session"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM score"), 4);
  EXPECT_EQ(count("SELECT count(*) FROM metric"), 1);
  const auto items = items_of(store(), session_id(one));  // the newest marks alone
  ASSERT_TRUE(items);
  ASSERT_EQ(items->size(), 4U);
  EXPECT_EQ((*items)[2].result, "met");
  one.learner = "otter-5";
  EXPECT_FALSE(enter(store(), one));
}

// What was entered before the session was continued gives way; what a person has marked stays.
TEST_P(StoreTest, AContinuedSessionIsOneSession) {
  add_learner("kestrel-27");
  add_learner("heron-4821");
  const SessionRecord first = made_session("kestrel-27", "first");
  SessionRecord second = made_session("kestrel-27", "first and second");
  second.goes_on_with = {first.recording_hash};
  SessionRecord third = made_session("kestrel-27", "all three");
  third.goes_on_with = {first.recording_hash, second.recording_hash};
  for (const SessionRecord* one : std::array<const SessionRecord*, 3>{&first, &second, &third}) {
    const auto entered = enter(store(), *one);
    ASSERT_TRUE(entered) << entered.error().text;
    EXPECT_TRUE(entered->session);
    EXPECT_EQ(entered->taken_out, one == &first ? 0U : 1U);
    EXPECT_EQ(count("SELECT count(*) FROM session"), 1);
    EXPECT_EQ(count("SELECT count(*) FROM score"), 2);
    EXPECT_EQ(count("SELECT count(*) FROM metric"), 1);
    EXPECT_EQ(count("SELECT count(*) FROM self_mark"), 2);
  }
  const auto back = session_from_json(to_json(third), "test");
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(back->goes_on_with, third.goes_on_with);
  // of another learner nothing is taken out
  SessionRecord other = made_session("heron-4821", "mine");
  other.goes_on_with = {third.recording_hash};
  const auto entered = enter(store(), other);
  ASSERT_TRUE(entered) << entered.error().text;
  EXPECT_EQ(entered->taken_out, 0U);
  EXPECT_EQ(count("SELECT count(*) FROM session"), 2);
}

TEST_P(StoreTest, CountsAttemptsAndUnguidedSessions) {
  add_learner("kestrel-27");
  for (int n = 0; n < 6; ++n) {
    SessionRecord one = made_session("kestrel-27", std::to_string(n), 1'700'000'000'000 + n);
    one.guided = n < 2;
    one.finished = n != 5;
    ASSERT_TRUE(enter(store(), one));
  }
  const auto rows = learners(store(), false);
  ASSERT_TRUE(rows);
  EXPECT_EQ((*rows)[0].sessions, 6);
  EXPECT_EQ((*rows)[0].unguided, 3);
  EXPECT_EQ((*rows)[0].last_ms, 1'700'000'000'005);
  const auto sessions = sessions_of(store(), "kestrel-27");
  ASSERT_TRUE(sessions);
  EXPECT_EQ(sessions->back().attempt, 6);
}

TEST_P(StoreTest, CountsAttemptsByTimeInWhateverOrderTheyComeIn) {
  add_learner("kestrel-27");
  for (const std::int64_t t : {3, 1, 2}) {
    SessionRecord one = made_session("kestrel-27", std::to_string(t), 1'700'000'000'000 + t);
    // a newer text of the case is the same case still
    one.work_case.hash = t == 2 ? "0x00000000000000ac" : "0x00000000000000aa";
    ASSERT_TRUE(enter(store(), one));
  }
  const auto sessions = sessions_of(store(), "kestrel-27");
  ASSERT_TRUE(sessions) << sessions.error().text;
  ASSERT_EQ(sessions->size(), 3U);
  for (const SessionRow& row : *sessions)
    EXPECT_EQ(row.attempt, row.started_ms - 1'700'000'000'000);
  const auto csv = session_table(store());
  ASSERT_TRUE(csv) << csv.error().text;
  for (const int t : {1, 2, 3})
    EXPECT_NE(csv->text.find(fmt::format("170000000000{},61.25,exam,0,1,{},", t, t)),
              std::string::npos)
        << csv->text;
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'sessions exported'"), 1);
}

TEST_P(StoreTest, ShowsNoShareOfFewerThanFivePeople) {
  for (int n = 0; n < 5; ++n) {
    const std::string id = "owl-" + std::to_string(n);
    add_learner(id);
    ASSERT_TRUE(add_to_cohort(store(), "autumn", {id}));
    for (int k = 0; k < 7; ++k) {
      SessionRecord one = made_session(id, std::to_string(k), 1'700'000'000'000 + k);
      one.scores[0].items[0].result = k < 2 ? "unmet" : "met";  // the last five: all met
      ASSERT_TRUE(enter(store(), one));
    }
    const auto all = cohorts(store());
    ASSERT_TRUE(all);
    const auto cells = items_of_cohort(store(), all->front().id, "block");
    ASSERT_TRUE(cells) << cells.error().text;
    ASSERT_EQ(cells->size(), 4U * static_cast<std::size_t>(n + 1));
    EXPECT_EQ(cells->front().item, "floor");
    EXPECT_EQ(cells->front().met, 5);
    EXPECT_EQ(cells->front().sessions, 5);
    const auto of_all = shares(*cells);
    ASSERT_EQ(of_all.size(), 4U);
    EXPECT_EQ(of_all[0].share_met.has_value(), n == 4) << n;
    EXPECT_FALSE(of_all[1].share_met);  // nerve: assessable of nobody
  }
}

TEST_P(StoreTest, ACohortGoesWithItsLastMember) {
  add_learner("kestrel-27");
  EXPECT_FALSE(add_to_cohort(store(), "autumn", {"kestrel-27", "nobody-1"}));
  EXPECT_EQ(count("SELECT count(*) FROM cohort"), 0);  // all or nothing
  ASSERT_TRUE(add_to_cohort(store(), "autumn", {"kestrel-27"}));
  ASSERT_TRUE(add_to_cohort(store(), "autumn", {"kestrel-27"}));
  EXPECT_FALSE(remove_from_cohort(store(), "autumn", {"otter-5"}));
  EXPECT_FALSE(remove_from_cohort(store(), "spring", {"kestrel-27"}));
  ASSERT_TRUE(remove_from_cohort(store(), "autumn", {"kestrel-27"}));
  EXPECT_EQ(count("SELECT count(*) FROM cohort"), 0);
}

TEST_P(StoreTest, AnOlderStoreIsBroughtUpAndKeepsItsRows) {
  // as the first version of burr left it
  Database& in = store().database();
  add_learner("kestrel-27");
  for (const Sql one : {Sql("DROP INDEX session_of_learner"),
                        Sql("DROP INDEX mark_of_session"),
                        Sql("DROP INDEX decision_on_learner"),
                        Sql("DROP INDEX member_in_cohort"),
                        Sql("DROP INDEX outbox_next"),
                        Sql("ALTER TABLE standard DROP COLUMN part"),
                        Sql("ALTER TABLE standard DROP COLUMN judges"),
                        Sql("ALTER TABLE standard DROP COLUMN set_by"),
                        Sql("ALTER TABLE standard DROP COLUMN made_ms"),
                        Sql("ALTER TABLE decision DROP COLUMN id"),
                        Sql("DROP TABLE seal"),
                        Sql("DROP TABLE nonce_end"),
                        Sql("DROP TABLE nonce"),
                        Sql("DROP TABLE station"),
                        Sql("ALTER TABLE session DROP COLUMN standing"),
                        Sql("DROP INDEX audit_in_order"),
                        Sql("ALTER TABLE audit DROP COLUMN number"),
                        Sql("ALTER TABLE audit DROP COLUMN salt"),
                        Sql("ALTER TABLE audit DROP COLUMN digest"),
                        Sql("ALTER TABLE audit DROP COLUMN hash"),
                        Sql("ALTER TABLE decision DROP COLUMN signature"),
                        Sql("DELETE FROM schema_version WHERE v >= 2")})
    ASSERT_TRUE(in.run(one));
  open();
  EXPECT_EQ(count("SELECT max(v) FROM schema_version"), kSchema);
  EXPECT_TRUE(*has(store(), "kestrel-27"));
  EXPECT_TRUE(store().database().run("DROP INDEX outbox_next"));  // it was made again
}

TEST_P(StoreTest, AStoreOfANewerBurrIsOnlyRead) {
  add_learner("kestrel-27");
  ASSERT_TRUE(store().database().run("INSERT INTO schema_version (v, applied_ms) VALUES (99, 0)"));
  open();
  EXPECT_TRUE(store().reads_only());
  ASSERT_EQ(store().notices().size(), 1U);
  EXPECT_NE(store().notices()[0].find("newer burr"), std::string::npos) << store().notices()[0];
  EXPECT_EQ(learners(store(), true)->size(), 1U);
  Learner other;
  other.id = "otter-5";
  EXPECT_FALSE(add(store(), other, {}));
  EXPECT_FALSE(forget(store(), "kestrel-27", {}));
  // also whoever forgets to ask cannot write
  EXPECT_FALSE(store().database().run("DELETE FROM learner"));
  // a session waits for the newer burr
  const auto kept = enter_or_keep(place_, made_session("kestrel-27", "a"));
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_FALSE(kept->stored);
  std::vector<std::string> notices;
  EXPECT_EQ(waiting(place_, notices).size(), 1U);
}

// Anybody could write a file with scores: what is sealed waits as its recording, and a file has no seal.
TEST_P(StoreTest, ASealedSessionWaitsAsItsRecording) {
  add_learner("kestrel-27");
  test::MadeStation station(store(), folder_.str());
  const SessionRecord sealed = station.sealed(made_session("kestrel-27", "a"));
  EXPECT_FALSE(session_from_json(to_json(sealed), "x")->seal);
  EXPECT_FALSE(session_from_json(to_json(sealed), "x")->replayed);
  ASSERT_TRUE(store().database().run("INSERT INTO schema_version (v, applied_ms) VALUES (99, 0)"));
  const auto kept = enter_or_keep(place_, sealed, {folder_ / "a.mcap", "kestrel-27", ""});
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_FALSE(kept->stored);
  std::vector<std::string> notices;
  const std::vector<Waiting> all = waiting(place_, notices);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_FALSE(all[0].session);
  ASSERT_TRUE(all[0].recording);
  EXPECT_EQ(all[0].recording->file, folder_ / "a.mcap");
}

TEST_P(StoreTest, ASealIsKeptOnceAndGoesWithItsLearner) {
  add_learner("kestrel-27");
  test::MadeStation station(store(), folder_.str());
  const SessionRecord plain = made_session("kestrel-27", "a"), sealed = station.sealed(plain);
  ASSERT_TRUE(enter(store(), plain));  // it came without its seal first
  EXPECT_EQ(sessions_of(store(), "")->front().standing, standing::kNoSeal);
  const auto entered = enter(store(), sealed);
  ASSERT_TRUE(entered) << entered.error().text;
  EXPECT_TRUE(enter(store(), sealed));
  EXPECT_TRUE(sessions_of(store(), "")->front().sealed());
  EXPECT_EQ(count("SELECT count(*) FROM seal"), 1);
  SessionRecord not_again = sealed;
  not_again.replayed = false;
  not_again.recording_hash = sha1("another file");
  EXPECT_FALSE(enter(store(), not_again));  // its nonce belongs to the first
  // a longer recording takes no sealed session out
  SessionRecord longer = made_session("kestrel-27", "b");
  longer.goes_on_with = {sealed.recording_hash};
  ASSERT_TRUE(enter(store(), longer));
  EXPECT_EQ(sessions_of(store(), "")->size(), 2U);
  ASSERT_TRUE(forget(store(), "kestrel-27", {}));
  EXPECT_EQ(count("SELECT count(*) FROM seal"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM nonce"), 0);
  const auto found = check_audit(store(), "");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_GT(found->forgotten, 0);
}

TEST_P(StoreTest, SaysWhomItWouldDeleteAndDeletesNobodyByItself) {
  Learner learner;
  learner.id = "kestrel-27";
  learner.retain_until_ms = now_ms() - 1000;
  ASSERT_TRUE(add(store(), learner, {}));
  learner.id = "otter-5";
  learner.retain_until_ms = now_ms() + 1'000'000;
  ASSERT_TRUE(add(store(), learner, {}));
  open();
  ASSERT_EQ(store().notices().size(), 1U);
  EXPECT_NE(store().notices()[0].find("kestrel-27"), std::string::npos);
  EXPECT_EQ(store().notices()[0].find("otter-5"), std::string::npos);
  EXPECT_EQ(count("SELECT count(*) FROM learner"), 2);
  EXPECT_EQ(*overdue(store(), now_ms()), std::vector<std::string>{"kestrel-27"});
}

TEST_P(StoreTest, TheAuditSaysWhoWhatAndWhen) {
  add_learner("kestrel-27");
  ASSERT_TRUE(enter(store(), made_session("kestrel-27", "a")));
  ASSERT_TRUE(tables_of(store(), "kestrel-27"));
  const auto rows = audit(store());
  ASSERT_TRUE(rows) << rows.error().text;
  ASSERT_EQ(rows->size(), 3U);
  for (const AuditRow& row : *rows) {
    // the learner may be logged in while a session comes in
    EXPECT_EQ(row.who, row.what == "session entered" ? "bench" : "tester@bench");
    EXPECT_LT(std::abs(row.ms - now_ms()), 600'000);
  }
}

// ---- forgetting

void fill(Store& store, const std::string& id) {
  Database& in = store.database();
  const SessionRecord one = made_session(id, "a");
  ASSERT_TRUE(enter(store, one));
  ASSERT_TRUE(add_to_cohort(store, "autumn", {id}));
  ASSERT_TRUE(
      in.run("INSERT INTO standard (id, rubric_hash, method, cut) VALUES ($1, $2, 'angoff', 50)",
             {"standard of " + one.recording_hash.substr(0, 8), one.rubric.hash}));
  ASSERT_TRUE(in.run(
      "INSERT INTO rater_mark (id, session_id, rater_id, item_id, mark, blinded, reason, made_ms) "
      "VALUES ($1, $2, $3, 'floor', 'met', 1, 'neat', 5)",
      {one.recording_hash, session_id(one), "rater-1"}));
  ASSERT_TRUE(in.run(
      "INSERT INTO decision (session_set_json, learner_id, standard_id, outcome, confirmed_by, "
      "reason, made_ms) VALUES ($1, $2, $3, 'passed', 'rater-1', '', 5)",
      {"[\"" + session_id(one) + "\"]", id, "standard of " + one.recording_hash.substr(0, 8)}));
  for (const char* state : {"sent", "waiting"})  // the other one was never tried
    ASSERT_TRUE(in.run(
        "INSERT INTO outbox (id, statement_json, state, tries, next_ms) VALUES ($1, $2, $3, $4, 0)",
        {uuid_of(session_id(one), state),
         "{\"actor\":{\"account\":{\"homePage\":\"https://centre.example\",\"name\":\"" + id +
             "\"}}}",
         std::string(state), std::int64_t{std::string(state) == "sent"}}));
}

// Every cell of every table, in one text.
std::string all_of(Database& in) {
  std::string all;
  for (const Sql one :
       {Sql("SELECT * FROM learner"), Sql("SELECT * FROM names.person"),
        Sql("SELECT * FROM cohort"), Sql("SELECT * FROM cohort_member"),
        Sql("SELECT * FROM session"), Sql("SELECT * FROM score"), Sql("SELECT * FROM item"),
        Sql("SELECT * FROM metric"), Sql("SELECT * FROM self_mark"),
        Sql("SELECT * FROM rater_mark"), Sql("SELECT * FROM decision"), Sql("SELECT * FROM outbox"),
        Sql("SELECT * FROM audit"), Sql("SELECT * FROM case_def"), Sql("SELECT * FROM rubric"),
        Sql("SELECT * FROM standard")}) {
    const auto rows = in.rows(one);
    EXPECT_TRUE(rows) << one.text();
    for (const Row& row : *rows)
      for (const Value& value : row) all += written(value) + "\n";
  }
  return all;
}

TEST_P(StoreTest, ForgetsALearnerAndNobodyElse) {
  add_learner("kestrel-27", {"Ada Lovelace", "ada@example.org", "S-1815"});
  add_learner("otter-5", {"Grace Hopper", "", ""});
  fill(store(), "kestrel-27");
  fill(store(), "otter-5");
  // its recording, in the window's folder, with what lies beside; and one that was changed since
  std::filesystem::create_directories(folder_.path() / "sessions");
  const std::string recording = folder_ / "sessions/s.mcap", page = folder_ / "sessions/s.html",
                    account = folder_ / "sessions/s.json";
  std::ofstream(recording) << "the bytes";
  std::ofstream(page) << "the page";
  std::ofstream(account) << "{}";
  // a folder of that name elsewhere is not the window's
  std::filesystem::create_directories(folder_.path() / "mine/sessions");
  const std::string elsewhere = folder_ / "mine/sessions/t.mcap",
                    notes = folder_ / "mine/sessions/t.toml";
  std::ofstream(elsewhere) << "more bytes";
  std::ofstream(notes) << "notes";
  const Recordings more = {{elsewhere}, {}, folder_.path() / "sessions"};
  SessionRecord mine = made_session("kestrel-27", "b");
  mine.recording_hash = *sha1_of_file(recording);
  mine.recording_uri = uri_of(recording);
  ASSERT_TRUE(enter(store(), mine));
  const std::string other = folder_ / "other.mcap";
  std::ofstream(other) << "somebody else's";
  SessionRecord moved = made_session("kestrel-27", "c");
  moved.recording_uri = uri_of(other);
  ASSERT_TRUE(enter(store(), moved));
  ASSERT_TRUE(keep(place_, made_session("kestrel-27", "waits")));
  ASSERT_TRUE(keep(place_, made_session("otter-5", "waits")));
  const std::string before = all_of(store().database());
  ASSERT_NE(before.find("kestrel-27"), std::string::npos);

  if (GetParam() == Where::file) {  // what cannot be written deletes no recording
    auto writer = open_sqlite(place_.address, names_file(place_.address), place_.waits);
    ASSERT_TRUE((*writer)->begin());
    EXPECT_FALSE(forget(store(), "kestrel-27", more));
    (*writer)->rollback();
    EXPECT_TRUE(std::filesystem::exists(recording));
  }
  const auto done = forget(store(), "kestrel-27", more);
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_EQ(done->sessions, 3U);
  EXPECT_EQ(done->waiting, 1U);
  EXPECT_EQ(done->voided, 1U);
  EXPECT_EQ(done->notices, std::vector<std::string>{});
  EXPECT_EQ(done->deleted, (std::vector<std::string>{page, account, recording, elsewhere}));
  ASSERT_EQ(done->unreached.size(), 1U);
  EXPECT_NE(done->unreached[0].find("other.mcap"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(recording));
  EXPECT_TRUE(std::filesystem::exists(other));
  EXPECT_TRUE(std::filesystem::exists(notes));
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what <> 'learner forgotten' AND subject = '' "
                  "AND who <> ''"),
            0);

  const std::string after = all_of(store().database());
  for (const std::string& gone :
       {std::string("kestrel-27"), std::string("Lovelace"), std::string("ada@example.org"),
        std::string("S-1815"), session_id(mine), session_id(made_session("kestrel-27", "a"))})
    EXPECT_EQ(after.find(gone), std::string::npos) << gone;
  EXPECT_NE(after.find("Hopper"), std::string::npos);
  EXPECT_EQ(count("SELECT count(*) FROM session"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM decision"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'learner forgotten' AND subject = ''"),
            1);
  // what was sent is taken back by a statement that names nobody; what was not, is gone
  EXPECT_EQ(count("SELECT count(*) FROM outbox"), 3);
  EXPECT_NE(after.find("voided"), std::string::npos);
  std::vector<std::string> notices;
  EXPECT_EQ(waiting(place_, notices).size(), 1U);
  EXPECT_FALSE(forget(store(), "kestrel-27", {}));
}

TEST_P(StoreTest, GivesOutAllThatIsKnownOfOneAndNoNameOfAll) {
  add_learner("kestrel-27", {"Ada Lovelace", "", ""});
  add_learner("otter-5");
  fill(store(), "kestrel-27");
  fill(store(), "otter-5");
  ASSERT_TRUE(keep(place_, made_session("kestrel-27", "waits")));
  const auto mine = tables_of(store(), "kestrel-27");
  ASSERT_TRUE(mine) << mine.error().text;
  std::string text;
  for (const TextFile& one : *mine) text += one.name + "\n" + one.text;
  for (const char* there :
       {"Ada Lovelace", "floor", "learner.json", "session.csv", "self_mark.csv", "outbox.csv"})
    EXPECT_NE(text.find(there), std::string::npos) << there;
  for (const char* foreign : {"otter-5", "rater-1\r\n", "rater_id"})
    EXPECT_EQ(text.find(foreign), std::string::npos) << foreign;
  EXPECT_NE(text.find(made_session("kestrel-27", "waits").recording_hash), std::string::npos);
  const auto all = all_tables(store());
  ASSERT_TRUE(all) << all.error().text;
  text.clear();
  for (const TextFile& one : *all) text += one.name + "\n" + one.text;
  EXPECT_NE(text.find("kestrel-27,"), std::string::npos);
  EXPECT_NE(text.find("0.30000000000000004"), std::string::npos);  // to the bit
  EXPECT_EQ(text.find("Lovelace"), std::string::npos);
  EXPECT_EQ(base::table_cell("a,\"b\""), "\"a,\"\"b\"\"\"");
  EXPECT_FALSE(tables_of(store(), "nobody-1"));
}

}  // namespace
}  // namespace burr::school
