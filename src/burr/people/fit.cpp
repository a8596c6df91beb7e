#include "burr/people/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace burr::people {
namespace {

constexpr int kThresholds = 101, kSlopes = 41;
constexpr double kSlopeLow = 0.6, kSlopeHigh = 10;
constexpr double kBeyond = 3;        // thresholds are searched up to this factor beyond the levels
constexpr double kNothing = 9;       // a log likelihood this far below the best is ignored
constexpr double kSure = 10.83 / 2;  // 99.9 % of chi^2 with one degree of freedom, against guessing

// Logarithms of P and 1 - P depend on slope ln(level / threshold) alone: a table of them, with
// linear interpolation.
class Logs {
 public:
  Logs(double guess, double lapse) {
    for (int n = 0; n < kRows; ++n) {
      const Psychometric one{1, 1, guess, lapse};
      const double p = std::clamp(one.right(std::exp(kFirst + kStep * n)), 1e-12, 1 - 1e-12);
      right_.push_back(std::log(p));
      wrong_.push_back(std::log1p(-p));
    }
  }
  [[nodiscard]] double of(const Tally& tally, double z) const {
    const double at = std::clamp((z - kFirst) / kStep, 0.0, kRows - 1.001);
    const auto row = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(row);
    return tally.right * (right_[row] + part * (right_[row + 1] - right_[row])) +
           (tally.trials - tally.right) * (wrong_[row] + part * (wrong_[row + 1] - wrong_[row]));
  }

 private:
  static constexpr int kRows = 3501;
  static constexpr double kFirst = -30, kStep = 0.01;  // to z = 5, where P no longer changes
  std::vector<double> right_, wrong_;
};

// A threshold, given as its logarithm, and its likelihood.
struct Row {
  double place = 0;
  double weight = 0;  // logarithm of the likelihood, summed over slopes
  double best = 0;    // logarithm of the largest of them
  double slope = 0;   // mean logarithm of the slope
};

struct Likelihood {
  std::span<const Tally> tallies;
  std::vector<double> places;  // ln(level)
  Logs logs;

  [[nodiscard]] Row row(double place) const {
    std::array<double, kSlopes> all = {};
    Row out{place, 0, -std::numeric_limits<double>::infinity(), 0};
    const auto slope = [](std::size_t s) {
      return std::log(kSlopeLow) +
             std::log(kSlopeHigh / kSlopeLow) * static_cast<double>(s) / (kSlopes - 1);
    };
    for (std::size_t s = 0; s < kSlopes; ++s) {
      const double steep = std::exp(slope(s));
      for (std::size_t n = 0; n < tallies.size(); ++n)
        all[s] += logs.of(tallies[n], steep * (places[n] - place));
      out.best = std::max(out.best, all[s]);
    }
    double sum = 0;
    for (std::size_t s = 0; s < kSlopes; ++s) {
      const double weight = std::exp(all[s] - out.best);
      sum += weight;
      out.slope += weight * slope(s);
    }
    out.slope /= sum;
    out.weight = out.best + std::log(sum);
    return out;
  }
  [[nodiscard]] std::vector<Row> along(double low, double high) const {
    std::vector<Row> rows;
    for (int t = 0; t < kThresholds; ++t)
      rows.push_back(row(low + (high - low) * t / (kThresholds - 1)));
    return rows;
  }
};

double most(const std::vector<Row>& rows) {
  return std::max_element(rows.begin(), rows.end(),
                          [](const Row& a, const Row& b) { return a.weight < b.weight; })
      ->weight;
}

// The same search between the rows that still count, and one row beyond on either side.
std::vector<Row> closer(const Likelihood& likelihood, const std::vector<Row>& rows) {
  const double least = most(rows) - kNothing;
  std::size_t first = 0, last = rows.size() - 1;
  while (first + 2 < last && rows[first + 1].weight < least) ++first;
  while (last > first + 2 && rows[last - 1].weight < least) --last;
  return likelihood.along(rows[first].place, rows[last].place);
}

// The logarithm of the threshold below which this share of the posterior lies.
double quantile(const std::vector<Row>& rows, double share) {
  const double top = most(rows);
  std::vector<double> below = {0};  // by the trapezoidal rule
  for (std::size_t n = 1; n < rows.size(); ++n)
    below.push_back(below.back() +
                    0.5 * (std::exp(rows[n - 1].weight - top) + std::exp(rows[n].weight - top)));
  const double wanted = share * below.back();
  std::size_t n = 1;
  while (n + 1 < rows.size() && below[n] < wanted) ++n;
  const double part = (wanted - below[n - 1]) / (below[n] - below[n - 1]);
  return rows[n - 1].place + part * (rows[n].place - rows[n - 1].place);
}

}  // namespace

Fit fit(std::span<const Tally> tallies, const FitSettings& settings) {
  Fit out;
  out.best.guess = settings.guess;
  out.best.lapse = settings.lapse;
  Likelihood likelihood{tallies, {}, Logs(settings.guess, settings.lapse)};
  for (const Tally& one : tallies) likelihood.places.push_back(std::log(one.level));

  // once over the whole range, once more near the maximum
  const std::vector<Row> rows =
      closer(likelihood, likelihood.along(std::log(settings.smallest / kBeyond),
                                          std::log(settings.largest * kBeyond)));
  const double middle = quantile(rows, 0.5);
  out.best.threshold = std::exp(middle);
  out.best.slope = std::exp(likelihood.row(middle).slope);
  out.low = std::exp(quantile(rows, 0.025));
  out.high = std::exp(quantile(rows, 0.975));

  double best = -std::numeric_limits<double>::infinity(), guessed = 0;
  for (const Row& row : rows) best = std::max(best, row.best);
  int trials = 0;
  for (const Tally& one : tallies) {
    trials += one.trials;
    guessed += one.right * std::log(settings.guess) +
               (one.trials - one.right) * std::log1p(-settings.guess);
  }
  if (trials == 0)
    out.why = "no threshold found: there are no answers";
  else if (best - guessed < kSure)
    out.why = "no threshold found: the answers do not differ clearly from guessing";
  else if (!(out.high <= settings.largest))
    out.why =
        "no threshold found: it may be above the largest difference presented; raise `largest` or "
        "run more trials";
  else if (!(out.low >= settings.smallest))
    out.why =
        "no threshold found: it may be below the smallest difference presented; lower `smallest` "
        "or run more trials";
  else
    out.found = true;
  return out;
}

}  // namespace burr::people
