#include "burr/report/advice.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "burr/metrics/measured.h"
#include "burr/report/report_words.h"
#include "burr/words/words.h"

namespace burr::report {

using words::say;
using words::spoken;
using words::Word;
using words::word;

namespace {

using scoring::Outcome;
using scoring::Verdict;

bool marked_met(const SelfMarks& self, const std::string& id) {
  const auto found = self.find(id);
  return found != self.end() && found->second == SelfMark::met;
}

// How far on the wrong side: 0 at the threshold; a share or a length is compared with its threshold.
double distance_of(const Outcome& outcome) {
  if (!outcome.value || !std::isfinite(*outcome.value)) return 1;
  const double scale = outcome.threshold > 0 ? outcome.threshold : 1;
  return std::min(std::abs(*outcome.value - outcome.threshold) / scale, 1e6);
}

}  // namespace

std::vector<std::size_t> by_importance(const Scored& scored, const SelfMarks& self) {
  const scoring::Rubric& rubric = scored.judged.rubric;
  std::vector<std::pair<std::tuple<int, double>, std::size_t>> ranked;
  for (std::size_t n = 0; n < rubric.items.size(); ++n) {
    const scoring::Item& item = rubric.items[n];
    const Outcome& outcome = scored.score.outcomes[n];
    if (outcome.verdict == Verdict::not_assessable) continue;
    const bool unmet = outcome.verdict == Verdict::unmet;
    const bool follows = unmet && outcome.earned && !outcome.reason.empty();
    if (!outcome.earned || follows || (!unmet && !outcome.borderline)) continue;
    const int rank = !unmet                             ? 4
                     : item.gate                        ? 0
                     : scoring::did_harm(item, outcome) ? 1
                     : marked_met(self, item.id)        ? 2
                                                        : 3;
    ranked.push_back({{rank, -distance_of(outcome)}, n});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::size_t> items;
  for (const auto& one : ranked) items.push_back(one.second);
  return items;
}

std::vector<ReportAdvice> advice(const Scored& scored, const SelfMarks& self) {
  std::vector<ReportAdvice> out;
  bool goes_on = scored.score.worked < metrics::kLeastWork;
  const auto go_on = [&] {
    if (std::exchange(goes_on, false))
      out.push_back({say(Word::report_next_go_on, 100 * scored.score.worked), ""});
  };
  for (const std::size_t n : by_importance(scored, self)) {
    const scoring::Item& item = scored.judged.rubric.items[n];
    const Outcome& outcome = scored.score.outcomes[n];
    if (!scoring::did_harm(item, outcome)) go_on();  // who did harm reads of that first
    if (out.size() >= kMostAdvice) break;
    if (outcome.verdict != Verdict::unmet) continue;
    std::string why = figures_of(outcome) + ".";
    if (marked_met(self, item.id)) why += std::string(" ") + word(Word::report_next_you_met);
    out.push_back({item.say.in(spoken().code), std::move(why)});
  }
  if (out.size() < kMostAdvice) go_on();
  return out;
}

std::string agreement(const Scored& scored, const SelfMarks& self) {
  if (self.empty()) return word(Word::report_self_none);
  std::size_t both = 0, same = 0, generous = 0, strict = 0;
  for (const Outcome& outcome : scored.score.outcomes) {
    const auto mark = self.find(outcome.id);
    if (mark == self.end() || mark->second == SelfMark::unknown ||
        outcome.verdict == Verdict::not_assessable || !outcome.earned)
      continue;
    const bool mine = mark->second == SelfMark::met, its = outcome.verdict == Verdict::met;
    ++both;
    if (mine == its) ++same;
    if (mine && !its) ++generous;
    if (!mine && its) ++strict;
  }
  return say(Word::report_self_agree, same, both, generous, strict);
}

}  // namespace burr::report
