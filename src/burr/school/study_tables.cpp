#include "burr/school/study_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "burr/base/printable.h"
#include "burr/base/table_cell.h"
#include "burr/school/export.h"

namespace burr::school {
namespace {

study::Table table_of(std::string name, std::vector<std::string> columns) {
  study::Table out;
  out.file = std::move(name);
  out.columns = std::move(columns);
  return out;
}

void add(study::Table& to, std::vector<std::string> row) {
  to.rows.push_back(std::move(row));
  to.lines.push_back(static_cast<int>(to.rows.size()) + 1);  // as csv_of() writes it
}

}  // namespace

Result<study::Table> marks_table(Store& store, const std::string& rubric_hash,
                                 const std::string& part, Which which) {
  // attempts are counted over all of a learner's sessions at a case, as everywhere
  const auto found = store.database().rows(
      "WITH counted AS (SELECT session.id, session.learner_id, session.case_hash, session.guided, "
      "session.finished, session.started_ms, ROW_NUMBER() OVER (PARTITION BY session.learner_id, "
      "case_def.name ORDER BY session.started_ms, session.id) AS attempt FROM session "
      "LEFT JOIN case_def ON case_def.hash = session.case_hash) "
      "SELECT counted.learner_id, score.total, counted.attempt, counted.case_hash, counted.guided "
      "FROM counted JOIN score ON score.session_id = counted.id "
      "WHERE counted.finished = 1 AND score.rubric_hash = $1 AND score.part = $2 "
      "AND score.total IS NOT NULL AND NOT EXISTS (SELECT 1 FROM score AS later "
      "WHERE later.session_id = score.session_id AND later.part = score.part "
      "AND later.rubric_hash = score.rubric_hash AND (later.made_ms > score.made_ms "
      "OR (later.made_ms = score.made_ms AND later.id > score.id))) "
      "AND ($3 = 1 OR EXISTS (SELECT 1 FROM seal WHERE seal.session_id = counted.id)) "
      "ORDER BY counted.learner_id, counted.started_ms, counted.id",
      {rubric_hash, part, std::int64_t{which == Which::all}});
  if (!found) return found.error();
  study::Table out = table_of("the store", {"learner", "mark", "attempt", "bone", "guided"});
  for (const Row& row : *found)
    add(out, {text(row[0]), written(row[1]), written(row[2]), text(row[3]), written(row[4])});
  if (out.rows.empty())
    return error(Trouble::usage,
                 fmt::format("the store has no {}finished session with points of the {}",
                             which == Which::sealed ? "sealed, " : "", base::printable(part)));
  return out;
}

Result<study::Table> groups_table(Store& store, const std::string& rubric_hash,
                                  const std::string& part, const std::vector<std::string>& low,
                                  const std::vector<std::string>& high) {
  const auto marks = marks_table(store, rubric_hash, part, Which::sealed);
  if (!marks) return marks.error();
  const auto people = store.database().rows("SELECT id, level FROM learner");
  if (!people) return people.error();
  std::map<std::string, std::string> group;
  const auto among = [](const std::vector<std::string>& levels, const std::string& level) {
    return std::find(levels.begin(), levels.end(), level) != levels.end();
  };
  for (const Row& row : *people) {
    const std::string level = text(row[1]);
    if (among(low, level) && among(high, level))
      return error(Trouble::usage,
                   fmt::format("level {} is in both groups", base::printable(level)));
    if (among(low, level)) group[text(row[0])] = "low";
    if (among(high, level)) group[text(row[0])] = "high";
  }
  std::map<std::string, std::string> last;
  for (const std::vector<std::string>& row : marks->rows)
    if (row[4] == "0" && group.contains(row[0])) last[row[0]] = row[1];
  study::Table out = table_of("the store", {"group", "mark"});
  for (const auto& [learner, mark] : last) add(out, {group[learner], mark});
  if (out.rows.empty())
    return error(Trouble::usage,
                 "no learner of these levels has a sealed, finished session without guidance");
  return out;
}

Result<study::Table> ratings_table(Store& store, const std::string& rubric_hash) {
  // the machine's marks first: all raters of a pair are then in one order
  const auto machine = store.database().rows(
      "SELECT score.session_id, item.item_id, item.result FROM score "
      "JOIN item ON item.score_id = score.id WHERE score.rubric_hash = $1 "
      "AND EXISTS (SELECT 1 FROM rater_mark WHERE rater_mark.session_id = score.session_id "
      "AND rater_mark.blinded = 1) AND item.item_id IN (SELECT item_id FROM rater_mark "
      "WHERE blinded = 1) AND NOT EXISTS (SELECT 1 FROM score AS later "
      "WHERE later.session_id = score.session_id AND later.part = score.part "
      "AND later.rubric_hash = score.rubric_hash AND (later.made_ms > score.made_ms "
      "OR (later.made_ms = score.made_ms AND later.id > score.id))) "
      "ORDER BY score.session_id, item.item_id",
      {rubric_hash});
  if (!machine) return machine.error();
  const auto people = store.database().rows(
      "SELECT rater_mark.session_id, rater_mark.rater_id, rater_mark.item_id, rater_mark.mark "
      "FROM rater_mark WHERE rater_mark.blinded = 1 AND rater_mark.rater_id <> 'forgotten' "
      "AND EXISTS (SELECT 1 FROM score JOIN item ON item.score_id = score.id "
      "WHERE score.session_id = rater_mark.session_id AND score.rubric_hash = $1 "
      "AND item.item_id = rater_mark.item_id) "
      "ORDER BY rater_mark.rater_id, rater_mark.session_id, rater_mark.item_id",
      {rubric_hash});
  if (!people) return people.error();
  study::Table out = table_of("the store", {"product", "rater", "item", "met"});
  const auto put = [&](const std::string& product, const std::string& rater,
                       const std::string& item, const std::string& result) {
    if (result == "met" || result == "unmet")
      add(out, {product, rater, item, result == "met" ? "1" : "0"});
  };
  if (!people->empty())
    for (const Row& row : *machine) put(text(row[0]), "machine", text(row[1]), text(row[2]));
  for (const Row& row : *people) put(text(row[0]), text(row[1]), text(row[2]), text(row[3]));
  if (out.rows.empty())
    return error(Trouble::usage, "nobody has marked a session of this rubric blinded yet");
  return out;
}

std::string csv_of(const study::Table& table) {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t n = 0; n < cells.size(); ++n)
      out += (n == 0 ? "" : ",") + base::table_cell(cells[n]);
    out += "\r\n";
  };
  line(table.columns);
  for (const std::vector<std::string>& row : table.rows) line(row);
  return out;
}

}  // namespace burr::school
