#include "burr/scoring/outcome.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "burr/base/check.h"
#include "burr/base/printable.h"

namespace burr::scoring {
namespace {

void require(const Rubric& rubric, Outcome& mine, const Outcome& other, std::size_t n) {
  if (mine.verdict != Verdict::met || other.verdict == Verdict::met) return;
  mine.verdict = other.verdict;
  mine.borderline = other.borderline;
  mine.earned = other.earned;
  mine.reason = fmt::format("it requires \"{}\", which is {}",
                            base::printable(rubric.items[n].needs), word_of(standing_of(mine)));
}

}  // namespace

const char* word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::met:
      return "met";
    case Verdict::unmet:
      return "unmet";
    case Verdict::not_assessable:
      return "not assessable";
  }
  return "";
}

Standing standing_of(const Outcome& outcome) {
  if (outcome.verdict == Verdict::met) return Standing::met;
  if (outcome.verdict == Verdict::not_assessable) return Standing::not_assessable;
  return outcome.earned ? Standing::not_met : Standing::too_early;
}

const char* word_of(Standing standing) {
  switch (standing) {
    case Standing::met:
      return "met";
    case Standing::not_met:
      return "not met";
    case Standing::too_early:
      return "too early to say";
    case Standing::not_assessable:
      return "not assessable";
  }
  return "";
}

bool did_harm(const Item& item, const Outcome& outcome) {
  return standing_of(outcome) == Standing::not_met &&
         (item.gate || (item.how != nullptr && item.how->guards));
}

double credit_of(const Item& item, const Outcome& outcome) {
  const bool whole = outcome.verdict == Verdict::met;
  if (!item.grade || !outcome.value || !outcome.earned || !outcome.reason.empty())
    return whole ? 1 : 0;
  const auto [none, full] = *item.grade;
  return std::clamp((*outcome.value - none) / (full - none), 0.0, 1.0);
}

Total total_of(const Rubric& rubric, std::span<const Outcome> outcomes, Part part) {
  BURR_CHECK(outcomes.size() == rubric.items.size());
  Total out;
  double met = 0, known = 0, all = 0;  // weights
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    const Item& item = rubric.items[n];
    if (item.part != part) continue;
    ++out.items;
    all += item.weight;
    if (outcomes[n].verdict == Verdict::not_assessable) continue;
    ++out.assessable;
    known += item.weight;
    out.met += outcomes[n].verdict == Verdict::met ? 1 : 0;
    out.too_early += standing_of(outcomes[n]) == Standing::too_early ? 1 : 0;
    met += item.weight * credit_of(item, outcomes[n]);
  }
  if (all > 0) out.not_assessable = (all - known) / all;
  // the sums of weights such as 0.1 are not exact
  if (known > 0 && out.not_assessable <= kMostUnknown + 1e-9) out.points = 100 * met / known;
  return out;
}

std::vector<std::size_t> in_order(const Rubric& rubric, std::span<const Outcome> outcomes,
                                  Part part) {
  BURR_CHECK(outcomes.size() == rubric.items.size());
  std::vector<std::size_t> numbers;
  for (const bool harm : {true, false})
    for (std::size_t n = 0; n < outcomes.size(); ++n)
      if (rubric.items[n].part == part && did_harm(rubric.items[n], outcomes[n]) == harm)
        numbers.push_back(n);
  return numbers;
}

void apply_requires(const Rubric& rubric, std::span<Outcome> outcomes) {
  BURR_CHECK(outcomes.size() == rubric.items.size());
  std::map<std::string_view, std::size_t> places;
  for (std::size_t n = 0; n < outcomes.size(); ++n) places.emplace(rubric.items[n].id, n);
  std::vector<bool> done(outcomes.size());
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    std::vector<std::size_t> way;  // to an item that requires nothing, or that is done
    for (std::size_t at = n; !done[at];) {
      done[at] = true;  // ends a circle, which reading refuses
      way.push_back(at);
      if (rubric.items[at].needs.empty()) break;
      at = places.at(rubric.items[at].needs);
    }
    for (; !way.empty(); way.pop_back())
      if (const std::string& needs = rubric.items[way.back()].needs; !needs.empty())
        require(rubric, outcomes[way.back()], outcomes[places.at(needs)], way.back());
  }
}

}  // namespace burr::scoring
