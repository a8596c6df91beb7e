// A sealed session is forged in ten ways, each as far as the forger can go: who has only the file computes every hash,
// sum and head of it anew; who has the station's key signs it anew as well. What `burr learner enter` does refuses each
// with one true sentence, and the store stays as it was.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/player.h"
#include "burr/record/schema.h"
#include "burr/record/sealer.h"
#include "burr/scenario/case.h"
#include "burr/school/audit_check.h"
#include "burr/school/enrolled.h"
#include "burr/school/sessions.h"
#include "burr/school/signing_key.h"
#include "burr/school/station_sealer.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/tick_hash.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recording.h"
#include "school/forging.h"
#include "school/made.h"
#include "school/session_of.h"

namespace burr::school {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using record::ByteSpan;
using test::Bytes;
using test::Folder;
using test::forge;
using test::Forgery;
using test::session_forged;
using test::Words;
using test::words_of;

constexpr const char* kWho = "kestrel-27";

class ForgeryTest : public testing::Test {
 protected:
  void SetUp() override {
    auto store = Store::open(place_);
    ASSERT_TRUE(store) << store.error().text;
    store_ = std::move(*store);
    for (const char* who : {kWho, "otter-5"}) {
      Learner one;
      one.id = who;
      ASSERT_TRUE(add(*store_, one, {}));
    }
    auto key = SigningKey::make(folder_ / "keys/station.key", "station-3");
    ASSERT_TRUE(key) << key.error().text;
    key_ = std::move(*key);
    ASSERT_TRUE(enrol(*store_, {key_->name(), key_->public_key()}));
  }

  // A person's session of `seconds`, sealed by the station. device: as the file names it.
  std::string record(const std::string& name, const std::string& motion = "slot",
                     const std::string& learner = kWho, double seconds = 1,
                     const std::string& device = "mouse", bool sealed = true) {
    const std::string file = folder_ / (name + ".mcap");
    NoProgress quiet;
    const auto work = scenario::read_case("block");
    EXPECT_TRUE(work);
    scenario::BoneRecipe coarse;
    coarse.voxel_mm = 0.6;
    auto prepared = workshop::prepare(*work, quiet, {}, coarse);
    EXPECT_TRUE(prepared) << prepared.error().text;
    const sim::SessionSettings settings = workshop::settings_of(*prepared);
    auto path = surgeon::motion(motion, prepared->place, settings.servo.burr.radius, seconds);
    EXPECT_TRUE(path);
    device::DeviceSpec spec;
    spec.name = device;
    auto hand =
        std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{}, spec);
    auto session = workshop::begin(*prepared, std::move(hand), settings, quiet);
    EXPECT_TRUE(session) << session.error().text;
    workshop::About about = workshop::about(*prepared, (*session)->bone(), motion);
    about.identity.mode = record::Mode::practise;
    about.identity.learner = learner;
    const auto sealer = std::make_shared<StationSealer>(place_, *key_);
    if (sealed) about.sealer = sealer;
    auto recorder = workshop::record(**session, file, about);
    EXPECT_TRUE(recorder) << recorder.error().text;
    (*session)->run(seconds, quiet);
    (*session)->set_recorder(nullptr);
    EXPECT_TRUE((*recorder)->finish());
    said_ = sealer->said();
    return file;
  }

  // As `burr learner enter` does it.
  struct Answer {
    int left = 0;
    std::string said;  // the standing, or why it was refused
  };
  Answer enter(const std::string& file, const std::string& learner = kWho) {
    NoProgress quiet;
    const auto record = app::session_of(file, learner, "", {}, quiet);
    if (!record) return {static_cast<int>(record.error().trouble), record.error().text};
    const auto entered = school::enter(*store_, *record);
    if (!entered) return {static_cast<int>(entered.error().trouble), entered.error().text};
    return {0, entered->standing};
  }
  std::size_t sessions() { return sessions_of(*store_, "")->size(); }

  // Refused with this sentence, one line, and nothing came into the store.
  void refused(const std::string& file, const std::string& sentence,
               const std::string& learner = kWho) {
    const std::size_t before = sessions();
    const Answer answer = enter(file, learner);
    EXPECT_NE(answer.left, 0) << answer.said;
    EXPECT_NE(answer.said.find(sentence), std::string::npos) << answer.said;
    EXPECT_NE(answer.said.find(fs::path(file).filename().string()), std::string::npos)
        << answer.said;
    EXPECT_EQ(answer.said.find('\n'), std::string::npos) << answer.said;
    EXPECT_EQ(sessions(), before);
  }

  // The station's owner signs what the file says now. start: with a new seal of the start, which stands in /session.
  Forgery signed_anew(const std::function<void(Json&)>& change) const {
    auto about = std::make_shared<Seal>();
    const SigningKey& key = *key_;
    Forgery by = session_forged([change, about, &key](Json& session) {
      change(session);
      const auto info = record::session_from_json(session.dump(), "");
      ASSERT_TRUE(info) << info.error().text;
      *about = seal_about(*info);
      about->station = info->seal->station;
      about->nonce = info->seal->nonce;
      about->given_ms = info->seal->given_ms;
      about->start_signature = key.sign(start_words(*about));
      session["seal"]["signature"] = about->start_signature;
    });
    by.seal = [about, &key](Words& seal) {
      about->head = seal["head"];
      about->ended_ms = std::stoll(seal["ended_ms"]);
      seal["nonce"] = about->nonce;
      seal["station"] = about->station;
      seal["signature"] = key.sign(end_words(*about));
    };
    return by;
  }
  std::string forged(const std::string& file, const Forgery& by) {
    const std::string to = folder_ / ("forged-" + std::to_string(++count_) + ".mcap");
    forge(file, to, by);
    return to;
  }
  std::string number(const char* what) {
    return std::to_string(whole((*store_->database().rows(
        std::string_view(what) == "sessions" ? Sql("SELECT count(*) FROM session")
                                             : Sql("SELECT count(*) FROM seal")))[0][0]));
  }

  Folder folder_;
  StorePlace place_ = test::place_in(folder_);
  std::unique_ptr<Store> store_;
  std::optional<SigningKey> key_;
  std::vector<std::string> said_;
  int count_ = 0;
};

TEST_F(ForgeryTest, ASealedSessionIsEnteredOnceAndHasTheStoresDate) {
  const std::string file = record("true");
  EXPECT_TRUE(said_.empty()) << said_.front();
  // the date of the file moves nothing
  fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(24 * 400));
  const Answer first = enter(file);
  EXPECT_EQ(first.left, 0) << first.said;
  EXPECT_EQ(first.said, "sealed");
  EXPECT_EQ(enter(file).left, 0);  // the same session, which is there
  const auto rows = sessions_of(*store_, kWho);
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_TRUE(rows->front().sealed());
  EXPECT_LT(std::abs(rows->front().started_ms - now_ms()), 600'000);
  EXPECT_EQ(number("seals"), "1");
  NoProgress quiet;
  const auto found = check_audit(*store_, "");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->seals, 1);
  refused(file, "says that it is kestrel-27's, not otter-5's", "otter-5");
}

TEST_F(ForgeryTest, WithoutASealASessionIsKeptAndDoesNotCount) {
  const Answer none = enter(record("none", "slot", kWho, 1, "mouse", false));
  EXPECT_EQ(none.left, 0) << none.said;
  EXPECT_EQ(none.said, "no seal");
  const std::string simulated = record("simulated", "slot", kWho, 1, "simulated hand");
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_NE(said_.front().find("burr moves the hand itself"), std::string::npos);
  EXPECT_EQ(enter(simulated).left, 0);
  EXPECT_EQ(number("sessions"), "2");
  EXPECT_EQ(number("seals"), "0");
}

TEST_F(ForgeryTest, ForcesThatWereRewritten) {
  const std::string file = record("forces");
  Forgery by;
  std::uint64_t last = 0;
  by.message = [&last](const std::string& topic, ByteSpan data) -> std::optional<Bytes> {
    if (topic != record::kTicks.name) return Bytes(data.begin(), data.end());
    std::vector<tick::TickRow> rows;
    EXPECT_TRUE(record::decode_ticks(data, rows));
    for (tick::TickRow& row : rows) {
      row.contact.force *= 0.1;
      row.hash = last = tick::tick_hash(row, last);
    }
    record::BytesOut out;
    record::encode_ticks(rows, out);
    return out.bytes();
  };
  refused(forged(file, by), "comes out differently at tick");
  // who changes the forces alone is found before anything is simulated
  Forgery lazy = by;
  lazy.seal = [head = std::string(64, '0')](Words& seal) { seal["head"] = head; };
  refused(forged(file, lazy), "it is not what was sealed");
}

TEST_F(ForgeryTest, AnotherOwner) {
  const std::string file = record("owner");
  refused(forged(file,
                 session_forged([](Json& session) { session["identity"]["learner"] = "otter-5"; })),
          "the seal of its start is not that of station station-3", "otter-5");
}

TEST_F(ForgeryTest, AnotherDevice) {
  const std::string file = record("device");
  refused(
      forged(file, session_forged([](Json& session) { session["words"]["device"] = "omega.7"; })),
      "the seal of its start is not that of station station-3");
}

TEST_F(ForgeryTest, AnotherDate) {
  const std::string file = record("date");
  const auto earlier = [](Json& session) {
    session["seal"]["given_ms"] = session["seal"]["given_ms"].get<std::int64_t>() - 86'400'000;
  };
  refused(forged(file, session_forged(earlier)), "the seal of its start is not that of station");
  refused(forged(file, signed_anew(earlier)), "another time than this store's clock gave");
}

TEST_F(ForgeryTest, AnotherMode) {
  const std::string file = record("mode");
  const auto exam = [](Json& session) { session["identity"]["mode"] = "exam"; };
  refused(forged(file, session_forged(exam)), "the seal of its start is not that of station");
  refused(forged(file, signed_anew(exam)),
          "its nonce was given for mode practise, and its seal says mode exam");
}

TEST_F(ForgeryTest, ASessionThatIsEnteredTwice) {
  const std::string file = record("twice");
  ASSERT_EQ(enter(file).left, 0);
  Forgery again = signed_anew([](Json&) {});
  again.more = {{"other", "bytes"}};
  refused(forged(file, again), "its nonce was closed for another recording, so it was used twice");
  Forgery plain;
  plain.more = {{"other", "bytes"}};
  refused(forged(file, plain), "the seal of its end is not that of station station-3");
}

TEST_F(ForgeryTest, AnEndThatWasCutOff) {
  const std::string file = record("end");
  Forgery by;
  by.account = false;
  by.seal = [](Words& seal) { seal.clear(); };
  by.message = [](const std::string& topic, ByteSpan data) -> std::optional<Bytes> {
    std::vector<tick::TickRow> rows;
    if (topic == record::kTicks.name && record::decode_ticks(data, rows) &&
        rows.front().tick >= 700)
      return std::nullopt;
    if (topic == record::kEvents.name || topic == record::kChanges.name) return std::nullopt;
    return Bytes(data.begin(), data.end());
  };
  refused(forged(file, by), "the recording has no seal of its end, so it was cut off");
}

TEST_F(ForgeryTest, TwoSessionsThatWereSpliced) {
  const std::string one = record("one"), other = record("other", "pocket");
  const auto player = record::Player::open(other);
  std::map<std::uint64_t, tick::TickRow> rows_of_other;
  record::Step step;
  for (record::StepCursor steps = (*player)->steps(); steps.next(step);)
    rows_of_other[step.row.tick] = step.row;
  Forgery by;
  by.message = [&](const std::string& topic, ByteSpan data) -> std::optional<Bytes> {
    std::vector<tick::TickRow> rows;
    if (topic != record::kTicks.name || !record::decode_ticks(data, rows))
      return Bytes(data.begin(), data.end());
    for (tick::TickRow& row : rows)
      if (row.tick >= 800) row = rows_of_other.at(row.tick);
    record::BytesOut out;
    record::encode_ticks(rows, out);
    return out.bytes();
  };
  refused(forged(one, by), "tick 800 was changed after it was recorded");
}

TEST_F(ForgeryTest, TheSealOfAnother) {
  const std::string good = record("good"), bad = record("bad", "pocket");
  const auto from = record::McapReader::open(good);
  const Words seal_of_good = words_of(**from, record::kSealName);
  const auto info = record::Player::open(good);
  const record::StartSeal start = *(*info)->info().seal;
  const auto with_start = [&start](Json& session) {
    session["seal"] = {{"station", start.station},
                       {"nonce", start.nonce},
                       {"given_ms", start.given_ms},
                       {"signature", start.signature}};
  };
  Forgery by = session_forged(with_start);
  by.seal = [&](Words& seal) { seal = seal_of_good; };
  refused(forged(bad, by), "it is not what was sealed");
  by.seal = [&](Words& seal) {
    const std::string head = seal["head"];
    seal = seal_of_good;
    seal["head"] = head;
  };
  refused(forged(bad, by), "the seal of its end is not that of station station-3");
  Forgery half;  // only the seal of the end
  half.seal = by.seal;
  refused(forged(bad, half), "the seal of its end is that of another session");
}

TEST_F(ForgeryTest, AnOldNonce) {
  const std::string old = record("old"), fresh = record("fresh", "pocket");
  ASSERT_EQ(enter(old).left, 0);
  const auto info = record::Player::open(old);
  const record::StartSeal start = *(*info)->info().seal;
  const auto with_old = [&start](Json& session) {
    session["seal"]["nonce"] = start.nonce;
    session["seal"]["given_ms"] = start.given_ms;
  };
  refused(forged(fresh, session_forged(with_old)),
          "the seal of its end is that of another session");
  Forgery signs = signed_anew(with_old);
  const auto sign = signs.seal;
  const auto read = record::McapReader::open(old);
  const std::string ended = words_of(**read, record::kSealName)["ended_ms"];
  signs.seal = [&sign, &ended](Words& seal) {
    seal["ended_ms"] = ended;
    sign(seal);
  };
  refused(forged(fresh, signs), "its nonce was closed for another recording, so it was used twice");
  // one that no store gave
  refused(forged(fresh, signed_anew([](Json& session) {
                   session["seal"]["nonce"] = std::string(32, 'a');
                 })),
          "its nonce was not given by this store");
  // and one that lay about for a day before it was used
  ASSERT_TRUE(store_->database().run("UPDATE nonce SET given_ms = given_ms - 90000000"));
  refused(forged(fresh, signed_anew([](Json& session) {
                   session["seal"]["given_ms"] =
                       session["seal"]["given_ms"].get<std::int64_t>() - 90'000'000;
                 })),
          "too old");
}

TEST_F(ForgeryTest, AProgramThatPlaysAPerson) {
  const std::string file = record("fast", "slot", kWho, 4);
  ASSERT_TRUE(
      store_->database().run("UPDATE nonce_end SET ended_ms = (SELECT given_ms FROM nonce WHERE "
                             "nonce = nonce_end.nonce) + 1000"));
  Forgery signs = signed_anew([](Json&) {});
  const auto sign = signs.seal;
  const auto player = record::Player::open(file);
  const std::string ended = std::to_string((*player)->info().seal->given_ms + 1000);
  signs.seal = [&sign, &ended](Words& seal) {
    seal["ended_ms"] = ended;
    sign(seal);
  };
  refused(forged(file, signs), "lasts 4 s, and by the store's clock only 1 s went by");
}

TEST_F(ForgeryTest, AStationThatIsUnknownOrRevoked) {
  const std::string file = record("revoked");
  ASSERT_TRUE(revoke(*store_, "station-3"));
  const Answer before = enter(file);
  EXPECT_EQ(before.said, "sealed");
  const std::string late = record("late");
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_NE(said_.front().find("the store has revoked it"), std::string::npos) << said_.front();
  EXPECT_EQ(enter(late).left, 0);
  // a key that nobody enrolled signs under the station's name, and under its own
  auto own = SigningKey::make(folder_ / "keys/own.key", "station-9");
  ASSERT_TRUE(own);
  key_ = std::move(*own);
  const auto as = [](const char* name) {
    return [name](Json& session) { session["seal"]["station"] = name; };
  };
  refused(forged(file, signed_anew(as("station-3"))),
          "the seal of its start is not that of station station-3");
  const Answer unknown = enter(forged(file, signed_anew(as("station-9"))));
  EXPECT_EQ(unknown.left, 0) << unknown.said;
  EXPECT_EQ(unknown.said, "unknown station");
}

TEST_F(ForgeryTest, AStoreThatIsAwayCostsTheSealAndNothingElse) {
  const std::string there = place_.address;
  place_.address = folder_ / "keys/station.key/school.sqlite";  // below a file
  const std::string file = record("away");
  place_.address = there;
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_NE(said_.front().find("recorded, but not sealed"), std::string::npos);
  const Answer answer = enter(file);
  EXPECT_EQ(answer.left, 0) << answer.said;
  EXPECT_EQ(answer.said, "no seal");
}

TEST_F(ForgeryTest, AKeyThatOthersMayReadIsRefused) {
  const std::string file = folder_ / "keys/station.key";
  struct stat about = {};
  ASSERT_EQ(::stat(file.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
  ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
  const auto read = SigningKey::read(file);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text.find("others can read"), std::string::npos);
}

// The rows of the store themselves: what somebody changes in them is found.
TEST_F(ForgeryTest, TheAuditAndTheSealsOfTheStore) {
  ASSERT_EQ(enter(record("row")).left, 0);
  const auto good = check_audit(*store_, "");
  ASSERT_TRUE(good) << good.error().text;
  EXPECT_GE(good->rows, 4);
  EXPECT_TRUE(check_audit(*store_, good->head));
  const auto finds = [this](Sql change, const std::string& sentence,
                            const std::string& since = "") {
    ASSERT_TRUE(store_->database().begin());
    ASSERT_TRUE(store_->database().run(change)) << change.text();
    const auto found = check_audit(*store_, since);
    EXPECT_FALSE(found) << change.text();
    if (!found) {
      EXPECT_NE(found.error().text.find(sentence), std::string::npos) << found.error().text;
    }
    store_->database().rollback();
  };
  finds("UPDATE audit SET what = 'nothing' WHERE number = 2",
        "row 2 of the audit does not give its hash");
  finds("UPDATE audit SET ms = ms + 1 WHERE number = 3", "row 3");
  finds("UPDATE audit SET who = 'somebody' WHERE number = 1",
        "row 1 of the audit names somebody else");
  finds("DELETE FROM audit WHERE number = 2", "row 2 of the audit is missing");
  finds("DELETE FROM audit WHERE number = (SELECT max(number) FROM audit)", "does not hold",
        good->head);
  finds("UPDATE session SET mode = 'exam'", "its seal does not fit its row");
  finds("UPDATE session SET started_ms = started_ms - 1", "its seal does not fit its row");
  finds("UPDATE seal SET head = 'aa'", "its seal does not fit its row");
  EXPECT_TRUE(check_audit(*store_, good->head));
}

}  // namespace
}  // namespace burr::school
