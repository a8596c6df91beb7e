// school/export.h - the store as tables for other programs: all of it with pseudonyms alone, or all that is known of
// one learner, names included (a person may ask for it).
//
// CSV by RFC 4180: UTF-8, a comma, lines end with CR LF, the first names the columns. Thread: as the Store.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

struct TextFile {
  std::string name, text;
};

// One CSV a table. No names, no places on somebody's disk, no audit.
[[nodiscard]] Result<std::vector<TextFile>> all_tables(Store& store);

// session.csv of those alone.
[[nodiscard]] Result<TextFile> session_table(Store& store);

// One CSV a table that has rows, and learner.json with the same. Error: no such learner.
[[nodiscard]] Result<std::vector<TextFile>> tables_of(Store& store, const std::string& learner);

}  // namespace burr::school
