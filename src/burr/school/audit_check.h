// school/audit_check.h - whether the audit is as it was written (school/audit_row.h): a row that somebody changed, took out
// or put between others is found, and so is a seal or a decision that no key signed.
//
//     auto found = check_audit(*store, "");
//     fmt::print("{} rows, up to {}\n", found->rows, found->head);     // written down, it shows later that nothing is gone
//
// Whoever may write all rows can compute the chain anew: in a file that is its owner, on a server nobody but the owner
// of the tables. Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <string>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

struct AuditFound {
  std::int64_t rows = 0;                  // in the chain
  std::int64_t older = 0;                 // written before there was one (2026-12-01)
  std::int64_t forgotten = 0;             // of people who were forgotten
  std::int64_t seals = 0, decisions = 0;  // whose signatures fit
  std::string head;                       // the hash of the last row; empty: there is none
};
// since: the head of an earlier check, which must still be in the chain; empty: nobody asks. Error, Trouble::failed: the
// first row that is wrong, or the session or the decision whose signature does not fit.
[[nodiscard]] Result<AuditFound> check_audit(Store& store, const std::string& since);

}  // namespace burr::school
