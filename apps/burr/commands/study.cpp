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
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "burr/school/study/curve.h"
#include "burr/school/study/raters.h"
#include "burr/school/study/reliability.h"
#include "burr/school/study/table.h"
#include "commands/study_standards.h"
#include "school/agreement.h"
#include "school/store_command.h"
#include "school/study_source.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

namespace study = school::study;
using Json = nlohmann::ordered_json;
using Options = StudyOptions;

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
      options, propose_standard);
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
