#include "batch/merged.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "batch/canonical.h"
#include "burr/base/new_file.h"
#include "burr/base/table_cell.h"

namespace burr::app {
namespace {

using nlohmann::json;

// The key by which the entries of a list are named; nullptr: by their numbers.
const char* naming_key(const json& list) {
  for (const char* key : {"id", "name", "step"}) {
    std::set<std::string> seen;
    const bool good = std::all_of(list.begin(), list.end(), [&](const json& one) {
      return one.is_object() && one.contains(key) && one[key].is_string() &&
             seen.insert(one[key].get<std::string>()).second;
    });
    if (good) return key;
  }
  return nullptr;
}

std::string text_of(const json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? value.get<std::string>() : canonical(value);
}

void flatten(const json& value, const std::string& way, std::map<std::string, json>& out) {
  if (value.is_object()) {
    for (const auto& [key, inside] : value.items()) flatten(inside, way + "." + key, out);
    return;
  }
  if (!value.is_array()) {
    out[way] = value;
    return;
  }
  if (std::none_of(value.begin(), value.end(),
                   [](const json& one) { return one.is_structured(); })) {
    std::string all;
    for (const json& one : value) all += (&one == &value.front() ? "" : "; ") + text_of(one);
    out[way] = all;
    return;
  }
  const char* key = naming_key(value);
  for (std::size_t n = 0; n < value.size(); ++n)
    flatten(value[n],
            way + "." + (key != nullptr ? value[n][key].get<std::string>() : std::to_string(n)),
            out);
}

}  // namespace

std::set<std::string> Merged::found_columns() const {
  std::set<std::string> names;
  for (const MergedRow& row : rows)
    for (const auto& [name, value] : row.found) names.insert(name);
  return names;
}

std::map<std::string, json> flat(const json& result) {
  std::map<std::string, json> out;
  flatten(result, "result", out);
  return out;
}

Status write_csv(const Merged& merged, const std::string& file) {
  auto out = base::NewFile::create(file, base::kForAll);
  if (!out) return out.error();
  const std::set<std::string> found = merged.found_columns();
  const std::vector<std::string>& given = merged.manifest.columns;
  std::string line = "id,code,sentence";
  for (const std::string& name : given)
    if (name != "id") line += "," + base::table_cell(name);
  for (const std::string& name : found) line += "," + base::table_cell(name);
  out->write(line + "\n");
  for (std::size_t n = 0; n < merged.rows.size(); ++n) {
    const ManifestRow& row = merged.manifest.rows[n];
    const MergedRow& one = merged.rows[n];
    line = base::table_cell(row.id) + "," + std::to_string(one.code) + "," +
           base::table_cell(one.sentence);
    for (std::size_t c = 0; c < given.size(); ++c)
      if (given[c] != "id") line += "," + base::table_cell(row.cells[c]);
    for (const std::string& name : found) {
      const auto at = one.found.find(name);
      line += "," + (at == one.found.end() ? "" : base::table_cell(text_of(at->second)));
    }
    out->write(line + "\n");
  }
  return out->put_in_place();
}

}  // namespace burr::app
