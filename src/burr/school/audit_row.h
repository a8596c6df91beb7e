// school/audit_row.h - one more row of the audit, in a chain of hashes: a row that somebody changed, took out or put between
// others is found (school/audit_check.h). For use of this room only.
//
// Each row has a number, a digest of who and what it is about, with salt, and a hash of all that and of the hash before
// it. A learner who is forgotten takes who, subject and salt away; the digest stays, and says nothing without them.
// Thread: as the Database.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"
#include "burr/school/database.h"

namespace burr::school {

// Within a transaction.
[[nodiscard]] Status add_to_audit(Database& database, std::int64_t ms, const std::string& who,
                                  std::string_view what, std::string_view subject);

[[nodiscard]] std::string audit_digest(const std::string& salt, const std::string& who,
                                       const std::string& subject);
// before: of the row before; empty: there is none.
[[nodiscard]] std::string audit_hash(const std::string& before, std::int64_t number,
                                     std::int64_t ms, const std::string& what,
                                     const std::string& digest);

}  // namespace burr::school
