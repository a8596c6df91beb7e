#include "burr/people/experiment.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "burr/base/check.h"

namespace burr::people {
namespace {

constexpr int kBlock = 10;      // trials in which both orders come equally often
constexpr int kLookEvery = 10;  // trials between two checks of the interval's width
constexpr int kFewest = 60;     // answers before the first check

template <class T>
void shuffle(std::vector<T>& list, std::size_t from, RandomStream& random) {
  for (std::size_t n = list.size(); n > from + 1; --n) {
    const auto other = from + static_cast<std::size_t>(random.below(static_cast<int>(n - from)));
    const T kept = list[n - 1];
    list[n - 1] = list[other];
    list[other] = kept;
  }
}

// Each level once in every block, in a random order of the block's own.
std::vector<double> constant_levels(const Plan& plan, RandomStream& random) {
  std::vector<double> all;
  while (static_cast<int>(all.size()) < plan.trials) {
    const std::size_t from = all.size();
    for (int n = 0; n < plan.levels; ++n)
      all.push_back(plan.smallest * std::pow(plan.largest / plan.smallest,
                                             static_cast<double>(n) / (plan.levels - 1)));
    shuffle(all, from, random);
  }
  return all;
}

std::variant<Psi, Staircase, std::vector<double>> chooser(const Plan& plan, RandomStream& random) {
  if (plan.method == Method::staircase) {
    StaircaseSettings settings;
    settings.rule = plan.rule;
    settings.smallest = plan.smallest;
    settings.largest = settings.start = plan.largest;
    return Staircase(settings);
  }
  if (plan.method == Method::constant) return constant_levels(plan, random);
  PsiSettings settings;
  settings.smallest = plan.smallest;
  settings.largest = plan.largest;
  settings.guess = plan.guess;
  settings.lapse = plan.lapse;
  return Psi(settings);
}

}  // namespace

Experiment::Experiment(const Plan& plan)
    : plan_(plan), order_(plan.seed, 1), blocks_(plan.seed, 2), chooser_(chooser(plan, blocks_)) {
  BURR_CHECK(plan.smallest > 0 && plan.largest > plan.smallest && plan.levels > 1);
  finished_ = plan.trials <= 0;
  if (!finished_) prepare();
}

double Experiment::level() {
  if (const auto* psi = std::get_if<Psi>(&chooser_)) return psi->level();
  if (const auto* staircase = std::get_if<Staircase>(&chooser_)) return staircase->level();
  return std::get<std::vector<double>>(chooser_)[answered_.size()];
}

void Experiment::prepare() {
  if (orders_.size() == answered_.size()) {
    const std::size_t from = orders_.size();
    std::vector<int> block;
    for (int n = 0; n < kBlock; ++n) block.push_back(n % 2);
    shuffle(block, 0, order_);
    for (const int one : block) orders_.push_back(one == 1);
    BURR_CHECK(orders_.size() == from + kBlock);
  }
  next_.number = static_cast<int>(answered_.size()) + 1;
  next_.level = level();
  next_.standard = plan_.standard;
  next_.comparison = plan_.stimulus == Stimulus::vibration ? plan_.standard + next_.level
                                                           : plan_.standard * (1 + next_.level);
  next_.comparison_first = orders_[answered_.size()];
}

void Experiment::answer(int interval) {
  BURR_CHECK(!finished_ && (interval == 1 || interval == 2));
  answered_.push_back({next_, interval});
  const bool right = answered_.back().right();
  if (auto* psi = std::get_if<Psi>(&chooser_)) psi->answer(right);
  if (auto* staircase = std::get_if<Staircase>(&chooser_)) staircase->answer(right);
  const auto count = static_cast<int>(answered_.size());
  finished_ = count >= plan_.trials;
  if (!finished_ && plan_.until > 0 && count >= kFewest && count % kLookEvery == 0) {
    const Fit now = outcome().fit;
    finished_ = now.found && now.high <= now.best.threshold * (1 + plan_.until) &&
                now.low >= now.best.threshold / (1 + plan_.until);
  }
  if (!finished_) prepare();
}

Outcome Experiment::outcome() const {
  Outcome out;
  std::map<double, Tally> by_level;
  for (const Answered& one : answered_) {
    Tally& tally = by_level[one.trial.level];
    tally.level = one.trial.level;
    ++tally.trials;
    tally.right += one.right() ? 1 : 0;
    out.comparison_first += one.trial.comparison_first ? 1 : 0;
    out.said_first += one.answer == 1 ? 1 : 0;
  }
  for (const auto& [level, tally] : by_level) out.tallies.push_back(tally);
  out.trials = static_cast<int>(answered_.size());
  out.fit = fit(out.tallies, {plan_.smallest, plan_.largest, plan_.guess, plan_.lapse});
  if (const auto* staircase = std::get_if<Staircase>(&chooser_)) out.settled = staircase->found();
  return out;
}

}  // namespace burr::people
