// people/fit.h - estimates the psychometric function from the answers, with an interval for its
// threshold.
//
// Bayesian: the likelihood of the answers over threshold and slope, with guess and lapse given, and
// a prior that is flat in the logarithms of threshold and slope (0.6 to 10). The estimate is the
// median of the posterior of the threshold, summed over slopes; the interval holds 95 % of it. It
// does not matter how the levels were chosen. A profile likelihood instead of the sum over slopes
// is too confident: levels chosen near the threshold make the most likely slope too steep
// (Kaernbach 2001), and its intervals held the truth 18 times of 20 instead of 19.
//
// No threshold is found if the answers could be guesses, or if the interval leaves the levels that
// could be presented: the number would then be only the border. Thread: any.
#pragma once

#include <span>
#include <string>

#include "burr/people/psychometric.h"

namespace burr::people {

struct Tally {
  double level = 0;
  int trials = 0, right = 0;
};

struct FitSettings {
  double smallest = 0.01, largest = 1;  // levels that could be presented
  double guess = 0.5, lapse = 0.02;
};

struct Fit {
  bool found = false;
  std::string why;           // if not found: a sentence
  Psychometric best;         // set in both cases
  double low = 0, high = 0;  // 95 % interval of the threshold
};

[[nodiscard]] Fit fit(std::span<const Tally> tallies, const FitSettings& settings);

}  // namespace burr::people
