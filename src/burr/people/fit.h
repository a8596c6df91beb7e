// people/fit.h - the psychometric function that answers speak for, and how far off its threshold
// may be.
//
// The likelihood of the answers over threshold and slope, guess and lapse given, before it all
// thresholds and all slopes (0.6 to 10) being equally believed in, in their logarithms. The
// threshold is the median of what is believed after it, whatever the slope; the interval holds 95 %
// of it. How levels were chosen does not matter to it. A profile likelihood instead of the sum over
// slopes is too sure of itself: levels chosen near the threshold make the most likely slope too
// steep (Kaernbach 2001), and its intervals held the truth 18 times of 20 instead of 19.
//
// No threshold is found where the answers could as well be guessed, or where the interval leaves
// the levels that could be shown: then a number would only be the border. Thread: any.
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
  double smallest = 0.01, largest = 1;  // levels that could be shown
  double guess = 0.5, lapse = 0.02;
};

struct Fit {
  bool found = false;
  std::string why;           // not found: a sentence
  Psychometric best;         // found or not
  double low = 0, high = 0;  // 95 % interval of the threshold
};

[[nodiscard]] Fit fit(std::span<const Tally> tallies, const FitSettings& settings);

}  // namespace burr::people
