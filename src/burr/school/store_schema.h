// school/store_schema.h - the tables of the store, the same for SQLite and PostgreSQL, and the steps from an older version to
// this one. For use of this room only. docs/teach/school.md describes each table.
//
// Thread: as the Database.
#pragma once

#include <cstdint>

#include "burr/school/database.h"

namespace burr::school {

inline constexpr std::int64_t kSchema = 5;  // the version that this burr writes

// Brings the store to `to`. Returns the version that it then has, which is larger where a newer burr made it: such a
// store is left as it is. Several programs may do this at once.
[[nodiscard]] Result<std::int64_t> bring_to(Database& database, std::int64_t now_ms,
                                            std::int64_t to = kSchema);

}  // namespace burr::school
