// school/statements.h - what burr says of a session to a learning record store, as statements of xAPI 1.0.3.
//
// The actor is an account: the centre's address and the pseudonym, never a name. The id of a statement is made from the
// session, the verb and the step, so the same session makes the same statements however often, and sending one again is
// harmless. A statement that somebody passed or failed is made from a person's decision alone.
// docs/teach/xapi.md is the description for people, docs/teach/xapi-profile.jsonld for programs.
// Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/school/session_record.h"

namespace burr::school {

inline constexpr std::string_view kProfile = "https://w3id.org/burr/xapi";

struct Statement {
  std::string id;    // a UUID
  std::string json;  // the whole statement, with the id
};

// initialized; progressed for each step that was declared done; then completed, or exited where the work was not declared
// done. home_page: the centre's, an IRI.
[[nodiscard]] std::vector<Statement> statements_of(const SessionRecord& record,
                                                   const std::string& home_page);

// A row of the table `decision`.
struct Decided {
  std::string learner, standard, outcome, confirmed_by;  // outcome: "pass", "fail"
  std::vector<std::string> sessions;                     // ids; the last gives the registration
  std::int64_t made_ms = 0;
};
// passed or failed. None: nobody confirmed it, it rests on no session of burr's, or it has another outcome. Who decided is not said:
// that is a person's name. case_name: of the sessions.
[[nodiscard]] std::optional<Statement> statement_of(const Decided& decision,
                                                    const std::string& case_name,
                                                    const std::string& home_page);

// Takes back another one, and names nobody.
[[nodiscard]] Statement voiding(const std::string& id, const std::string& home_page);

// A step of a case that was declared done is a metric "step_done ID" [s], since the session began.
inline constexpr std::string_view kStepDone = "step_done ";

[[nodiscard]] std::string iso_time(std::int64_t ms);                  // "2026-11-28T03:15:00.250Z"
[[nodiscard]] std::string iso_duration(double seconds);               // "PT61.25S"
[[nodiscard]] std::string activity_of(const std::string& case_name);  // the IRI of a case

}  // namespace burr::school
