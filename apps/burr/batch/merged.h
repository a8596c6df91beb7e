// apps/burr/batch/merged.h - the results of a batch as one table: a row for each row of the manifest, in its order.
//
// Columns: id, code (0: done, 65: refused), sentence (why it was refused), those of the manifest, then what was found, by name:
// `result.removed_mm3`. What lies deeper is named by its way: `result.items.bed.value`, an entry of a list by its id, name or step
// where each has one, otherwise by its number. A list of numbers or words is one cell, with "; " between them.
// The table depends on the manifest and the results alone: equal results give equal bytes. Thread: any.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "batch/manifest.h"
#include "burr/base/result.h"

namespace burr::app {

struct MergedRow {
  int code = 0;
  std::string sentence;
  std::map<std::string, nlohmann::json> found;  // null, bool, number or text
};

struct Merged {
  const Manifest& manifest;
  std::vector<MergedRow> rows;          // one for each of the manifest's
  std::vector<nlohmann::json> engines;  // that made them, sorted

  // Of what was found, sorted.
  [[nodiscard]] std::set<std::string> found_columns() const;
};

// What a result holds, by its way.
[[nodiscard]] std::map<std::string, nlohmann::json> flat(const nlohmann::json& result);

// The file is written whole or not at all.
[[nodiscard]] Status write_csv(const Merged& merged, const std::string& file);
// Tables `result` (as the CSV) and `engine`. Error: also more columns than SQLite takes (2000).
[[nodiscard]] Status write_sqlite(const Merged& merged, const std::string& file);

}  // namespace burr::app
