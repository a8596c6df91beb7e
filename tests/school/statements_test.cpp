// Statements for a learning record store, and the outbox in which they wait.
#include "burr/school/statements.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/lrs/sender.h"
#include "burr/net/client.h"
#include "burr/school/forget.h"
#include "burr/school/outbox.h"
#include "burr/school/sessions.h"
#include "school/made.h"

namespace burr::school {
namespace {

using Json = nlohmann::json;
using test::Folder;
using test::made_session;

constexpr const char* kHome = "https://centre.example";

class OutboxTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = Store::open(test::place_in(folder_));
    ASSERT_TRUE(opened) << opened.error().text;
    store_ = std::move(*opened);
    Learner learner;
    learner.id = "kestrel-27";
    ASSERT_TRUE(add(*store_, learner, {}));
  }
  [[nodiscard]] std::int64_t count(Sql sql) { return whole((*store_->database().rows(sql))[0][0]); }
  [[nodiscard]] std::int64_t statements() {
    return count("SELECT count(*) FROM outbox WHERE id <> 'settings'");
  }
  Folder folder_;
  std::unique_ptr<Store> store_;
};

TEST(Statements, SayTheSameEachTime) {
  const SessionRecord one = made_session("kestrel-27", "a");
  const auto first = statements_of(one, kHome), second = statements_of(one, kHome);
  ASSERT_EQ(first.size(), 2U);
  for (std::size_t n = 0; n < first.size(); ++n) {
    EXPECT_EQ(first[n].id, second[n].id);
    EXPECT_EQ(first[n].json, second[n].json);
    EXPECT_EQ(Json::parse(first[n].json)["id"], first[n].id);
  }
  EXPECT_NE(first[0].id, first[1].id);
  EXPECT_NE(statements_of(made_session("kestrel-27", "b"), kHome)[0].id, first[0].id);
}

TEST(Statements, ScoreOnlyWhatWasDeclaredDoneAndAssessed) {
  SessionRecord one = made_session("kestrel-27", "a");
  const auto result = [&] { return Json::parse(statements_of(one, kHome).back().json)["result"]; };
  EXPECT_DOUBLE_EQ(result()["score"]["scaled"], 0.665);
  EXPECT_FALSE(result().contains("success"));
  one.scores[0].total.reset();
  EXPECT_FALSE(result().contains("score"));
  one.scores[0].total = 80;
  one.finished = false;
  EXPECT_FALSE(result().contains("score"));
  EXPECT_FALSE(result()["completion"]);
}

TEST(Statements, StepsHaveDurationsOfTheirOwn) {
  SessionRecord one = made_session("kestrel-27", "a");
  one.metrics.push_back({"step_done second", "s", 40});
  one.metrics.push_back({"step_done first", "s", 12.5});
  const auto all = statements_of(one, kHome);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(Json::parse(all[1].json)["result"]["duration"], "PT12.50S");
  EXPECT_EQ(Json::parse(all[2].json)["result"]["duration"], "PT27.50S");
  EXPECT_FALSE(Json::parse(all[2].json)["result"].contains("score"));
}

TEST(Statements, OnlyAPersonsDecisionSaysPassedOrFailed) {
  const std::string session = session_id(made_session("kestrel-27", "a"));
  Decided decided = {"kestrel-27", "s1", "pass", "A. Berg", {"x", session}, 1'700'000'000'000};
  const auto passed = statement_of(decided, "block", kHome);
  ASSERT_TRUE(passed);
  const Json said = Json::parse(passed->json);
  EXPECT_EQ(said["verb"]["id"], "http://adlnet.gov/expapi/verbs/passed");
  EXPECT_EQ(said["result"]["success"], true);
  EXPECT_EQ(said["context"]["registration"], session);
  EXPECT_EQ(passed->json.find("Berg"), std::string::npos);
  decided.outcome = "fail";
  const auto failed = statement_of(decided, "block", kHome);
  ASSERT_TRUE(failed);
  EXPECT_EQ(Json::parse(failed->json)["result"]["success"], false);
  EXPECT_NE(failed->id, passed->id);
  for (const auto& change : std::vector<void (*)(Decided&)>{
           [](Decided& d) { d.confirmed_by.clear(); }, [](Decided& d) { d.sessions.clear(); },
           [](Decided& d) { d.outcome = "borderline"; }, [](Decided& d) { d.sessions = {"x"}; }}) {
    Decided other = decided;
    change(other);
    EXPECT_FALSE(statement_of(other, "block", kHome));
  }
}

TEST_F(OutboxTest, IsOffUntilItIsSwitchedOn) {
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));
  EXPECT_EQ(statements(), 0);
  ASSERT_TRUE(set_home_page(*store_, kHome));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));  // it was there before
  EXPECT_EQ(statements(), 0);
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "b")));
  EXPECT_EQ(statements(), 2);
  SessionRecord again = made_session("kestrel-27", "b");
  again.scored_by = "0.2.0";
  again.scores[0].total = 10;
  ASSERT_TRUE(enter(*store_, again));  // scored anew: the statement stays as it was said
  EXPECT_EQ(statements(), 2);
  ASSERT_TRUE(set_home_page(*store_, ""));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "c")));
  EXPECT_EQ(statements(), 2);
  for (const char* wrong : {"centre", "https://a b", "https://x\n"})
    EXPECT_FALSE(set_home_page(*store_, wrong)) << wrong;
}

TEST_F(OutboxTest, ComesWithTheSessionOrNotAtAll) {
  ASSERT_TRUE(set_home_page(*store_, kHome));
  // the session cannot be written to its end
  ASSERT_TRUE(store_->database().run("ALTER TABLE audit RENAME TO elsewhere"));
  EXPECT_FALSE(enter(*store_, made_session("kestrel-27", "a")));
  EXPECT_EQ(statements(), 0);
  ASSERT_TRUE(store_->database().run("ALTER TABLE elsewhere RENAME TO audit"));
  // nor can the statement
  ASSERT_TRUE(store_->database().run(
      "CREATE TRIGGER no BEFORE INSERT ON outbox BEGIN SELECT raise(ABORT, 'no'); END"));
  EXPECT_FALSE(enter(*store_, made_session("kestrel-27", "a")));
  EXPECT_EQ(count("SELECT count(*) FROM session"), 0);
  ASSERT_TRUE(store_->database().run("DROP TRIGGER no"));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));
  EXPECT_EQ(statements(), 2);
}

TEST_F(OutboxTest, WhatIsTriedIsNotTakenTwice) {
  ASSERT_TRUE(set_home_page(*store_, kHome));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));
  const auto first = take_due(*store_, 1000, 50, false);
  ASSERT_TRUE(first);
  ASSERT_EQ(first->size(), 2U);
  EXPECT_TRUE(take_due(*store_, 1000, 50, false)->empty());
  EXPECT_TRUE(take_due(*store_, 1000 + wait_after(1) - 1, 50, false)->empty());
  const auto later = take_due(*store_, 1000 + wait_after(1), 50, false);  // as after a kill
  ASSERT_EQ(later->size(), 2U);
  EXPECT_EQ(later->front().tries, 2);
  ASSERT_TRUE(mark_sent(*store_, {later->front().id}));
  EXPECT_EQ(take_due(*store_, 0, 50, true)->size(), 1U);
}

TEST_F(OutboxTest, ADecisionIsQueuedOnce) {
  ASSERT_TRUE(set_home_page(*store_, kHome));
  const SessionRecord one = made_session("kestrel-27", "a");
  ASSERT_TRUE(enter(*store_, one));
  const Decided decided = {"kestrel-27", "s1", "pass", "A. Berg", {session_id(one)}, 5};
  for (int n = 0; n < 2; ++n) ASSERT_TRUE(queue_decision(*store_, decided));
  EXPECT_EQ(statements(), 3);
  EXPECT_EQ(count("SELECT count(*) FROM outbox WHERE statement_json LIKE '%verbs/passed%' AND "
                  "statement_json LIKE '%cases/block%'"),
            1);
}

// Nobody knows whether it arrived: it is taken back all the same.
TEST_F(OutboxTest, ForgettingTakesBackWhatWasTried) {
  ASSERT_TRUE(set_home_page(*store_, kHome));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));
  const auto tried = take_due(*store_, 0, 1, true);
  ASSERT_EQ(tried->size(), 1U);
  const auto done = forget(*store_, "kestrel-27", {});
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_EQ(done->voided, 1U);
  EXPECT_EQ(statements(), 1);
  EXPECT_EQ(count("SELECT count(*) FROM outbox WHERE statement_json LIKE '%kestrel%'"), 0);
}

TEST_F(OutboxTest, AParkedSentenceNamesNobody) {
  ASSERT_TRUE(set_home_page(*store_, kHome));
  ASSERT_TRUE(enter(*store_, made_session("kestrel-27", "a")));
  const auto rows = take_due(*store_, 0, 1, true);
  const std::string session = session_id(made_session("kestrel-27", "a"));
  ASSERT_TRUE(park(*store_, rows->front(),
                   "400: kestrel-27 in " + session + " at " + rows->front().id + "\x1b[2J"));
  const auto now = outbox_status(*store_);
  ASSERT_TRUE(now);
  ASSERT_EQ(now->first_parked.size(), 1U);
  EXPECT_EQ(now->first_parked[0].why, "400: ... in ... at ...?[2J");
  EXPECT_EQ(now->parked, 1);
  EXPECT_EQ(*unpark(*store_), 1);
}

TEST(Sender, KnowsItsStatementAgain) {
  const std::string mine = statements_of(made_session("kestrel-27", "a"), kHome).back().json;
  Json other = Json::parse(mine);
  other["stored"] = "2026-11-28T00:00:00Z";
  other["timestamp"] = "2023-11-14T23:14:21.25+01:00";
  other["authority"] = {{"mbox", "mailto:x@example.org"}};
  other["version"] = "1.0.0";
  other["verb"]["display"] = {{"en", "finished"}};
  other["result"]["score"]["min"] = 0.0;
  EXPECT_TRUE(lrs::is_same(mine, other.dump()));
  for (const char* where : {"/actor/account/name", "/verb/id", "/object/id", "/result/duration",
                            "/context/registration", "/result/score/scaled"}) {
    Json changed = other;
    changed[Json::json_pointer(where)] = "x";
    EXPECT_FALSE(lrs::is_same(mine, changed.dump())) << where;
  }
  EXPECT_FALSE(lrs::is_same(mine, "{"));
}

TEST(HttpClient, ReadsAddresses) {
  const auto one = net::parse_url("https://lrs.example.org:8443/xapi?a=b#c");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->host, "lrs.example.org");
  EXPECT_EQ(one->port, "8443");
  EXPECT_EQ(one->target, "/xapi?a=b");
  EXPECT_EQ(net::parse_url("https://[::1]/x")->host, "::1");
  EXPECT_EQ(net::parse_url("https://h?x")->target, "/?x");
  EXPECT_TRUE(net::parse_url("http://127.0.0.1:80/"));
  for (const char* wrong :
       {"", "ftp://h/", "https://", "https://a:b@h/", "https://h:x/", "https://h /",
        "http://h.example/", "http://127.0.0.1.example/", "https://h\r\nX: y/", "h"})
    EXPECT_FALSE(net::parse_url(wrong)) << wrong;
  EXPECT_EQ(net::escaped("a b&\"ä"), "a%20b%26%22%C3%A4");
  EXPECT_EQ(net::unescaped("a%20b+c%2"), "a b c%2");
}

}  // namespace
}  // namespace burr::school
