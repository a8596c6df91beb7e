// `burr study`: what a centre must know of its marks before it decides by them - reliability, agreement of raters, cuts,
// learning curves. From the store of learners, and from tables (CSV), so also from marks that burr did not give.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "burr/base/printable.h"
#include "burr/school/decisions.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "burr/school/study/curve.h"
#include "burr/school/study/raters.h"
#include "burr/school/study/reliability.h"
#include "burr/school/study/standards.h"
#include "burr/school/study/table.h"
#include "school/agreement.h"
#include "school/store_command.h"
#include "school/study_source.h"
#include "shared/command.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

namespace study = school::study;
using Json = nlohmann::ordered_json;

struct Options {
  StudySource source;
  std::string method = "contrasting", marks, set_by, note;
  int occasions = 5;
  unsigned long seed = 1;
  bool bones = false, json = false;
};

Json interval(const study::Interval& of) { return {of.low, of.high}; }

// ---- reliability

void print(const study::Reliability& of, const study::Balanced& used, const study::Interval& g_95) {
  fmt::print("{} learners, the last {} marks of each{}\n", of.persons, of.occasions,
             of.bones > 1 ? fmt::format(" on each of {} bones", of.bones) : "");
  if (used.left_out > 0) fmt::print("{} learners with fewer marks were left out\n", used.left_out);
  const std::pair<const char*, const study::Component*> parts[] = {
      {"learners", &of.person},
      {"bones", &of.bone},
      {"occasions", &of.occasion},
      {"learner and bone", &of.person_bone},
      {"what is left", &of.residual}};
  double all = 0;
  for (const auto& [name, part] : parts) all += part->variance;
  fmt::print("{:<18} {:>10} {:>8}\n", "variance", "", "share");
  for (const auto& [name, part] : parts)
    if (part->freedom > 0)
      fmt::print("{:<18} {:>10.4g} {:>6.0f} %{}\n", name, part->variance,
                 all > 0 ? 100 * part->variance / all : 0,
                 part->raw < 0 ? "  (the estimate is below 0)" : "");
  fmt::print("marks{}  G      Phi    standard error of their mean\n",
             of.bones > 1 ? " on each bone" : "");
  for (const int n : {1, 2, 3, 5, 8, 12})
    fmt::print("{:>5}{}  {:.2f}   {:.2f}   {:.3g}\n", n, of.bones > 1 ? "             " : "",
               of.g(n, of.bones), of.phi(n, of.bones), of.standard_error(n, of.bones));
  fmt::print("G of {} marks: {:.2f} (95 %: {:.2f} to {:.2f})\n", of.occasions,
             of.g(of.occasions, of.bones), g_95.low, g_95.high);
  if (const auto n = of.enough(0.8, of.bones))
    fmt::print(
        "G exceeds 0.8 from {} marks{} on. Fewer are too few for a decision about a person.\n", *n,
        of.bones > 1 ? " on each bone" : "");
  else
    fmt::print(
        "Even 100 marks do not reach G = 0.8: these marks do not tell the learners apart.\n");
}

Status reliability(const Options& options) {
  auto table = table_for(options.source, Asked::marks, {"learner", "mark"}, {"bone", "guided"});
  if (!table) return table.error();
  const auto marks = marks_of(*table);
  if (!marks) return marks.error();
  const auto used = study::balance(*marks, options.occasions, options.bones);
  if (!used)
    return error(used.error().trouble, fmt::format("{}: {}", table->file, used.error().text));
  const auto people = static_cast<std::int64_t>(used->persons.size());
  if (options.source.from_store && people < school::kFewestPeople)
    return error(
        Trouble::usage,
        fmt::format("{} of {} learners have {} finished sessions without guidance; figures "
                    "of fewer than {} people are not shown",
                    people, people + used->left_out, options.occasions, school::kFewestPeople));
  const study::Reliability out = study::reliability(*used);
  const study::Interval g_95 = study::interval_of_g(*used, options.occasions, 2000, options.seed);
  if (!options.json) {
    print(out, *used, g_95);
    return fine();
  }
  Json json = {{"learners", out.persons},
               {"left_out", used->left_out},
               {"marks", out.occasions},
               {"bones", out.bones}};
  for (const auto& [name, part] : {std::pair{"learner", &out.person},
                                   {"bone", &out.bone},
                                   {"occasion", &out.occasion},
                                   {"learner_bone", &out.person_bone},
                                   {"residual", &out.residual}})
    json["variance"][name] = part->variance;
  for (int n = 1; n <= 20; ++n)
    json["of"].push_back({{"marks", n},
                          {"g", out.g(n, out.bones)},
                          {"phi", out.phi(n, out.bones)},
                          {"standard_error", out.standard_error(n, out.bones)}});
  json["g_95"] = interval(g_95);
  const auto enough = out.enough(0.8, out.bones);
  json["enough"] = enough ? Json(*enough) : Json(nullptr);
  fmt::print("{}\n", json_line(json));
  return fine();
}

// ---- raters

void print(const study::RaterStudy& of) {
  fmt::print("{:<24} {:<24} {:>8} {:>10} {:>26} {:>6} {:>11}\n", "item", "raters", "products",
             "agreement", "kappa (95 %)", "AC1", "prevalence");
  for (const study::ItemAgreement& one : of.pairs) {
    const study::Agreement& f = one.figures;
    const std::string kappa = f.kappa ? fmt::format("{:.2f} ({:.2f} to {:.2f})", *f.kappa,
                                                    f.kappa_95.low, f.kappa_95.high)
                                      : "none";
    fmt::print("{:<24} {:<24} {:>8} {:>8.0f} % {:>26} {:>6.2f} {:>11.2f}\n",
               one.item.empty() ? "all items" : base::printable(one.item),
               base::printable(one.first) + ", " + base::printable(one.second), f.products,
               100 * f.agreement, kappa, f.ac1, f.prevalence_index);
  }
  if (of.icc)
    fmt::print("totals of {} products: ICC(A,1) {:.2f}\n", of.complete, *of.icc);
  else
    fmt::print("totals: {} products were marked in full by all raters; below {} no ICC is given\n",
               of.complete, study::kFewestProducts);
  for (const study::TotalsApart& one : of.apart)
    fmt::print(
        "totals of {} minus those of {}: {:+.2f} items on average, 95 % of them between {:+.2f} "
        "and {:+.2f}\n",
        base::printable(one.first), base::printable(one.second), one.figures.mean,
        one.figures.limits.low, one.figures.limits.high);
  if (!of.ask_a_person.empty())
    fmt::print(
        "the machine agrees with people more than 5 points less than people with each other; ask a "
        "person: {}\n",
        base::list_of(of.ask_a_person));
}

Status raters(const Options& options) {
  auto table = table_for(options.source, Asked::ratings, {"product", "rater", "item", "met"});
  if (!table) return table.error();
  const auto ratings = ratings_of(*table);
  if (!ratings) return ratings.error();
  const auto out = study::study_raters(*ratings, options.seed);
  if (!out) return error(fmt::format("{}: {}", table->file, out.error().text));
  if (!options.json) {
    print(*out);
    return fine();
  }
  Json json = {{"raters", out->raters}, {"items", out->items}, {"pairs", Json::array()}};
  for (const study::ItemAgreement& one : out->pairs) {
    const study::Agreement& f = one.figures;
    json["pairs"].push_back({{"item", one.item},
                             {"first", one.first},
                             {"second", one.second},
                             {"products", f.products},
                             {"agreement", f.agreement},
                             {"agreement_95", interval(f.agreement_95)},
                             {"kappa", f.kappa ? Json(*f.kappa) : Json(nullptr)},
                             {"kappa_95", interval(f.kappa_95)},
                             {"ac1", f.ac1},
                             {"prevalence_index", f.prevalence_index}});
  }
  json["complete"] = out->complete;
  json["icc_a1"] = out->icc ? Json(*out->icc) : Json(nullptr);
  for (const study::TotalsApart& one : out->apart)
    json["totals_apart"].push_back({{"first", one.first},
                                    {"second", one.second},
                                    {"mean", one.figures.mean},
                                    {"deviation", one.figures.deviation},
                                    {"limits", interval(one.figures.limits)}});
  json["ask_a_person"] = out->ask_a_person;
  fmt::print("{}\n", json_line(json));
  return fine();
}

// ---- standards

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

Status standard(const Options& options) {
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

Status list_standards(const Options& options) {
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

// ---- curves

void print(const std::string& learner, const study::Curve& curve) {
  fmt::print("{}: {} attempts without guidance, {} guided; ", base::printable(learner),
             curve.unguided, curve.guided);
  if (curve.kind == study::CurveKind::points) {
    fmt::print("no fit ({} of {} needed, not all the same)\n", curve.unguided, curve.needed);
    return;
  }
  fmt::print("{}; marks scatter by {:.3g}; ",
             curve.kind == study::CurveKind::inverse
                 ? fmt::format("{:.4g} - {:.3g} / n", curve.a, curve.b)
                 : fmt::format("{:.4g} - {:.3g} exp(-{:.3g} n)", curve.a, curve.b, curve.c),
             curve.scale);
  fmt::print("{}\n", curve.n90
                         ? fmt::format("90 % of the plateau after {:.1f} attempts", *curve.n90)
                         : std::string("the marks do not rise"));
}

Status curve(const Options& options) {
  auto table =
      table_for(options.source, Asked::marks, {"learner", "mark"}, {"attempt", "bone", "guided"});
  if (!table) return table.error();
  std::vector<std::string> learners;
  std::map<std::string, std::vector<study::Attempt>> of;
  for (std::size_t n = 0; n < table->rows.size(); ++n) {
    const std::vector<std::string>& row = table->rows[n];
    if (!of.contains(row[0])) learners.push_back(row[0]);
    std::vector<study::Attempt>& attempts = of[row[0]];
    const auto mark = table->number(n, 1);
    if (!mark) return mark.error();
    study::Attempt attempt{static_cast<int>(attempts.size()) + 1, row[3], *mark, false};
    if (!row[2].empty()) {
      const auto number = table->number(n, 2, 1, 1e6);
      if (!number) return number.error();
      if (*number != std::floor(*number))
        return error(fmt::format("{}: {} is not a whole number", table->place(n, 2), *number));
      attempt.number = static_cast<int>(*number);
    }
    if (!row[4].empty()) {
      const auto guided = table->flag(n, 4);
      if (!guided) return guided.error();
      attempt.guided = *guided;
    }
    attempts.push_back(std::move(attempt));
  }
  Json json = Json::array();
  for (const std::string& learner : learners) {
    const study::Curve fit = study::fit_curve(of[learner]);
    if (!options.json) {
      print(learner, fit);
      continue;
    }
    Json one = {{"learner", learner}, {"unguided", fit.unguided}, {"guided", fit.guided}};
    if (fit.kind != study::CurveKind::points) {
      const bool inverse = fit.kind == study::CurveKind::inverse;
      one.update({{"curve", inverse ? "a - b / n" : "a - b exp(-c n)"},
                  {"a", fit.a},
                  {"b", fit.b},
                  {"scale", fit.scale},
                  {"bones", fit.bones},
                  {"offsets", fit.offsets}});
      if (!inverse) one["c"] = fit.c;
      one["n90"] = fit.n90 ? Json(*fit.n90) : Json(nullptr);
      int last = 1;
      for (const study::Attempt& attempt : of[learner]) last = std::max(last, attempt.number);
      for (const study::Interval& at :
           study::band(of[learner], fit, std::min(last, 200), options.seed))
        one["band_95"].push_back(interval(at));
    }
    json.push_back(std::move(one));
  }
  if (options.json) fmt::print("{}\n", json_line(json));
  return fine();
}

// ---- the command

void add_store(CLI::App& command, const std::shared_ptr<Options>& options) {
  command
      .add_option("--store", options->source.store,
                  "in place of a table: the store of learners, a file or postgresql://...; "
                  "default: as `burr learner`")
      ->expected(0, 1);
}

CLI::App& part(CLI::App& command, Todo& todo, const char* name, const char* what,
               const char* columns, const std::shared_ptr<Options>& options,
               Status (*work)(const Options&)) {
  CLI::App* one = command.add_subcommand(name, what);
  StudySource& source = options->source;
  one->add_option("table", source.path, columns);
  add_store(*one, options);
  one->add_option("--rubric", source.rubric,
                  "of the store: a name or a hash (default: the only one)");
  one->add_option("--part", source.part, "of the store's scores")
      ->check(CLI::IsMember({"product", "process"}))
      ->capture_default_str();
  one->add_option("--out", source.out, "F.csv: the table that the store gave");
  one->add_option("--seed", options->seed, "of the samples behind the 95 % intervals")
      ->capture_default_str();
  one->add_flag("--json", options->json, "one JSON object, or array, as the last line");
  one->callback([options, &todo, work, one] {
    options->source.from_store = one->count("--store") > 0;
    todo.work = [options, work] { return work(*options); };
  });
  return *one;
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "study", "reliability, raters, standards and learning curves from tables of marks");
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  CLI::App& of_reliability =
      part(*command, todo, "reliability", "how far a mark would be the same on another day",
           "F.csv: columns learner, mark [, bone, guided], in the order of the sessions", options,
           reliability);
  of_reliability
      .add_option("--marks", options->occasions, "how many of each learner's last marks are used")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  of_reliability.add_flag("--bones", options->bones,
                          "tell the bones apart: that many marks on each of them");
  part(*command, todo, "raters", "how far raters, or a rater and the machine, agree",
       "F.csv: columns product, rater, item, met (1 or 0); the rater \"machine\" is burr", options,
       raters);
  CLI::App& of_standard = part(
      *command, todo, "standard", "where a centre may set its standard",
      "F.csv: group (low, high), mark; for angoff judge, item, probability; for hofstee cut_low, "
      "cut_high, fail_low, fail_high",
      options, standard);
  of_standard.add_option("--method", options->method, "contrasting, angoff or hofstee")
      ->check(CLI::IsMember({"contrasting", "angoff", "hofstee"}))
      ->capture_default_str();
  of_standard.add_option("--marks", options->marks,
                         "F.csv with a column mark: the marks, for hofstee");
  for (const auto& [name, to, what] :
       {std::tuple{"--low", &options->source.low, "with --store: levels that cannot yet"},
        std::tuple{"--high", &options->source.high, "with --store: levels that can"}})
    of_standard.add_option(name, *to, what)->delimiter(',');
  of_standard.add_option("--set-by", options->set_by,
                         "with --store: your name; the cut becomes a standard of the centre");
  of_standard.add_option("--note", options->note, "with --set-by: a remark, one line");
  CLI::App* list = command->add_subcommand("standards", "the standards that the centre has set");
  add_store(*list, options);
  list->add_flag("--json", options->json, "one JSON array, as the last line");
  list->callback([options, &todo] { todo.work = [options] { return list_standards(*options); }; });
  part(*command, todo, "curve", "each learner's curve over attempts",
       "F.csv: columns learner, mark [, attempt, bone, guided]", options, curve);
}

const Command command{66, add};

}  // namespace
}  // namespace burr::app
