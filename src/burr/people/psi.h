// people/psi.h - asks what tells most: after each answer the level whose next answer is expected to
// say most about the threshold (Kontsevich and Tyler 1999; the slope is believed in, but trials are
// not spent on it: Prins 2013).
//
// Belief is a table over thresholds and slopes, flat at first. What an answer will tell is its
// entropy less the mean of its entropies where the threshold is known. Asking for the slope as well
// costs a third of the trials: the threshold of one run of 400 scattered by 5.6 % instead of 4.6.
//
// Thread: one. Memory: some tables of numbers, taken at construction. Cost: 60 us an answer.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace burr::people {

struct PsiSettings {
  double smallest = 0.01, largest = 1;  // levels that can be shown
  int levels = 32, thresholds = 48;     // over that range, evenly in the logarithm
  double guess = 0.5, lapse = 0.02;
};

class Psi {
 public:
  explicit Psi(const PsiSettings& settings);

  [[nodiscard]] double level() const { return levels_[next_]; }
  // To the level that was asked for last.
  void answer(bool right);

 private:
  void choose();

  std::vector<double> levels_, belief_;
  std::vector<double> right_;                             // [level][threshold][slope]
  std::vector<std::pair<std::size_t, double>> believed_;  // thresholds in belief_, their weights
  std::size_t next_ = 0;
};

}  // namespace burr::people
