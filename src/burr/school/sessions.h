// school/sessions.h - sessions come into the store, and what they say together.
//
//     auto entered = school::enter(*store, record);             // once, however often it is tried
//     auto rows = school::learners(*store, false);
//
// Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/seal.h"
#include "burr/school/session_record.h"
#include "burr/school/store.h"

namespace burr::school {

struct Entered {
  bool session = false;    // it was not there before
  std::size_t scores = 0;  // new ones, also of a session that was there
  // Sessions that this one goes on with: they were entered before it was continued.
  std::size_t taken_out = 0;
  std::string standing = {};  // school/seal.h: whether it counts
};
// All or nothing. Error, Trouble::usage: there is no such learner; or the session's seal is not true, or was used. A
// sealed session has the date of the store's clock.
[[nodiscard]] Result<Entered> enter(Store& store, const SessionRecord& record);

// Until that many unguided sessions of one case, a mark says little of a person.
inline constexpr std::int64_t kNeeded = 5;
// Figures of fewer people are not shown: they would be figures of persons.
inline constexpr std::int64_t kFewestPeople = 5;

struct LearnerRow {
  Learner learner;
  Person person;  // empty unless asked for
  std::int64_t sessions = 0;
  std::int64_t unguided = 0;            // of the case of which there are most
  std::optional<std::int64_t> last_ms;  // of the last session
};
[[nodiscard]] Result<std::vector<LearnerRow>> learners(Store& store, bool with_names);

// attempt: of this learner at the case of this name, by time, from 1.
struct SessionRow {
  std::string id, learner, case_name, mode, device, engine, recording_uri, recording_hash;
  std::int64_t started_ms = 0, attempt = 0;
  double seconds = 0, voxel_um = 0;
  bool guided = false, finished = false;
  std::string standing = {};  // school/seal.h
  [[nodiscard]] bool sealed() const { return standing == standing::kSealed; }
};
// By time; of this learner, or of all where `learner` is empty.
[[nodiscard]] Result<std::vector<SessionRow>> sessions_of(Store& store, const std::string& learner);

struct ScoreRow {
  std::string session, rubric_hash, rubric, engine, part;
  std::optional<double> total;
  std::int64_t gates_broken = 0, met = 0, assessable = 0, items = 0, made_ms = 0;
};
// The newest first.
[[nodiscard]] Result<std::vector<ScoreRow>> scores_of(Store& store, const std::string& session);

struct ItemRow {
  std::string part, id, result;
  std::optional<double> value, threshold, margin;
  std::string evidence_json, self_mark;  // self_mark: empty where there is none
};
// Of the session's newest score of each part.
[[nodiscard]] Result<std::vector<ItemRow>> items_of(Store& store, const std::string& session);

// A learner and an item of a rubric, in a learner's last unguided sessions: of how many it was met.
struct Cell {
  std::string learner, item;
  std::int64_t met = 0, assessable = 0, sessions = 0;
};
[[nodiscard]] Result<std::vector<Cell>> items_of_cohort(Store& store, const std::string& cohort_id,
                                                        const std::string& case_name,
                                                        std::int64_t last = kNeeded);

// The same over the people of a cohort. Share: none, where it is of fewer than kFewestPeople.
struct ItemShare {
  std::string item;
  std::int64_t people = 0;
  std::optional<double> share_met;
};
[[nodiscard]] std::vector<ItemShare> shares(const std::vector<Cell>& cells);

struct AuditRow {
  std::int64_t ms = 0;
  std::string who, what, subject;
};
[[nodiscard]] Result<std::vector<AuditRow>> audit(Store& store);

}  // namespace burr::school
