// tests/school/made.h - a session of a learner, made up.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "burr/scenario/case.h"
#include "burr/school/session_record.h"
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
