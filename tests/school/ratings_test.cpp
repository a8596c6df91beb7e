// Marks by persons, standards and decisions, and the store as tables of `burr study`: in a file and on a server.
#include "burr/school/ratings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "burr/people/random_stream.h"
#include "burr/school/audit_check.h"
#include "burr/school/decisions.h"
#include "burr/school/enrolled.h"
#include "burr/school/export.h"
#include "burr/school/forget.h"
#include "burr/school/outbox.h"
#include "burr/school/sessions.h"
#include "burr/school/study/table.h"
#include "burr/school/study_tables.h"
#include "school/made.h"
#include "support/postgres_server.h"

namespace burr::school {
namespace {

using test::Folder;
using test::made_session;
using test::PostgresServer;

PostgresServer& ratings_server() {
  static PostgresServer one;
  return one;
}

enum class Place { file, server };

class RatingsTest : public ::testing::TestWithParam<Place> {
 protected:
  void SetUp() override {
    place_ = test::place_in(folder_);
    if (GetParam() == Place::server) {
      BURR_NEEDS_POSTGRES(ratings_server());
      place_.address = ratings_server().address();
      auto raw = open_postgres(place_.address, "server", {});
      ASSERT_TRUE(raw) << raw.error().text;
      for (const Sql one :
           {Sql("DROP SCHEMA IF EXISTS public CASCADE"), Sql("CREATE SCHEMA public"),
            Sql("DROP SCHEMA IF EXISTS names CASCADE")})
        ASSERT_TRUE((*raw)->run(one));
    }
    auto opened = Store::open(place_);
    ASSERT_TRUE(opened) << opened.error().text;
    store_ = std::move(*opened);
  }
  Store& store() { return *store_; }
  void add_learner(const std::string& id, const std::string& level = "PGY2") {
    Learner learner;
    learner.id = id;
    learner.level = level;
    const Status added = add(store(), learner, {});
    ASSERT_TRUE(added) << added.error().text;
  }
  // Its id. n: of the learner's sessions, by time.
  std::string session(const std::string& learner, int n, double points = 66.5, bool guided = false,
                      bool finished = true, std::int64_t gates = 0) {
    SessionRecord one = made_session(learner, std::to_string(n), 1'700'000'000'000 + n * 1000);
    one.guided = guided;
    one.finished = finished;
    one.scores[0].total = points;
    one.scores[0].gates_broken = gates;
    if (sealed_ && !station_) station_.emplace(store(), folder_.str());
    if (sealed_) one = station_->sealed(one);
    const auto entered = enter(store(), one);
    EXPECT_TRUE(entered) << entered.error().text;
    return session_id(one);
  }
  std::int64_t count(Sql sql) { return whole((*store().database().rows(sql))[0][0]); }
  std::string trouble(const Marking& marking) {
    const Status done = mark(store(), marking);
    return done ? std::string() : done.error().text;
  }

  static constexpr const char* kRubric = "0x00000000000000bb";
  Folder folder_;
  StorePlace place_;
  std::unique_ptr<Store> store_;
  std::optional<test::MadeStation> station_;
  bool sealed_ = true;  // the sessions
  const SigningKey* station_key() const { return &station_->key(); }
};
INSTANTIATE_TEST_SUITE_P(Both, RatingsTest, ::testing::Values(Place::file, Place::server),
                         [](const auto& about) {
                           return about.param == Place::file ? "File" : "Server";
                         });

std::vector<std::string> ids_of(const std::vector<Product>& queue) {
  std::vector<std::string> out;
  for (const Product& one : queue) out.push_back(one.session);
  return out;
}

TEST_P(RatingsTest, TheQueueIsRandomAndHoldsWhatThisRaterHasNotMarked) {
  add_learner("kestrel-27");
  add_learner("otter-5");
  std::vector<std::string> all;
  for (int n = 0; n < 12; ++n) all.push_back(session(n % 2 == 0 ? "kestrel-27" : "otter-5", n));
  const std::string unfinished = session("kestrel-27", 20, 50, false, false);
  const auto first = to_mark(store(), "A. Berg", "", 7), again = to_mark(store(), "A. Berg", "", 7),
             other = to_mark(store(), "A. Berg", "", 8);
  ASSERT_TRUE(first && again && other) << first.error().text;
  EXPECT_EQ(ids_of(*first), ids_of(*again));
  EXPECT_NE(ids_of(*first), ids_of(*other));
  std::vector<std::string> sorted = ids_of(*first);
  std::sort(sorted.begin(), sorted.end());
  EXPECT_NE(sorted, ids_of(*first));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(sorted, all);  // not the unfinished one
  // what is marked is gone from this rater's queue alone
  ASSERT_EQ(trouble({all[3], "A. Berg", true, {{"floor", "met", ""}}}), "");
  EXPECT_EQ(to_mark(store(), "A. Berg", "", 7)->size(), 11U);
  EXPECT_EQ(to_mark(store(), "B. Dahl", "", 7)->size(), 12U);
  // marks of somebody who saw more are no blinded ones
  ASSERT_EQ(trouble({all[4], "A. Berg", false, {{"floor", "met", ""}}}), "");
  EXPECT_EQ(to_mark(store(), "A. Berg", "", 7)->size(), 11U);
  EXPECT_EQ(to_mark(store(), "A. Berg", kRubric, 7)->size(), 11U);
  EXPECT_EQ(to_mark(store(), "A. Berg", "0xother", 7)->size(), 0U);
  EXPECT_EQ(to_mark(store(), "otter-5", "", 7)->size(), 6U);  // not the own ones
}

TEST_P(RatingsTest, KeepsMarksOnceAndAllOrNothing) {
  add_learner("kestrel-27");
  const std::string id = session("kestrel-27", 1),
                    open = session("kestrel-27", 2, 50, false, false);
  ASSERT_EQ(
      trouble({id, "A. Berg", true, {{"floor", "met", ""}, {"order", "not assessable", "dark"}}}),
      "");
  const auto rows = rater_marks(store(), id);
  ASSERT_TRUE(rows) << rows.error().text;
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ((*rows)[0].item, "floor");
  EXPECT_EQ((*rows)[0].mark, "met");
  EXPECT_EQ((*rows)[1].mark, "not assessable");
  EXPECT_EQ((*rows)[1].reason, "dark");
  EXPECT_TRUE((*rows)[1].blinded);
  EXPECT_GT((*rows)[1].made_ms, 0);
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'marked by a person'"), 1);
  // refused, each with a sentence, and nothing of it is kept
  const std::string control = "a\nb";
  for (const Marking& bad :
       {Marking{id, "A. Berg", true, {{"wall", "met", ""}, {"floor", "unmet", ""}}},
        Marking{id, "A. Berg", true, {{"wall", "good", ""}}},
        Marking{id, "A. Berg", true, {{"roof", "met", ""}}},
        Marking{id, "A. Berg", true, {{"wall", "met", ""}, {"wall", "met", ""}}},
        Marking{id, "A. Berg", true, {{"wall", "met", control}}},
        Marking{id, "A. Berg", true, {{"wall", "met", std::string(kLongestReason + 1, 'x')}}},
        Marking{id, "A. Berg", true, {}}, Marking{id, "", true, {{"wall", "met", ""}}},
        Marking{id, "machine", true, {{"wall", "met", ""}}},
        Marking{id, control, true, {{"wall", "met", ""}}},
        Marking{id, "kestrel-27", true, {{"wall", "met", ""}}},
        Marking{open, "A. Berg", true, {{"wall", "met", ""}}},
        Marking{"no-such", "A. Berg", true, {{"wall", "met", ""}}}})
    EXPECT_NE(trouble(bad), "") << bad.session << " " << bad.rater;
  EXPECT_EQ(count("SELECT count(*) FROM rater_mark"), 2);
  EXPECT_EQ(trouble({id, "A. Berg", true, {{"wall", "met", ""}}}), "");  // the rest of the items
}

TEST_P(RatingsTest, AForgottenRaterIsInNoAgreement) {
  add_learner("kestrel-27");
  add_learner("otter-5");
  const std::string id = session("kestrel-27", 1);
  ASSERT_EQ(trouble({id, "otter-5", true, {{"floor", "met", ""}}}), "");
  ASSERT_EQ(trouble({id, "A. Berg", true, {{"floor", "met", ""}}}), "");
  ASSERT_TRUE(forget(store(), "otter-5", {}));
  EXPECT_EQ(count("SELECT count(*) FROM rater_mark WHERE rater_id = 'forgotten'"), 1);
  const auto table = ratings_table(store(), kRubric);
  ASSERT_TRUE(table) << table.error().text;
  for (const auto& row : table->rows) EXPECT_NE(row[1], "forgotten");
}

Standard made_standard(double cut) {
  Standard one;
  one.rubric_hash = "0x00000000000000bb";
  one.part = "product";
  one.method = "contrasting groups";
  one.cut = cut;
  one.n_low = 8;
  one.n_high = 9;
  one.false_pass = 0.125;
  one.false_fail = 0.25;
  one.text = "levels PGY1 against surgeon";
  one.set_by = "A. Berg";
  return one;
}

TEST_P(RatingsTest, AStandardNeedsEnoughPeopleAndAPerson) {
  add_learner("kestrel-27");
  session("kestrel-27", 1);
  const auto id = set_standard(store(), made_standard(62.5));
  ASSERT_TRUE(id) << id.error().text;
  const auto all = standards(store());
  ASSERT_EQ(all->size(), 1U);
  const Standard& kept = all->front();
  EXPECT_EQ(kept.id, *id);
  EXPECT_EQ(kept.cut, 62.5);
  EXPECT_EQ(kept.n_low, 8);
  EXPECT_EQ(kept.n_high, 9);
  EXPECT_EQ(kept.judges, std::nullopt);
  EXPECT_EQ(kept.false_pass, 0.125);
  EXPECT_EQ(kept.false_fail, 0.25);
  EXPECT_EQ(kept.set_by, "A. Berg");
  EXPECT_EQ(kept.rubric, "block rubric");
  EXPECT_EQ(standard_in(store(), id->substr(0, 8))->id, *id);
  EXPECT_FALSE(standard_in(store(), "zz"));
  const auto refused = [&](auto change) {
    Standard one = made_standard(62.5);
    change(one);
    const auto done = set_standard(store(), one);
    EXPECT_FALSE(done);
    return done ? std::string() : done.error().text;
  };
  EXPECT_NE(refused([](Standard& s) { s.n_low = 7; }).find("8 people"), std::string::npos);
  refused([](Standard& s) { s.n_high.reset(); });
  refused([](Standard& s) { s.set_by = ""; });
  refused([](Standard& s) { s.set_by = "machine"; });
  refused([](Standard& s) { s.cut = 0; });
  refused([](Standard& s) { s.cut = 100.5; });
  refused([](Standard& s) { s.part = "all"; });
  refused([](Standard& s) { s.rubric_hash = "0x1"; });
  for (const char* method : {"Angoff", "Hofstee"})
    EXPECT_NE(refused([&](Standard& s) {
                s.method = method;
                s.judges = 4;
              }).find("5 judges"),
              std::string::npos);
  EXPECT_EQ(count("SELECT count(*) FROM standard"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'standard set'"), 1);
}

TEST_P(RatingsTest, ProposesAfterTwoSessionsInARowWithNoGateBroken) {
  add_learner("kestrel-27");
  session("kestrel-27", 1, 80);
  const Standard standard = [&] {
    const auto id = set_standard(store(), made_standard(60));
    return *standard_in(store(), *id);
  }();
  const auto reached = [&] { return proposal(store(), standard, "kestrel-27")->reached; };
  EXPECT_FALSE(reached());
  session("kestrel-27", 2, 59.9);
  session("kestrel-27", 3, 80);
  EXPECT_FALSE(reached());  // two, but not one after the other
  session("kestrel-27", 4, 90, false, true, 1);
  EXPECT_FALSE(reached());  // a gate
  session("kestrel-27", 5, 80);
  session("kestrel-27", 6, 95, true);  // with guidance, and unfinished: as if they were not there
  session("kestrel-27", 7, 20, false, false);
  EXPECT_FALSE(reached());
  session("kestrel-27", 8, 60);  // at the cut
  const auto said = proposal(store(), standard, "kestrel-27");
  ASSERT_TRUE(said) << said.error().text;
  EXPECT_TRUE(said->reached);
  EXPECT_EQ(said->sessions.size(), 6U);
  EXPECT_EQ(said->first, 4U);
  EXPECT_TRUE(proposal(store(), standard, "otter-5")->sessions.empty());
  const auto all = proposals(store(), standard);
  ASSERT_EQ(all->size(), 1U);
  EXPECT_TRUE(all->front().second.reached);
}

TEST_P(RatingsTest, WhatIsNotSealedProposesNothingAndSetsNoStandard) {
  sealed_ = false;
  add_learner("kestrel-27", "PGY1");
  add_learner("otter-5", "surgeon");
  for (int n = 1; n < 4; ++n) session("kestrel-27", n, 90);
  session("otter-5", 1, 90);
  const std::string id = *set_standard(store(), made_standard(60));
  EXPECT_TRUE(proposal(store(), *standard_in(store(), id), "kestrel-27")->sessions.empty());
  EXPECT_FALSE(groups_table(store(), kRubric, "product", {"PGY1"}, {"surgeon"}));
  EXPECT_FALSE(marks_table(store(), kRubric, "product", Which::sealed));
  EXPECT_TRUE(marks_table(store(), kRubric, "product"));  // the curve shows them
  const auto key = SigningKey::make(folder_ / "a.key", "a-berg");
  ASSERT_TRUE(enrol(store(), {key->name(), key->public_key(), "decider"}));
  const auto none = decide(store(), {"kestrel-27", id, "pass", "", "because"}, &*key);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("no sealed, finished session"), std::string::npos);
  const auto rows = sessions_of(store(), "");
  ASSERT_TRUE(rows);
  for (const SessionRow& row : *rows) EXPECT_EQ(row.standing, "no seal");
}

TEST_P(RatingsTest, ADecisionHasAPersonAReasonAStandardAndItsSessions) {
  add_learner("kestrel-27");
  add_learner("otter-5");
  const std::string first = session("kestrel-27", 1, 80), second = session("kestrel-27", 2, 80);
  const auto key = SigningKey::make(folder_ / "a.key", "a-berg"),
             unknown = SigningKey::make(folder_ / "b.key", "b-smith"),
             own = SigningKey::make(folder_ / "c.key", "kestrel-27"),
             gone = SigningKey::make(folder_ / "d.key", "d-lind");
  for (const auto* one : {&*key, &*own, &*gone})
    ASSERT_TRUE(enrol(store(), {one->name(), one->public_key(), "decider"}));
  ASSERT_TRUE(revoke(store(), "d-lind"));
  EXPECT_FALSE(decide(store(), {"kestrel-27", "any", "pass", "", "well done"}, &*key));
  const std::string standard = *set_standard(store(), made_standard(60));
  EXPECT_EQ(count("SELECT count(*) FROM decision"), 0);  // a proposal is no decision
  for (const Decision& bad : {Decision{"kestrel-27", standard, "passed", "", "because"},
                              Decision{"kestrel-27", standard, "pass", "", " "},
                              Decision{"kestrel-27", "zz", "pass", "", "because"},
                              Decision{"nobody-1", standard, "pass", "", "because"},
                              Decision{"otter-5", standard, "pass", "", "because"}})
    EXPECT_FALSE(decide(store(), bad, &*key)) << bad.learner << " " << bad.outcome;
  // a name that somebody types is no proof; nor is a key that the store does not know, or one's own
  const Decision typed = {"kestrel-27", standard, "pass", "A. Berg", "because"};
  for (const auto* one : {&*unknown, &*own, &*gone, &*station_key()})
    EXPECT_FALSE(decide(store(), typed, one)) << one->name();
  if (GetParam() == Place::file) {
    EXPECT_FALSE(decide(store(), typed));
  }
  EXPECT_EQ(count("SELECT count(*) FROM decision"), 0);
  ASSERT_TRUE(set_home_page(store(), "https://centre.example.org"));
  const auto done = decide(store(), {"kestrel-27", standard, "fail", "", "seen in the lab"}, &*key);
  ASSERT_TRUE(done) << done.error().text;
  const auto kept = decisions(store(), "kestrel-27");
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_EQ(kept->front().id, done->id);
  EXPECT_EQ(kept->front().outcome, "fail");  // a person may decide against the proposal
  EXPECT_EQ(kept->front().confirmed_by, "a-berg");
  EXPECT_TRUE(signed_by(key->public_key(), decision_words(kept->front()), done->signature));
  ASSERT_TRUE(check_audit(store(), "")) << check_audit(store(), "").error().text;
  EXPECT_EQ(kept->front().reason, "seen in the lab");
  EXPECT_EQ(kept->front().standard, standard);
  EXPECT_EQ(kept->front().sessions, (std::vector<std::string>{first, second}));
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'decision recorded' AND "
                  "subject = 'kestrel-27'"),
            1);
  // the learning record store hears of it, and not who decided
  const auto told =
      store().database().rows("SELECT statement_json FROM outbox WHERE state = 'waiting'");
  ASSERT_EQ(told->size(), 1U);
  EXPECT_NE(text((*told)[0][0]).find("verbs/failed"), std::string::npos);
  EXPECT_EQ(text((*told)[0][0]).find("berg"), std::string::npos);
  if (GetParam() ==
      Place::server) {  // there a login says who it is, and that of the tables' owner is nobody
    const auto by_login =
        decide(store(), {"kestrel-27", standard, "pass", "A. Berg", "as proposed"});
    ASSERT_FALSE(by_login);
    EXPECT_NE(by_login.error().text.find("who confirms burr: this must be a person"),
              std::string::npos);
  }
  ASSERT_TRUE(
      store().database().run("UPDATE decision SET outcome = 'pass' WHERE outcome = 'fail'"));
  const auto changed = check_audit(store(), "");
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().text.find("its signature does not fit it"), std::string::npos);
}

TEST_P(RatingsTest, ANameOfWhoSetAStandardIsForgottenToo) {
  add_learner("kestrel-27");
  add_learner("otter-5");
  session("otter-5", 1);
  Standard one = made_standard(60);
  one.set_by = "kestrel-27";
  ASSERT_TRUE(set_standard(store(), one));
  ASSERT_TRUE(forget(store(), "kestrel-27", {}));
  EXPECT_EQ(standards(store())->front().set_by, "forgotten");
}

// ---- tables

// A table of the export, by the names of its columns.
std::vector<std::map<std::string, std::string>> exported(const std::vector<TextFile>& files,
                                                         const std::string& name,
                                                         const std::vector<std::string>& columns) {
  std::vector<std::map<std::string, std::string>> out;
  for (const TextFile& file : files) {
    if (file.name != name) continue;
    const auto table = study::parse_table(file.text, name, columns);
    EXPECT_TRUE(table) << table.error().text;
    for (const auto& row : table->rows) {
      auto& one = out.emplace_back();
      for (std::size_t n = 0; n < columns.size(); ++n) one[columns[n]] = row[n];
    }
  }
  return out;
}

void fill_class(Store& store) {
  people::RandomStream random(3);
  for (int person = 0; person < 9; ++person) {
    Learner learner;
    learner.id = "heron-" + std::to_string(person);
    learner.level = person < 4 ? "PGY1" : "surgeon";
    ASSERT_TRUE(add(store, learner, {}));
    for (int n = 0; n < 6; ++n) {
      SessionRecord one = made_session(learner.id, std::to_string(n), 1'700'000'000'000 - n * 1000);
      one.guided = n == 4;
      one.finished = n != 2;
      one.scores[0].total = 100 * random.uniform();
      if (n == 1) one.scores[0].total.reset();
      one.scores[0].items[0].result = random.uniform() < 0.6 ? "met" : "unmet";
      ASSERT_TRUE(enter(store, one));
      if (n == 0) {  // scored again by a newer burr, which counts
        one.scored_by = "0.2.0";
        one.scores[0].total = 100 * random.uniform();
        one.scores[0].made_ms += 1000;
        one.scores[1].made_ms += 1000;
        ASSERT_TRUE(enter(store, one));
      }
      if (n == 2) continue;
      for (const char* rater : {"A. Berg", "B, \"Dahl\""})
        ASSERT_TRUE(
            mark(store, {session_id(one),
                         rater,
                         true,
                         {{"floor", random.uniform() < 0.7 ? "met" : "unmet", ""},
                          {"wall", random.uniform() < 0.8 ? "met" : "not assessable", ""}}}));
    }
  }
}

TEST_P(RatingsTest, TablesAreThoseThatTheExportGives) {
  fill_class(store());
  if (HasFatalFailure()) return;
  const auto files = all_tables(store());
  ASSERT_TRUE(files) << files.error().text;
  // joined anew, from the files alone
  std::map<std::string, std::map<std::string, std::string>> sessions, newest;
  for (auto& one :
       exported(*files, "session.csv",
                {"id", "learner_id", "case_hash", "started_ms", "guided", "finished", "attempt"}))
    sessions[one["id"]] = one;
  for (auto& one : exported(*files, "score.csv",
                            {"id", "session_id", "rubric_hash", "part", "total", "made_ms"})) {
    auto& kept = newest[one["session_id"] + one["part"]];
    if (kept.empty() || std::stoll(kept["made_ms"]) < std::stoll(one["made_ms"])) kept = one;
  }
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> wanted;
  for (auto& [key, score] : newest) {
    auto& session = sessions[score["session_id"]];
    if (score["part"] != "product" || session["finished"] != "1" || score["total"].empty())
      continue;
    wanted[{session["learner_id"], session["started_ms"]}] = {
        session["learner_id"], score["total"], session["attempt"], session["case_hash"],
        session["guided"]};
  }
  const auto marks = marks_table(store(), kRubric, "product");
  ASSERT_TRUE(marks) << marks.error().text;
  ASSERT_EQ(marks->rows.size(), wanted.size());
  std::size_t n = 0;
  for (const auto& [key, row] : wanted) EXPECT_EQ(marks->rows[n++], row);
  EXPECT_EQ(n, 9U * 4);
  // ratings
  std::set<std::vector<std::string>> given, rated;
  std::set<std::string> marked, items;
  const auto put = [&](const std::string& product, const std::string& rater,
                       const std::string& item, const std::string& mark) {
    if (mark != "not assessable") given.insert({product, rater, item, mark == "met" ? "1" : "0"});
  };
  for (auto& one : exported(*files, "rater_mark.csv",
                            {"session_id", "rater_id", "item_id", "mark", "blinded"})) {
    put(one["session_id"], one["rater_id"], one["item_id"], one["mark"]);
    marked.insert(one["session_id"]);
    items.insert(one["item_id"]);
  }
  std::map<std::string, std::string> session_of_score;
  for (auto& [key, score] : newest) session_of_score[score["id"]] = score["session_id"];
  for (auto& one : exported(*files, "item.csv", {"score_id", "item_id", "result"}))
    if (const std::string& of = session_of_score[one["score_id"]];
        marked.contains(of) && items.contains(one["item_id"]))
      put(of, "machine", one["item_id"], one["result"]);
  const auto ratings = ratings_table(store(), kRubric);
  ASSERT_TRUE(ratings) << ratings.error().text;
  for (const auto& row : ratings->rows) rated.insert(row);
  EXPECT_EQ(rated.size(), ratings->rows.size());
  EXPECT_EQ(rated, given);
  // and as a file, read back
  const auto back = study::parse_table(csv_of(*ratings), "r.csv", ratings->columns);
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(back->rows, ratings->rows);
}

TEST_P(RatingsTest, GroupsHoldEachPersonOnceWithTheLastMark) {
  add_learner("kestrel-27", "PGY1");
  add_learner("otter-5", "surgeon");
  add_learner("wren-9", "PGY3");
  session("kestrel-27", 1, 20);
  session("kestrel-27", 2, 30);
  session("kestrel-27", 3, 99, true);  // guided
  session("otter-5", 1, 80);
  session("wren-9", 1, 50);
  const auto table = groups_table(store(), kRubric, "product", {"PGY1", "PGY2"}, {"surgeon"});
  ASSERT_TRUE(table) << table.error().text;
  EXPECT_EQ(table->rows, (std::vector<std::vector<std::string>>{{"low", "30"}, {"high", "80"}}));
  EXPECT_FALSE(groups_table(store(), kRubric, "product", {"PGY1"}, {"PGY1"}));
  EXPECT_FALSE(groups_table(store(), kRubric, "product", {"PGY8"}, {"PGY9"}));
}

}  // namespace
}  // namespace burr::school
