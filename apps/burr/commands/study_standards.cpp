#include "commands/study_standards.h"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/printable.h"
#include "burr/school/decisions.h"
#include "burr/school/ratings.h"
#include "burr/school/study/standards.h"
#include "burr/school/study/table.h"
#include "school/store_command.h"
#include "school/study_source.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

namespace study = school::study;
using Json = nlohmann::ordered_json;
using Options = StudyOptions;

// "levels PGY1, PGY2 against surgeon"
std::string groups_in(const StudySource& source) {
  return fmt::format("levels {} against {}", base::list_of(source.low), base::list_of(source.high));
}

Status contrasting(const Options& options, school::Standard& found) {
  auto table = table_for(options.source, Asked::groups, {"group", "mark"});
  if (!table) return table.error();
  std::vector<double> low, high;
  for (std::size_t n = 0; n < table->rows.size(); ++n) {
    const auto mark = table->number(n, 1);
    if (!mark) return mark.error();
    const std::string& group = table->rows[n][0];
    if (group != "low" && group != "high")
      return error(fmt::format("{}: \"{}\" is neither low nor high", table->place(n, 0),
                               base::printable(group)));
    (group == "low" ? low : high).push_back(*mark);
  }
  const auto out = study::contrasting_groups(low, high, options.seed);
  if (!out) return error(fmt::format("{}: {}", table->file, out.error().text));
  found.method = "contrasting groups";
  found.cut = out->cut;
  found.n_low = out->n_low;
  found.n_high = out->n_high;
  found.false_pass = out->pass_expected;
  found.false_fail = out->fail_expected;
  found.text = fmt::format("{}; 95 % of the cut: {:.4g} to {:.4g}", groups_in(options.source),
                           out->cut_95.low, out->cut_95.high);
  if (options.json) {
    fmt::print("{}\n", json_line(Json{{"method", "contrasting groups"},
                                      {"cut", out->cut},
                                      {"cut_95", interval(out->cut_95)},
                                      {"low",
                                       {{"n", out->n_low},
                                        {"mean", out->mean_low},
                                        {"deviation", out->deviation_low},
                                        {"pass", out->pass_seen},
                                        {"pass_expected", out->pass_expected},
                                        {"pass_95", interval(out->pass_95)}}},
                                      {"high",
                                       {{"n", out->n_high},
                                        {"mean", out->mean_high},
                                        {"deviation", out->deviation_high},
                                        {"fail", out->fail_seen},
                                        {"fail_expected", out->fail_expected},
                                        {"fail_95", interval(out->fail_95)}}}}));
    return fine();
  }
  fmt::print("cut: {:.4g} (95 %: {:.4g} to {:.4g})\n", out->cut, out->cut_95.low, out->cut_95.high);
  fmt::print(
      "low:  {} marks, mean {:.4g}, deviation {:.4g}; {:.0f} % of them would pass, {:.0f} % "
      "expected (95 %: {:.0f} to {:.0f})\n",
      out->n_low, out->mean_low, out->deviation_low, 100 * out->pass_seen, 100 * out->pass_expected,
      100 * out->pass_95.low, 100 * out->pass_95.high);
  fmt::print(
      "high: {} marks, mean {:.4g}, deviation {:.4g}; {:.0f} % of them would fail, {:.0f} % "
      "expected (95 %: {:.0f} to {:.0f})\n",
      out->n_high, out->mean_high, out->deviation_high, 100 * out->fail_seen,
      100 * out->fail_expected, 100 * out->fail_95.low, 100 * out->fail_95.high);
  fmt::print("This is a proposal. A person of the centre sets the standard.\n");
  return fine();
}

// The judges' probabilities in the order of the items of the first judge, which `items` gets.
Result<std::vector<std::vector<double>>> judged(const study::Table& table,
                                                std::vector<std::string>& items) {
  std::vector<std::string> judges;
  std::map<std::string, std::map<std::string, double>> of;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    const auto p = table.number(n, 2, 0, 1);
    if (!p) return p.error();
    const std::string &judge = table.rows[n][0], &item = table.rows[n][1];
    if (!of.contains(judge)) judges.push_back(judge);
    if (!of[judge].emplace(item, *p).second)
      return error(fmt::format("{}: judge {} judged item {} twice; keep one", table.place(n, 1),
                               base::printable(judge), base::printable(item)));
  }
  std::vector<std::vector<double>> out;
  for (const auto& [item, unused] : of[judges.front()]) items.push_back(item);
  for (const std::string& judge : judges) {
    std::vector<double>& row = out.emplace_back();
    for (const auto& [item, unused] : of[judges.front()]) {
      const auto found = of[judge].find(item);
      if (found == of[judge].end())
        return error(fmt::format("{}: judge {} did not judge item {}; each judge judges all items",
                                 table.file, base::printable(judge), base::printable(item)));
      row.push_back(found->second);
    }
    if (of[judge].size() != row.size())
      return error(
          fmt::format("{}: judge {} judged an item that {} did not; each judge judges all items",
                      table.file, base::printable(judge), base::printable(judges.front())));
  }
  return out;
}

// The cut in points: items count by their weights.
Status angoff_in_points(const StudySource& source, const std::vector<std::string>& items,
                        std::vector<std::vector<double>> rows, school::Standard& found) {
  const auto points = points_of_items(source, items);
  if (!points) return points.error();
  for (std::vector<double>& row : rows)
    for (std::size_t n = 0; n < row.size(); ++n) row[n] *= (*points)[n];
  const auto out = study::angoff(rows);
  if (!out) return out.error();
  found.method = "Angoff";
  found.cut = out->cut;
  found.judges = out->judges;
  found.text = fmt::format("{} items; 95 % of the cut: {:.4g} to {:.4g}", out->items,
                           out->cut_95.low, out->cut_95.high);
  return fine();
}

Status angoff(const Options& options, school::Standard& found) {
  auto table = study::read_table(options.source.path, {"judge", "item", "probability"});
  if (!table) return table.error();
  std::vector<std::string> items;
  const auto rows = judged(*table, items);
  if (!rows) return rows.error();
  const auto out = study::angoff(*rows);
  if (!out) return error(fmt::format("{}: {}", table->file, out.error().text));
  if (options.source.from_store)
    if (const Status made = angoff_in_points(options.source, items, *rows, found); !made)
      return made;
  if (options.json)
    fmt::print("{}\n", json_line(Json{{"method", "Angoff"},
                                      {"judges", out->judges},
                                      {"items", out->items},
                                      {"cut", out->cut},
                                      {"deviation", out->deviation},
                                      {"cut_95", interval(out->cut_95)}}));
  else
    fmt::print(
        "cut: {:.2f} of {} items (95 %: {:.2f} to {:.2f}); {} judges, deviation {:.2f}\n"
        "This is a proposal. A person of the centre sets the standard.\n",
        out->cut, out->items, out->cut_95.low, out->cut_95.high, out->judges, out->deviation);
  return fine();
}

Result<std::vector<double>> marks_for_hofstee(const Options& options) {
  if (options.source.from_store) return last_marks(options.source);
  if (options.marks.empty())
    return error(Trouble::usage,
                 "--method hofstee: give the marks with --marks F.csv (column mark), or --store");
  const auto table = study::read_table(options.marks, {"mark"});
  if (!table) return table.error();
  std::vector<double> marks;
  for (std::size_t n = 0; n < table->rows.size(); ++n) {
    const auto mark = table->number(n, 0);
    if (!mark) return mark.error();
    marks.push_back(*mark);
  }
  return marks;
}

Status hofstee(const Options& options, school::Standard& found) {
  const auto marks = marks_for_hofstee(options);
  if (!marks) return marks.error();
  auto table =
      study::read_table(options.source.path, {"cut_low", "cut_high", "fail_low", "fail_high"});
  if (!table) return table.error();
  std::vector<study::HofsteeJudge> judges;
  for (std::size_t n = 0; n < table->rows.size(); ++n) {
    study::HofsteeJudge& judge = judges.emplace_back();
    double* const places[] = {&judge.cut_low, &judge.cut_high, &judge.fail_low, &judge.fail_high};
    for (std::size_t c = 0; c < 4; ++c) {
      const auto value = c < 2 ? table->number(n, c) : table->number(n, c, 0, 1);
      if (!value) return value.error();
      *places[c] = *value;
    }
  }
  const auto out = study::hofstee(judges, *marks);
  if (!out) return error(fmt::format("{}: {}", table->file, out.error().text));
  found.method = "Hofstee";
  found.cut = out->cut;
  found.judges = out->judges;
  found.text = fmt::format("{:.0f} % of {} marks lie below the cut", 100 * out->fail, out->marks);
  if (options.json)
    fmt::print("{}\n", json_line(Json{{"method", "Hofstee"},
                                      {"judges", out->judges},
                                      {"marks", out->marks},
                                      {"cut", out->cut},
                                      {"fail", out->fail}}));
  else
    fmt::print(
        "cut: {:.4g}; {:.0f} % of the {} marks lie below it; {} judges\n"
        "This is a proposal. A person of the centre sets the standard.\n",
        out->cut, 100 * out->fail, out->marks, out->judges);
  return fine();
}

}  // namespace

Json interval(const study::Interval& of) { return {of.low, of.high}; }

Status propose_standard(const StudyOptions& options) {
  const bool keeps = !options.set_by.empty();
  if (keeps && !options.source.from_store)
    return error(Trouble::usage, "--set-by: name the store of the centre too, with --store");
  if (options.method != "contrasting" && options.source.path.empty())
    return error(Trouble::usage, "give the judges' table (F.csv)");
  school::Standard found;
  const Status done = options.method == "angoff"    ? angoff(options, found)
                      : options.method == "hofstee" ? hofstee(options, found)
                                                    : contrasting(options, found);
  if (!done || !keeps) return done;
  found.set_by = options.set_by;
  if (!options.note.empty()) found.text += "; " + options.note;
  const auto id = keep_standard(options.source, found);
  if (!id) return id.error();
  if (options.json)
    fmt::print("{}\n", json_line(Json{{"standard", *id}, {"cut", found.cut}}));
  else
    fmt::print("kept as standard {}: {:.4g} points of the {}, set by {}\n", *id, found.cut,
               options.source.part, base::printable(found.set_by));
  return fine();
}

Status list_standards(const StudyOptions& options) {
  const auto store = store_that_is_there(options.source.store);
  if (!store) return store.error();
  const auto all = school::standards(**store);
  if (!all) return all.error();
  Json json = Json::array();
  for (const school::Standard& one : *all) {
    if (options.json)
      json.push_back({{"id", one.id},
                      {"rubric", one.rubric},
                      {"part", one.part},
                      {"method", one.method},
                      {"cut", one.cut},
                      {"set_by", one.set_by},
                      {"made_ms", one.made_ms},
                      {"text", one.text}});
    else
      fmt::print("{}  {} of {}: {:.4g} points, {} ({}); set by {}\n", one.id, one.part,
                 base::printable(one.rubric), one.cut, one.method,
                 base::printable(one.text, school::kLongestReason), base::printable(one.set_by));
  }
  if (options.json)
    fmt::print("{}\n", json_line(json));
  else if (all->empty())
    fmt::print("This centre has set no standard.\n");
  return fine();
}

}  // namespace burr::app
