// people/psi.h - chooses the next level so that the answer is expected to tell most about the
// threshold (Kontsevich and Tyler 1999; the slope is estimated too, but no trials are spent on it:
// Prins 2013).
//
// The belief is a table over thresholds and slopes, flat at first. The information of an answer is
// its entropy minus the mean of its entropies for known thresholds. Choosing for the slope as well
// would cost a third of the trials: the threshold of one run of 400 scattered by 5.6 % instead of
// 4.6.
//
// Thread: one. Memory: some tables of numbers, allocated at construction. Cost: 60 us an answer.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace burr::people {

struct PsiSettings {
  double smallest = 0.01, largest = 1;  // levels that can be presented
  int levels = 32, thresholds = 48;     // over that range, evenly spaced in the logarithm
  double guess = 0.5, lapse = 0.02;
};

class Psi {
 public:
  explicit Psi(const PsiSettings& settings);

  [[nodiscard]] double level() const { return levels_[next_]; }
  // The answer to the last level from level().
  void answer(bool right);

 private:
  void choose();

  std::vector<double> levels_, belief_;
  std::vector<double> right_;                             // [level][threshold][slope]
  std::vector<std::pair<std::size_t, double>> believed_;  // thresholds in belief_, their weights
  std::size_t next_ = 0;
};

}  // namespace burr::people
