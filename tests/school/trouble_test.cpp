// What goes wrong in a centre: a store that is locked, a full disk, a server that stops, hangs, or cuts connections.
// Nothing is lost, and nothing comes twice.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/school/audit_check.h"
#include "burr/school/decisions.h"
#include "burr/school/enrolled.h"
#include "burr/school/forget.h"
#include "burr/school/pending.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "school/made.h"
#include "support/postgres_server.h"
#include "support/test_places.h"

namespace burr::school {
namespace {

using test::Folder;
using test::made_session;
using test::PostgresServer;

std::unique_ptr<Store> opened(const StorePlace& place) {
  auto store = Store::open(place);
  EXPECT_TRUE(store) << store.error().text;
  return store ? std::move(*store) : nullptr;
}

void add_learner(Store& store, const std::string& id, const Person& person = {}) {
  Learner learner;
  learner.id = id;
  const Status added = add(store, learner, person);
  ASSERT_TRUE(added) << added.error().text;
}

std::size_t waits(const StorePlace& place) {
  std::vector<std::string> notices;
  return waiting(place, notices).size();
}

// What waits comes in, once.
void comes_in_once(const StorePlace& place, std::size_t waited, std::size_t sessions) {
  EXPECT_EQ(waits(place), waited);
  auto store = opened(place);
  const TakenIn in = take_in(*store, {});
  EXPECT_EQ(in.taken, waited);
  EXPECT_EQ(in.left, 0U);
  EXPECT_EQ(in.notices, std::vector<std::string>{});
  EXPECT_EQ(waits(place), 0U);
  EXPECT_EQ(take_in(*store, {}).taken, 0U);
  EXPECT_EQ(sessions_of(*store, "")->size(), sessions);
}

bool holds(const std::filesystem::path& folder, const std::string& text) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(StoreTrouble, NoByteOfAForgottenLearnerIsLeft) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27", {"Ada Lovelace", "ada@example.org", "S-1815"});
  add_learner(*store, "otter-5", {"Grace Hopper", "", ""});
  // many, so that rows lie on pages of their own
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(enter(*store, made_session("kestrel-27", std::to_string(n))));
    ASSERT_TRUE(enter(*store, made_session("otter-5", std::to_string(n))));
  }
  ASSERT_TRUE(keep(place, made_session("kestrel-27", "waits")));
  // torn, damaged before, left by a burr that was killed; and what only looks like it, or is of another store
  for (const char* name : {"torn.json", "odd.json.damaged", "x.json.part-12-1"})
    std::ofstream(place.pending / name) << R"({"learner":"kestrel-27", "name)";
  std::ofstream(place.pending / "near.json.damaged") << R"({"learner":"kestrel-270", )";
  StorePlace foreign = place;
  foreign.address = "/elsewhere/school.sqlite";
  ASSERT_TRUE(keep(foreign, made_session("kestrel-27b", "waits")));
  const std::vector<std::string> gone = {"kestrel-27", "Ada Lovelace", "ada@example.org", "S-1815",
                                         session_id(made_session("kestrel-27", "7"))};
  for (const std::string& one : gone) EXPECT_TRUE(holds(folder.path(), one)) << one;
  const auto done = forget(*store, "kestrel-27", {{}, {"a file (it cannot be read)"}, {}});
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_EQ(done->notices.size(), 1U);  // the torn one
  EXPECT_EQ(done->unreached, std::vector<std::string>{"a file (it cannot be read)"});
  for (const char* name : {"torn.json.damaged", "odd.json.damaged", "x.json.part-12-1"})
    EXPECT_FALSE(std::filesystem::exists(place.pending / name)) << name;
  std::vector<std::string> notices;
  EXPECT_EQ(waiting(foreign, notices).size(), 1U);
  EXPECT_TRUE(holds(place.pending, "kestrel-270"));
  std::filesystem::remove_all(place.pending);
  for (const std::string& one : gone) EXPECT_FALSE(holds(folder.path(), one)) << one;
  store.reset();
  for (const std::string& one : gone) EXPECT_FALSE(holds(folder.path(), one)) << one;
  EXPECT_TRUE(holds(folder.path(), "otter-5"));
  EXPECT_TRUE(holds(folder.path(), "Grace Hopper"));
}

// Both files are written one after the other: the store may go and the names stay.
TEST(StoreTrouble, ANameDoesNotOutliveItsLearner) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27", {"Ada Lovelace", "", ""});
  Database& in = store->database();
  ASSERT_TRUE(in.rows("PRAGMA main.wal_checkpoint(TRUNCATE)"));
  // the names' log is long, the store's short: a size between lets only the store be written
  for (int n = 0; n < 100; ++n)
    ASSERT_TRUE(in.run("UPDATE names.person SET mail = $1", {std::to_string(n)}));
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 300'000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto torn = forget(*store, "kestrel-27", {});
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_FALSE(torn);
  EXPECT_TRUE(*has(*store, "kestrel-27"));  // a name without its learner would be found by nobody
  const auto done = forget(*store, "kestrel-27", {});
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_FALSE(holds(folder.path(), "Lovelace"));
  EXPECT_FALSE(holds(folder.path(), "kestrel-27"));
  EXPECT_FALSE(forget(*store, "kestrel-27", {}));
}

TEST(StoreTrouble, ANameWithoutALearnerIsForgottenAndGoesToNobody) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  const auto orphan = [&] {  // as a store left it whose names could not be written
    return store->database().run(
        "INSERT INTO names.person (learner_id, name) VALUES ('kestrel-27', 'Ada Lovelace')");
  };
  ASSERT_TRUE(orphan());
  const auto done = forget(*store, "kestrel-27", {});
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_FALSE(holds(folder.path(), "Lovelace"));
  ASSERT_TRUE(orphan());
  add_learner(*store, "kestrel-27");
  EXPECT_TRUE(learners(*store, true)->front().person.empty());
  // the file of names is gone
  ASSERT_TRUE(store->database().run("DROP TABLE names.person"));
  store = opened(place);
  add_learner(*store, "otter-5", {"Grace Hopper", "", ""});
}

TEST(StoreTrouble, TwoWaysToAFileAreOneStore) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "a");
  const auto one = place_of(folder / "school.sqlite", {});
  const auto other = place_of(folder / "a/../school.sqlite", {});
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->address, other->address);
  StorePlace old = *one;  // as an older burr wrote it
  old.address = folder / "a/../school.sqlite";
  ASSERT_TRUE(keep(old, made_session("kestrel-27", "a")));
  old.address = folder / "b.sqlite";
  ASSERT_TRUE(keep(old, made_session("kestrel-27", "a")));
  std::vector<std::string> notices;
  std::size_t others = 0;
  EXPECT_EQ(waiting(*one, notices, &others).size(), 1U);
  EXPECT_EQ(others, 1U);
}

TEST(StoreTrouble, ARecordingOnADiskThatIsAwayGoesOnWaiting) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27");
  ASSERT_TRUE(keep(place, WaitingRecording{folder / "disk/s.mcap", "kestrel-27", ""}));
  const TakenIn in = take_in(*store, {});
  EXPECT_EQ(in.left, 1U);
  EXPECT_EQ(in.notices.size(), 1U);
  EXPECT_EQ(waits(place), 1U);
}

TEST(StoreTrouble, SaysWhereBytesMayBeLeftWhileSomebodyReads) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27");
  auto reader = open_sqlite(place.address, names_file(place.address), place.waits);
  ASSERT_TRUE((*reader)->run("BEGIN"));
  ASSERT_TRUE((*reader)->rows("SELECT * FROM learner"));
  const auto done = forget(*store, "kestrel-27", {});
  ASSERT_TRUE(done) << done.error().text;
  ASSERT_EQ(done->notices.size(), 1U);
  EXPECT_NE(done->notices[0].find("`school::scrub`"), std::string::npos);
  ASSERT_TRUE((*reader)->run("COMMIT"));
  ASSERT_TRUE(scrub(*store));
  EXPECT_FALSE(holds(folder.path(), "kestrel-27"));
}

TEST(StoreTrouble, ALockedFileMakesSessionsWait) {
  EXPECT_EQ(Waits().lock_ms, 5000);
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  add_learner(*opened(place), "kestrel-27");
  auto other = open_sqlite(place.address, names_file(place.address), place.waits);
  ASSERT_TRUE((*other)->begin());
  const SessionRecord one = made_session("kestrel-27", "a");
  for (int n = 0; n < 2; ++n) {  // the second time it takes the place of the first
    const auto kept = enter_or_keep(place, one);
    ASSERT_TRUE(kept) << kept.error().text;
    EXPECT_FALSE(kept->stored);
    EXPECT_NE(kept->why.find("another program writes"), std::string::npos) << kept->why;
  }
  {  // still locked: it goes on waiting
    auto store = opened(place);
    const TakenIn in = take_in(*store, {});
    EXPECT_EQ(in.left, 1U);
  }
  (*other)->rollback();
  comes_in_once(place, 1, 1);
  std::vector<std::string> notices;
  ASSERT_TRUE(keep(place, one));  // as if burr was killed before it deleted the file
  EXPECT_EQ(take_in(*opened(place), {}).taken, 1U);
  EXPECT_EQ(sessions_of(*opened(place), "")->size(), 1U);
}

TEST(StoreTrouble, AFullDiskMakesSessionsWait) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27");
  const auto pages = store->database().rows("PRAGMA page_count");
  ASSERT_TRUE(store->database().rows("PRAGMA max_page_count = 1"));  // no more than there are
  Result<Entered> entered = Entered{};
  int n = 0;
  for (; n < 200 && entered; ++n)
    entered = enter(*store, made_session("kestrel-27", std::to_string(n)));
  ASSERT_FALSE(entered);
  EXPECT_EQ(entered.error().trouble, Trouble::io);
  EXPECT_NE(entered.error().text.find("the disk is full"), std::string::npos);
  const std::size_t whole_ones = sessions_of(*store, "")->size();
  EXPECT_EQ(whole_ones, static_cast<std::size_t>(n - 1));  // the last one left nothing
  EXPECT_EQ(whole((*store->database().rows("SELECT count(*) FROM score"))[0][0]), 2 * (n - 1));
}

TEST(StoreTrouble, AFileThatMayNotGrowMakesSessionsWait) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  add_learner(*opened(place), "kestrel-27");
  std::signal(SIGXFSZ, SIG_IGN);  // as burr does
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 8000;  // a session that waits has 4000 bytes; the store cannot be written
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto kept = enter_or_keep(place, made_session("kestrel-27", "a"));
  small.rlim_cur = 100;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto lost = enter_or_keep(place, made_session("kestrel-27", "b"));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_FALSE(kept->stored);
  ASSERT_FALSE(lost);  // said, not hidden; the recording is there still
  EXPECT_EQ(lost.error().trouble, Trouble::io);
  comes_in_once(place, 1, 1);
}

TEST(StoreTrouble, ATornFileIsSetAsideAndForeignOnesStay) {
  const Folder folder;
  StorePlace place = test::place_in(folder);
  add_learner(*opened(place), "kestrel-27");
  ASSERT_TRUE(keep(place, made_session("kestrel-27", "a")));
  std::ofstream(place.pending / "torn.json") << "{\"store\": \"" << place.address << "\", \"sess";
  std::ofstream(place.pending / "odd.json")
      << "{\"store\": \"" << place.address << "\", \"session\": {\"learner\": 5}}";
  StorePlace other = place;
  other.address = folder / "other.sqlite";
  ASSERT_TRUE(keep(other, made_session("kestrel-27", "b")));
  const TakenIn in = take_in(*opened(place), {});
  EXPECT_EQ(in.taken, 1U);
  EXPECT_EQ(in.notices.size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(place.pending / "torn.json.damaged"));
  EXPECT_TRUE(std::filesystem::exists(place.pending / "odd.json.damaged"));
  EXPECT_EQ(waits(other), 1U);
}

TEST(StoreTrouble, ASessionOfAForgottenLearnerDoesNotComeBack) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  ASSERT_TRUE(keep(place, made_session("kestrel-27", "a")));  // as from another station
  const TakenIn in = take_in(*store, {});
  EXPECT_EQ(in.taken, 0U);
  EXPECT_EQ(in.left, 0U);
  ASSERT_EQ(in.notices.size(), 1U);
  EXPECT_EQ(waits(place), 0U);
  EXPECT_FALSE(holds(folder.path(), "kestrel-27"));
}

TEST(StoreTrouble, ARecordingThatWaitsIsScoredOnce) {
  const Folder folder;
  const StorePlace place = test::place_in(folder);
  auto store = opened(place);
  add_learner(*store, "kestrel-27");
  const std::string file = folder / "session_1.mcap";
  std::ofstream(file) << "bytes";
  ASSERT_TRUE(keep(place, WaitingRecording{file, "kestrel-27", ""}));
  ASSERT_TRUE(keep(place, WaitingRecording{folder / "gone.mcap", "kestrel-27", ""}));
  EXPECT_EQ(take_in(*store, {}).left, 1U);  // nobody here can score; the other is said to be gone
  const ScoreIt fails = [](const WaitingRecording&) -> Result<SessionRecord> {
    return error("the bone is not there");
  };
  EXPECT_EQ(take_in(*store, fails).left, 1U);
  EXPECT_EQ(waits(place), 1U);
  int scored = 0;
  const ScoreIt score = [&](const WaitingRecording& one) -> Result<SessionRecord> {
    EXPECT_EQ(one.file, file);
    ++scored;
    return made_session(one.learner, "a");
  };
  EXPECT_EQ(take_in(*store, score).taken, 1U);
  EXPECT_EQ(take_in(*store, score).taken, 0U);
  EXPECT_EQ(scored, 1);
  EXPECT_EQ(sessions_of(*store, "")->size(), 1U);
}

// ---- a server

class ServerTrouble : public ::testing::Test {
 protected:
  void SetUp() override {
    BURR_NEEDS_POSTGRES(server_);
    place_ = test::place_in(folder_);
    place_.address = server_.address();
    add_learner(*opened(place_), "kestrel-27");
  }
  Folder folder_;
  PostgresServer server_;
  StorePlace place_;
};

TEST_F(ServerTrouble, AStoppedServerMakesSessionsWait) {
  server_.stop("fast");
  const auto kept = enter_or_keep(place_, made_session("kestrel-27", "a"));
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_FALSE(kept->stored);
  ASSERT_TRUE(server_.start());
  comes_in_once(place_, 1, 1);
}

TEST_F(ServerTrouble, ACutConnectionIsMadeAnewAndNothingIsHalfWritten) {
  auto store = opened(place_);
  auto other = open_postgres(place_.address, "other", {});
  ASSERT_TRUE(other);
  const auto cut = [&] {
    ASSERT_TRUE(
        (*other)->rows("SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity "
                       "WHERE pid <> pg_backend_pid() AND datname = 'postgres'"));
  };
  cut();
  const SessionRecord one = made_session("kestrel-27", "a");
  const auto first = enter(*store, one);
  ASSERT_FALSE(first);  // the connection is lost only when it is used
  EXPECT_EQ(first.error().trouble, Trouble::io) << first.error().text;
  const auto second = enter(*store, one);
  ASSERT_TRUE(second) << second.error().text;
  EXPECT_TRUE(second->session);
  // within a transaction there is no new connection: half of it would be lost
  ASSERT_TRUE(store->database().begin());
  ASSERT_TRUE(store->database().run("DELETE FROM metric"));
  cut();
  EXPECT_FALSE(store->database().run("DELETE FROM self_mark"));
  EXPECT_FALSE(store->database().run("DELETE FROM self_mark"));
  EXPECT_FALSE(store->database().commit());
  EXPECT_EQ(whole((*store->database().rows("SELECT count(*) FROM metric"))[0][0]), 1);
  EXPECT_EQ(whole((*store->database().rows("SELECT count(*) FROM self_mark"))[0][0]), 2);
}

TEST_F(ServerTrouble, AServerThatHangsIsNotWaitedForForEver) {
  place_.waits.answer_s = 1;
  auto store = opened(place_);
  const auto pid = store->database().rows("SELECT pg_backend_pid()");
  ASSERT_TRUE(pid);
  const auto backend = static_cast<pid_t>(whole((*pid)[0][0]));
  ASSERT_EQ(::kill(backend, SIGSTOP), 0);
  const auto entered = enter(*store, made_session("kestrel-27", "a"));
  ::kill(backend, SIGCONT);
  ASSERT_FALSE(entered);
  EXPECT_EQ(entered.error().trouble, Trouble::io);
  EXPECT_NE(entered.error().text.find("does not answer"), std::string::npos)
      << entered.error().text;
  EXPECT_TRUE(enter(*store, made_session("kestrel-27", "a")));  // by a new connection
}

TEST_F(ServerTrouble, NoPasswordIsInAMessage) {
  StorePlace place = place_;
  place.address =
      "postgresql://burr:se@cr%40et@/postgres?host=" + folder_.str() + "&password=other&port=5999";
  EXPECT_EQ(shown(place.address), "postgresql:///postgres?host=" + folder_.str() + "&port=5999");
  const auto store = Store::open(place);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().trouble, Trouble::io);
  for (const char* secret : {"se@cr", "cr%40et", "other"})
    EXPECT_EQ(store.error().text.find(secret), std::string::npos) << store.error().text;
  // what libpq cannot read, or reads otherwise than meant
  for (const auto& [address, where] :
       {std::pair{"postgresql://ada:50%off@h/school", "postgresql://h/school"},
        std::pair{"postgresql://ada:50?off@127.0.0.1:1/school", "postgresql://127.0.0.1:1/school"},
        std::pair{"postgresql://ada:50/off@127.0.0.1:1/school", "postgresql://127.0.0.1:1/school"},
        std::pair{"postgresql://ada:50@off@127.0.0.1:1/school", "postgresql://127.0.0.1:1/school"},
        std::pair{"postgresql://ada:50/?off=1@127.0.0.1:1/s", "postgresql://127.0.0.1:1/s"},
        std::pair{"postgresql://ada@h/s?password=50@off&bad", "postgresql://"}}) {
    place.address = address;
    EXPECT_EQ(shown(address), where);
    const auto none = Store::open(place);
    ASSERT_FALSE(none);
    for (const char* secret : {"50", "off", "ada"})
      EXPECT_EQ(none.error().text.find(secret), std::string::npos) << none.error().text;
  }
}

TEST_F(ServerTrouble, ALostServerIsWaitedForOnce) {
  auto store = opened(place_);
  for (const char* what : {"a", "b", "c"})
    ASSERT_TRUE(keep(place_, made_session("kestrel-27", what)));
  StorePlace other = place_;  // they share the folder
  other.address += "&application_name=x&port=5999";
  ASSERT_TRUE(keep(other, made_session("kestrel-27", "a")));
  server_.stop("fast");
  const TakenIn in = take_in(*store, {});
  EXPECT_EQ(in.left, 3U);
  EXPECT_EQ(in.others, 1U);
  EXPECT_EQ(in.notices.size(), 1U);
  ASSERT_TRUE(server_.start());
  comes_in_once(place_, 3, 3);
}

// The planner's figures hold the most frequent values of a column.
TEST_F(ServerTrouble, TheServerKeepsNoFiguresOfAForgottenLearner) {
  auto store = opened(place_);
  add_learner(*store, "otter-5", {"Grace Hopper", "g@example.org", "7"});
  for (int n = 0; n < 20; ++n)
    for (const char* who : {"kestrel-27", "otter-5"})
      ASSERT_TRUE(enter(*store, made_session(who, std::to_string(n))));
  ASSERT_TRUE(add_to_cohort(*store, "autumn", {"kestrel-27", "otter-5"}));
  for (const Sql one : {Sql("VACUUM ANALYZE names.person"), Sql("ANALYZE")})
    ASSERT_TRUE(store->database().run(one));
  const auto held = [&] {
    return whole((*store->database().rows(
        "SELECT count(*) FROM pg_stats WHERE schemaname IN ('public', 'names') AND "
        "concat(most_common_vals::text, histogram_bounds::text) ~ "
        "'otter-5|Hopper|example|tester'"))[0][0]);
  };
  EXPECT_EQ(held(), 0);
  ASSERT_TRUE(forget(*store, "otter-5", {}));
  EXPECT_EQ(held(), 0);
}

// The rights of docs/teach/school_rights.md, to the letter.
constexpr Sql kRights[] = {
    "CREATE ROLE station LOGIN",
    "GRANT SELECT ON ALL TABLES IN SCHEMA public TO station",
    "GRANT INSERT ON case_def, rubric, session, score, item, metric, self_mark, seal, outbox, "
    "audit "
    "TO station",
    "GRANT INSERT (nonce, station, learner_id, mode, case_hash, rubric_hash) ON nonce TO station",
    "GRANT INSERT (nonce, head) ON nonce_end TO station",
    "GRANT UPDATE, DELETE ON outbox TO station",
    "GRANT DELETE ON session, score, item, metric, self_mark TO station",
    "CREATE ROLE rater LOGIN",
    "GRANT SELECT ON ALL TABLES IN SCHEMA public TO rater",
    "GRANT INSERT ON rater_mark, audit TO rater",
    "CREATE ROLE decider LOGIN",
    "GRANT SELECT ON ALL TABLES IN SCHEMA public TO decider",
    "GRANT INSERT ON standard, decision, outbox, audit TO decider",
};

TEST_F(ServerTrouble, EachRoleHasItsRightsAndNoMore) {
  auto owner = opened(place_);
  std::ifstream page(test::source_dir() + "/docs/teach/school_rights.md");
  std::string words{std::istreambuf_iterator<char>(page), {}};
  std::replace(words.begin(), words.end(), '\n', ' ');
  for (const Sql one : kRights) {
    ASSERT_TRUE(owner->database().run(one)) << one.text();
    EXPECT_NE(words.find(std::string(one.text()) + ";"), std::string::npos)
        << "the page has not: " << one.text();
  }
  const auto as = [this](const std::string& role) {
    StorePlace place = place_;
    place.address.replace(place.address.find("burr@"), 4, role);
    return opened(place);
  };
  test::MadeStation made(*owner, folder_.str());
  const SessionRecord sealed = made.sealed(made_session("kestrel-27", "sealed"));
  auto station = as("station"), rater = as("rater"), decider = as("decider");
  const auto entered = enter(*station, sealed);
  ASSERT_TRUE(entered) << entered.error().text;
  EXPECT_EQ(entered->standing, standing::kSealed);
  // a station gets its nonces, by the server's clock alone
  Seal asked = *sealed.seal;
  const auto given = give_nonce(*station, asked);
  ASSERT_TRUE(given) << given.error().text;
  EXPECT_LT(std::abs(given->given_ms - now_ms()), 60'000);
  EXPECT_TRUE(end_nonce(*station, given->nonce, "aa"));
  const Marking marking = {session_id(sealed), "A. Berg", true, {{"floor", "met", ""}}};
  EXPECT_TRUE(mark(*rater, marking));
  Standard standard;
  standard.rubric_hash = sealed.rubric.hash;
  standard.part = "product";
  standard.method = "Angoff";
  standard.cut = 60;
  standard.judges = 5;
  standard.set_by = "A. Berg";
  standard.text = "five judges";
  const auto cut = set_standard(*decider, standard);
  ASSERT_TRUE(cut) << cut.error().text;
  const auto decided =
      decide(*decider, {"kestrel-27", *cut, "pass", "somebody else", "as proposed"});
  ASSERT_TRUE(decided) << decided.error().text;
  EXPECT_EQ(decided->confirmed_by, "decider");  // the login, not what was typed
  EXPECT_FALSE(decide(*station, {"kestrel-27", *cut, "fail", "", "because"}));
  EXPECT_FALSE(decide(*rater, {"kestrel-27", *cut, "fail", "", "because"}));
  EXPECT_FALSE(set_standard(*station, standard));
  EXPECT_FALSE(enrol(*station, {"other-station", std::string(64, 'a')}));
  for (Store* one : {station.get(), rater.get(), decider.get()})
    for (const Sql change :
         {Sql("UPDATE audit SET who = 'x'"), Sql("DELETE FROM audit"),
          Sql("UPDATE rater_mark SET mark = 'unmet'"), Sql("DELETE FROM rater_mark"),
          Sql("UPDATE decision SET outcome = 'fail'"), Sql("DELETE FROM decision"),
          Sql("UPDATE session SET mode = 'exam'"), Sql("UPDATE seal SET head = 'x'"),
          Sql("DELETE FROM seal"), Sql("UPDATE station SET key = 'x'"),
          Sql("INSERT INTO nonce (nonce, station, learner_id, mode, case_hash, rubric_hash, "
              "given_ms) "
              "VALUES ('n', 'made-station', 'kestrel-27', 'exam', '0', '0', 1)"),
          Sql("SELECT * FROM names.person")}) {
      const auto done = one->database().rows(change);
      ASSERT_FALSE(done) << change.text();
      EXPECT_NE(done.error().text.find("permission denied"), std::string::npos)
          << change.text() << ": " << done.error().text;
    }
  // a sealed session cannot be taken out: its seal holds it
  EXPECT_FALSE(station->database().run("DELETE FROM session"));
  const auto found = check_audit(*owner, "");
  EXPECT_TRUE(found) << found.error().text;
}

TEST_F(ServerTrouble, AStationWithoutRightsToNamesEntersSessions) {
  auto owner = opened(place_);
  for (const Sql one :
       {Sql("CREATE ROLE station LOGIN"),
        Sql("GRANT SELECT, INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA public TO station")})
    ASSERT_TRUE(owner->database().run(one));
  StorePlace place = place_;
  place.address.replace(place.address.find("burr@"), 4, "station");
  auto store = opened(place);
  add_learner(*store, "otter-5");
  EXPECT_TRUE(enter(*store, made_session("kestrel-27", "a")));
  EXPECT_TRUE(learners(*store, false));
  const auto named = learners(*store, true);
  ASSERT_FALSE(named);
  EXPECT_NE(named.error().text.find("permission denied"), std::string::npos) << named.error().text;
  // a right that is taken away makes sessions wait, not go
  ASSERT_TRUE(owner->database().run("REVOKE INSERT ON metric FROM station"));
  const auto kept = enter_or_keep(place, made_session("kestrel-27", "b"));
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_FALSE(kept->stored);
  EXPECT_EQ(take_in(*store, {}).left, 1U);
  ASSERT_TRUE(owner->database().run("GRANT INSERT ON metric TO station"));
  comes_in_once(place, 1, 2);
  Learner other;
  other.id = "lynx-100";
  EXPECT_FALSE(add(*store, other, {"Ada Lovelace", "", ""}));
  EXPECT_FALSE(*has(*store, "lynx-100"));
}

constexpr int kStations = 10, kEach = 30;

// One of ten computers: sessions end here whatever the server does. Returns 0 if each was stored or waits.
int station(const StorePlace& place, int number) {
  for (int n = 0; n < kEach; ++n) {
    const auto kept = enter_or_keep(
        place, made_session("kestrel-27", std::to_string(number) + "." + std::to_string(n)));
    if (!kept) return 1;
    ::usleep(20'000);
    if (n % 5 != 4) continue;
    // a new start
    if (auto store = Store::open(place)) static_cast<void>(take_in(**store, {}));
  }
  return 0;
}

TEST_F(ServerTrouble, TenStationsLoseNothingAndEnterNothingTwice) {
  std::vector<pid_t> stations;
  std::vector<StorePlace> places;
  for (int n = 0; n < kStations; ++n) {
    StorePlace place = place_;
    place.pending = folder_.path() / ("pending" + std::to_string(n));
    place.waits.lock_ms = 5000;
    places.push_back(place);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(station(place, n));
    ASSERT_GT(child, 0);
    stations.push_back(child);
  }
  // meanwhile: two crashes, a restart, and connections that are cut
  for (const char* how : {"immediate", "fast", "immediate"}) {
    for (int n = 0; n < 4; ++n) {
      ::usleep(150'000);
      if (auto other = open_postgres(place_.address, "other", {}))
        static_cast<void>(
            (*other)->rows("SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity "
                           "WHERE pid <> pg_backend_pid() AND datname = 'postgres'"));
    }
    server_.stop(how);
    ::usleep(200'000);
    ASSERT_TRUE(server_.start()) << server_.log();
  }
  for (const pid_t child : stations) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  std::size_t waited = 0;
  for (const StorePlace& place : places) {
    waited += waits(place);
    EXPECT_EQ(take_in(*opened(place), {}).left, 0U);
  }
  auto store = opened(place_);
  const auto count = [&](Sql sql) { return whole((*store->database().rows(sql))[0][0]); };
  constexpr std::int64_t kAll = std::int64_t{kStations} * kEach;
  EXPECT_EQ(count("SELECT count(*) FROM session"), kAll);
  EXPECT_EQ(count("SELECT count(DISTINCT recording_hash) FROM session"), kAll);
  EXPECT_EQ(count("SELECT count(*) FROM score"), 2 * kAll);
  EXPECT_EQ(count("SELECT count(*) FROM item"), 4 * kAll);
  EXPECT_EQ(count("SELECT count(*) FROM metric"), kAll);
  EXPECT_EQ(count("SELECT count(*) FROM self_mark"), 2 * kAll);
  EXPECT_EQ(count("SELECT count(*) FROM audit WHERE what = 'session entered'"), kAll);
  RecordProperty("waited_at_the_end", static_cast<int>(waited));
}

}  // namespace
}  // namespace burr::school
