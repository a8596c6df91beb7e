// tests/school/made.h - a session of a learner, made up.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "burr/scenario/case.h"
#include "burr/school/enrolled.h"
#include "burr/school/session_record.h"
#include "burr/school/signing_key.h"
#include "burr/school/store.h"
#include "burr/school/uuid.h"
#include "support/folder.h"

namespace burr::test {

// what: makes the recording another one
inline school::SessionRecord made_session(const std::string& learner, const std::string& what,
                                          std::int64_t started_ms = 1'700'000'000'000) {
  school::SessionRecord one;
  one.learner = learner;
  one.work_case = {"0x00000000000000aa", "block", "title = \"Block, \\\"quoted\\\"\"\n", 2, 0};
  one.rubric = {"0x00000000000000bb", "block rubric", "[[item]]", 3, 0};
  one.scored_by = "0.1.0";
  one.started_ms = started_ms;
  one.seconds = 61.25;
  one.mode = "exam";
  one.finished = true;
  one.device = "simulated hand";
  one.device_max_n = 3.3;
  one.voxel_um = 250;
  one.engine = "0.1.0";
  one.recording_hash = school::sha1(learner + what);
  one.scores = {{"product",
                 66.5,
                 1,
                 0.9,
                 1'700'000'100'000,
                 {{"floor", "met", 0.1 + 0.2, 0.25, 0.05, "{\"tick\":12}"},
                  {"wall", "unmet", 1e-3, 2e-3, -1e-3, "{}"},
                  {"nerve", "not assessable", {}, {}, {}, "{\"reason\":\"no label\"}"}}},
                {"process", {}, 0, 0.5, 1'700'000'100'000, {{"order", "met", {}, {}, {}, "{}"}}}};
  one.metrics = {{"removed", "mm^3", 123.456}};
  one.self_marks = {{"floor", "met"}, {"wall", "unknown"}};
  return one;
}

// Seals made-up sessions as a station of the centre would, so that they count. They keep their dates: the clock of the
// store is put to them.
class MadeStation {
 public:
  MadeStation(school::Store& store, const std::string& folder)
      : store_(store), key_(*school::SigningKey::make(folder + "/made.key", "made-station")) {
    EXPECT_TRUE(school::enrol(store_, {key_.name(), key_.public_key()}));
  }
  [[nodiscard]] const school::SigningKey& key() const { return key_; }
  // Its learner is in the store.
  school::SessionRecord sealed(school::SessionRecord one) {
    one.device = "mouse";
    one.replayed = true;
    school::Seal& seal = one.seal.emplace();
    seal.station = key_.name();
    seal.learner = one.learner;
    seal.mode = one.mode;
    seal.case_hash = one.work_case.hash;
    seal.rubric_hash = one.rubric.hash;
    seal.bone_hash = "0x00000000000000cc";
    seal.device = one.device;
    const auto given = school::give_nonce(store_, seal);
    EXPECT_TRUE(given) << given.error().text;
    seal.nonce = given->nonce;
    seal.given_ms = one.started_ms;
    seal.head = school::sha256(one.recording_hash);
    seal.ended_ms = one.started_ms + static_cast<std::int64_t>(1000 * one.seconds);
    EXPECT_TRUE(school::end_nonce(store_, seal.nonce, seal.head));
    school::Database& in = store_.database();
    EXPECT_TRUE(
        in.run("UPDATE nonce SET given_ms = $2 WHERE nonce = $1", {seal.nonce, seal.given_ms}));
    EXPECT_TRUE(
        in.run("UPDATE nonce_end SET ended_ms = $2 WHERE nonce = $1", {seal.nonce, seal.ended_ms}));
    seal.start_signature = key_.sign(school::start_words(seal));
    seal.signature = key_.sign(school::end_words(seal));
    return one;
  }

 private:
  school::Store& store_;
  school::SigningKey key_;
};

// A store in a folder of the test's own.
inline school::StorePlace place_in(const Folder& folder) {
  school::StorePlace place;
  place.address = folder / "school.sqlite";
  place.pending = folder.path() / "pending";
  place.waits.lock_ms = 100;
  place.who = "tester@bench";
  return place;
}

}  // namespace burr::test
