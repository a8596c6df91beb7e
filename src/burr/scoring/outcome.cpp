#include "burr/scoring/outcome.h"

#include <fmt/core.h>

#include "burr/base/check.h"
#include "burr/base/printable.h"

namespace burr::scoring {
namespace {

std::size_t place_of(const Rubric& rubric, const std::string& id) {
  std::size_t n = 0;
  while (n < rubric.items.size() && rubric.items[n].id != id) ++n;
  BURR_CHECK(n < rubric.items.size());
  return n;
}

// depth: ends a circle, which reading refuses
void require(const Rubric& rubric, std::span<Outcome> outcomes, std::size_t n, std::size_t depth) {
  const std::string& needs = rubric.items[n].needs;
  Outcome& mine = outcomes[n];
  if (needs.empty() || depth == 0) return;
  const std::size_t other = place_of(rubric, needs);
  require(rubric, outcomes, other, depth - 1);
  if (mine.verdict != Verdict::met || outcomes[other].verdict == Verdict::met) return;
  mine.verdict = outcomes[other].verdict;
  mine.borderline = outcomes[other].borderline;
  mine.earned = outcomes[other].earned;
  mine.reason =
      fmt::format("it requires \"{}\", which is {}", base::printable(needs), word_of(mine.verdict));
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
    if (outcomes[n].verdict != Verdict::met) continue;
    ++out.met;
    met += item.weight;
  }
  if (all > 0) out.not_assessable = (all - known) / all;
  // the sums of weights such as 0.1 are not exact
  if (known > 0 && out.not_assessable <= kMostUnknown + 1e-9) out.points = 100 * met / known;
  return out;
}

void apply_requires(const Rubric& rubric, std::span<Outcome> outcomes) {
  BURR_CHECK(outcomes.size() == rubric.items.size());
  for (std::size_t n = 0; n < outcomes.size(); ++n)
    require(rubric, outcomes, n, rubric.items.size());
}

}  // namespace burr::scoring
