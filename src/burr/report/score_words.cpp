#include "burr/report/score_words.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "burr/base/printable.h"

namespace burr::report {
namespace {

constexpr std::size_t kText = 600;  // bytes of a text for people; a name has fewer

using scoring::Item;
using scoring::Outcome;
using scoring::Part;

std::string default_word(const Item& item) { return item.calibrated ? "" : " (default)"; }

std::string figures(const Item& item, const Outcome& outcome) {
  if (!outcome.value) return {};
  return fmt::format("{} {}, required at {} {}{}", outcome.what,
                     scoring::text_of(outcome.quantity, *outcome.value),
                     outcome.at_least ? "least" : "most",
                     scoring::text_of(outcome.quantity, outcome.threshold), default_word(item));
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + "; " + b;
}

nlohmann::ordered_json json_of(const Item& item, const Outcome& outcome) {
  nlohmann::ordered_json row;
  row["id"] = item.id;
  row["part"] = scoring::word_of(item.part);
  row["weight"] = item.weight;
  row["gate"] = item.gate;
  row["verdict"] = scoring::word_of(outcome.verdict);
  row["outcome"] = scoring::word_of(scoring::standing_of(outcome));
  row["harm"] = scoring::did_harm(item, outcome);
  if (outcome.verdict != scoring::Verdict::not_assessable)
    row["credit"] = scoring::credit_of(item, outcome);
  row["borderline"] = outcome.borderline;
  row["earned"] = outcome.earned;
  if (!outcome.reason.empty()) row["reason"] = outcome.reason;
  row["measure"] = item.how->name;
  row["calibrated"] = item.calibrated;
  if (outcome.value) {
    row["what"] = outcome.what;
    row["value"] = *outcome.value;
    row["threshold"] = outcome.threshold;
    row["error"] = outcome.error;
    row["at_least"] = outcome.at_least;
  }
  if (outcome.place) row["place_m"] = {outcome.place->x(), outcome.place->y(), outcome.place->z()};
  if (outcome.tick) row["tick"] = *outcome.tick;
  return row;
}

nlohmann::ordered_json json_of(const scoring::Total& total) {
  nlohmann::ordered_json row;
  row["points"] = total.points ? nlohmann::ordered_json(*total.points) : nullptr;
  row["met"] = total.met;
  row["too_early"] = total.too_early;
  row["assessable"] = total.assessable;
  row["items"] = total.items;
  row["not_assessable_weight_share"] = total.not_assessable;
  return row;
}

}  // namespace

std::string item_line(const Item& item, const Outcome& outcome) {
  std::string text = joined(figures(item, outcome), outcome.reason);
  if (outcome.borderline) text = joined(text, "borderline, a person should look");
  return fmt::format("  {:<16}  {:<26}  {}", scoring::word_of(scoring::standing_of(outcome)),
                     base::printable(item.id), text);
}

std::string total_line(const scoring::Rubric& rubric, Part part, const scoring::Total& total) {
  const std::string items =
      fmt::format("{}: {} of {} items met", scoring::word_of(part), total.met, total.assessable);
  std::string open =
      total.too_early > 0 ? fmt::format(", {} too early to say", total.too_early) : "";
  if (total.items > total.assessable)
    open += fmt::format(", {} not assessable", total.items - total.assessable);
  if (total.items == 0) return {};
  const bool calibrated =
      std::all_of(rubric.items.begin(), rubric.items.end(),
                  [&](const Item& item) { return item.part != part || item.calibrated; });
  // points look like a grade, and thresholds that nobody compared with people are none
  if (!calibrated) return items + open;
  if (total.points) return fmt::format("{}{}; {:.0f} of 100 points", items, open, *total.points);
  return fmt::format(
      "{}{}; no total, because {:.0f} % of the weight is not assessable (most: {:.0f} "
      "%)",
      items, open, 100 * total.not_assessable, 100 * scoring::kMostUnknown);
}

std::string no_mark_line(const scoring::Score& score) {
  const std::string why = scoring::text_of(score.no_mark);
  return why.empty() ? "" : fmt::format("no mark: {}", why);
}

std::string safety_line(const scoring::Rubric& rubric, const scoring::Score& score) {
  using scoring::Standing;
  std::size_t all = 0, met = 0;
  std::map<Standing, std::string> lists;
  for (std::size_t n = 0; n < rubric.items.size(); ++n) {
    const Item& item = rubric.items[n];
    if (!item.gate) continue;
    ++all;
    const Standing standing = scoring::standing_of(score.outcomes[n]);
    if (standing == Standing::met) {
      ++met;
      continue;
    }
    std::string& list = lists[standing];
    list += (list.empty() ? "" : ", ") + base::printable(item.id);
  }
  if (all == 0) return {};
  std::string text = fmt::format("safety: {} of {} items met", met, all);
  for (const auto& [standing, list] : lists)
    text += fmt::format("; {}: {}", scoring::word_of(standing), list);
  return text;
}

std::string explanation(const Item& item, const Outcome& outcome, double rate_hz) {
  std::string text = fmt::format("{}\n  {}\n  {}", base::printable(item.id),
                                 base::printable(item.say.in("en"), kText),
                                 scoring::word_of(scoring::standing_of(outcome)));
  if (item.gate) text += ", an item of safety";
  if (outcome.borderline) text += ", borderline: a person should look";
  if (!outcome.reason.empty()) text += "\n  why: " + base::printable(outcome.reason, kText);
  text += fmt::format("\n  measure: {} ({}; docs/teach/metrics.md)", item.how->name,
                      scoring::word_of(item.part));
  if (!item.structure.empty()) text += "\n  structure: " + base::printable(item.structure);
  if (!item.region.empty()) text += "\n  region: " + base::printable(item.region);
  if (!item.along.empty()) text += "\n  along: " + base::printable(item.along);
  for (const scoring::Limit& limit : item.how->limits)
    text += fmt::format("\n  {} = {:g}{}", limit.field, item.limit(limit.field) / limit.unit,
                        default_word(item));
  if (item.grade)
    text += fmt::format("\n  graded: {} earns nothing, {} everything, linear between",
                        scoring::text_of(item.how->quantity, item.grade->first),
                        scoring::text_of(item.how->quantity, item.grade->second));
  if (outcome.value) {
    text += fmt::format("\n  {}", figures(item, outcome));
    text += fmt::format("\n  error of that value: {}",
                        scoring::text_of(outcome.quantity, outcome.error));
  }
  if (outcome.place)
    text += fmt::format("\n  look at: {:.1f}, {:.1f}, {:.1f} mm (LPS)", 1e3 * outcome.place->x(),
                        1e3 * outcome.place->y(), 1e3 * outcome.place->z());
  if (outcome.tick && rate_hz > 0)
    text += fmt::format("\n  at: {:.2f} s, tick {}", static_cast<double>(*outcome.tick) / rate_hz,
                        *outcome.tick);
  if (!item.needs.empty()) text += "\n  requires: " + base::printable(item.needs);
  text += fmt::format("\n  weight: {:g}", item.weight);
  if (!item.source.empty()) text += "\n  source: " + base::printable(item.source, kText);
  return text;
}

std::string score_json(const scoring::Rubric& rubric, const scoring::Score& score) {
  nlohmann::ordered_json row;
  row["rubric"] = rubric.name;
  row["version"] = rubric.version;
  row["case"] = rubric.case_name;
  row["unfinished"] = score.unfinished;
  row["ending"] = score.ending;
  row["removed_share_of_target"] = score.worked;
  row["no_mark"] = scoring::text_of(score.no_mark);
  row["product"] = json_of(score.product);
  row["process"] = json_of(score.process);
  row["items"] = nlohmann::ordered_json::array();
  for (std::size_t n = 0; n < rubric.items.size(); ++n)
    row["items"].push_back(json_of(rubric.items[n], score.outcomes[n]));
  return row.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace burr::report
