// people/psychometric.h - the share of right answers as a function of the size of the difference.
//
//     P(x) = guess + (1 - guess - lapse) (1 - 2^-(x / threshold)^slope)
//
// A Weibull function, written so that `threshold` is the level half way between guessing and the
// best possible rate (1 - lapse): 74 % right with two intervals and a lapse rate of 2 %. An
// infinite threshold describes an observer who guesses. Thread: any. Memory: none.
#pragma once

#include <cmath>

namespace burr::people {

struct Psychometric {
  double threshold = 0.1;  // in units of the level
  double slope = 3.5;      // at the threshold P grows by 0.35 (1 - guess - lapse) slope per ln(x)
  double guess = 0.5;      // share right by chance: one of two intervals
  double lapse = 0.02;     // wrong however large the difference

  [[nodiscard]] double right(double level) const {
    const double doubt = std::exp2(-std::pow(level / threshold, slope));
    return guess + (1 - guess - lapse) * (1 - doubt);
  }
  // The level at which this share of answers is right; guess < share < 1 - lapse.
  [[nodiscard]] double level_for(double share) const {
    const double doubt = 1 - (share - guess) / (1 - guess - lapse);
    return threshold * std::pow(-std::log2(doubt), 1 / slope);
  }
};

}  // namespace burr::people
