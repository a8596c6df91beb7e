// school/decisions.h - standards that a centre set, what they propose for a learner, and what a person decided.
//
//     auto id = school::set_standard(*store, standard);
//     auto said = school::proposal(*store, standards->front(), "heron-4821");   // a proposal, never a decision
//     auto done = school::decide(*store, {"heron-4821", *id, "pass", "", "as proposed"}, &key);
//
// Without a standard nothing in burr says "pass". The machine decides nothing: a decision has a person, who proves it by a
// key or a login, a reason, and the set of sessions that it rests on. Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/signing_key.h"
#include "burr/school/store.h"

namespace burr::school {

struct Standard {
  std::string id;           // set_standard() makes it
  std::string rubric_hash;  // the text of the rubric that it is about
  std::string rubric;       // its name
  std::string part;         // "product", "process"
  std::string method;       // "contrasting groups", "Angoff", "Hofstee"
  double cut = 0;           // points of the part, 0..100
  std::optional<std::int64_t> n_low, n_high, judges;
  std::optional<double> false_pass, false_fail;  // expected shares, 0..1
  std::string text;                              // what was done, for people
  std::string set_by;                            // a person
  std::int64_t made_ms = 0;
};
// Error, Trouble::usage: fewer than 8 people in a group or 5 judges, a cut that is not between 0 and 100, no person who
// sets it, or the store has no such rubric. Returns its id.
[[nodiscard]] Result<std::string> set_standard(Store& store, const Standard& standard);
// The oldest first.
[[nodiscard]] Result<std::vector<Standard>> standards(Store& store);
// By its id, or the beginning of it that no other has.
[[nodiscard]] Result<Standard> standard_in(Store& store, const std::string& id);

// In that many sessions one after the other the cut must be reached, and no gate broken.
inline constexpr std::size_t kInARow = 2;

// What the rule says of a learner: sealed, finished sessions without guidance that were scored by the standard's rubric,
// by time.
struct Proposal {
  struct Seen {
    std::string session;
    std::optional<double> points;  // none: too little could be judged
    std::int64_t gates_broken = 0;
    bool holds = false;  // the cut is reached and no gate broken
  };
  std::vector<Seen> sessions;
  bool reached = false;   // kInARow sessions hold, one after the other
  std::size_t first = 0;  // of these; counted from 0
};
[[nodiscard]] Result<Proposal> proposal(Store& store, const Standard& standard,
                                        const std::string& learner);
// The same for all learners that have such a session, by pseudonym.
[[nodiscard]] Result<std::vector<std::pair<std::string, Proposal>>> proposals(
    Store& store, const Standard& standard);

struct Decision {
  std::string learner, standard;
  std::string outcome;  // "pass", "fail"
  std::string confirmed_by, reason;
  std::string id = {};                     // decide() makes it
  std::vector<std::string> sessions = {};  // decide() finds them
  std::int64_t made_ms = 0;
  std::string signature =
      {};  // of the key of who confirmed it; empty: by a login, or before 2026-12-01
};
// What is signed.
[[nodiscard]] std::string decision_words(const Decision& decision);
// confirmed_by is filled in: the name of the key, which must be enrolled as a decider's; on a server without a key
// (nullptr) the login. Error, Trouble::usage: neither; no such learner or standard, another outcome, no reason, who confirms
// is the learner, or the learner has no session that the standard is about. Returns the decision as it was stored.
[[nodiscard]] Result<Decision> decide(Store& store, const Decision& decision,
                                      const SigningKey* key = nullptr);
// The oldest first. learner: empty for all.
[[nodiscard]] Result<std::vector<Decision>> decisions(Store& store,
                                                      const std::string& learner = {});

}  // namespace burr::school
