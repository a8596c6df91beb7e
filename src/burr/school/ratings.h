// school/ratings.h - marks by persons: who has what to mark, and how the marks come into the store.
//
//     auto queue = school::to_mark(*store, "A. Berg", "", 7);         // in random order, of that seed
//     Status kept = school::mark(*store, {queue->front().session, "A. Berg", true, {{"pit.floor", "met", ""}}});
//
// A rater is a name or a pseudonym that the centre chooses. A mark is given once: a mark that could be changed after
// somebody saw the machine's would not be blinded. Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

// ---- rubrics of the store

struct RubricRow {
  std::string hash, name, text;
  std::int64_t version = 0, calibrated = 0;
  std::int64_t sessions = 0;  // that were scored with it
};
// The one with which a session was scored last comes first.
[[nodiscard]] Result<std::vector<RubricRow>> rubrics(Store& store);
// given: a hash, or a name (its newest); empty: the only name. Error, Trouble::usage: there is no such rubric, or several.
[[nodiscard]] Result<RubricRow> rubric_in(Store& store, const std::string& given);

// ---- who marks what

inline constexpr std::size_t kLongestName = 60;     // of a person [bytes]
inline constexpr std::size_t kLongestReason = 500;  // [bytes]

// A person's name or pseudonym, for marks, standards and decisions. Error, Trouble::usage: it is empty, too long, holds
// control characters, or is the machine's.
[[nodiscard]] Status check_name(std::string_view what, std::string_view name);
// A sentence of a person; may be empty. Error, Trouble::usage: too long, or control characters.
[[nodiscard]] Status check_reason(std::string_view reason);

// What a rater gets to see: no learner, day, level or mark.
struct Product {
  std::string session, case_name, rubric_hash, recording_uri, recording_hash;
};
// Finished sessions with a score that this rater has not marked blinded, in random order: the same for the same seed and
// sessions. rubric_hash: empty for all. A rater who is a learner does not get the own ones.
[[nodiscard]] Result<std::vector<Product>> to_mark(Store& store, const std::string& rater,
                                                   const std::string& rubric_hash,
                                                   std::uint64_t seed);

struct RaterMark {
  std::string item;
  std::string mark;    // "met", "unmet", "not assessable"
  std::string reason;  // may be empty
};
struct Marking {
  std::string session, rater;
  bool blinded = true;
  std::vector<RaterMark> marks;
};
// All or nothing. Error, Trouble::usage: no such session, it is not finished or the rater's own, an item that it was not
// scored by, an unknown mark, or an item that this rater has marked there already.
[[nodiscard]] Status mark(Store& store, const Marking& marking);

struct RaterMarkRow {
  std::string session, rater, item, mark, reason;
  bool blinded = false;
  std::int64_t made_ms = 0;
};
// By session, rater, item. session: empty for all.
[[nodiscard]] Result<std::vector<RaterMarkRow>> rater_marks(Store& store,
                                                            const std::string& session = {});

}  // namespace burr::school
