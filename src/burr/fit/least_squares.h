// fit/least_squares.h - fits a linear law through the origin, y = a x1 + b x2, and says how well
// its constants are known: 95 % intervals by Student's t.
//
// The intervals hold if the errors of the rows are in y, of equal size and independent. Thread:
// any.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace burr::fit {

// Above this condition number the columns are so nearly proportional that their constants are only
// noise.
inline constexpr double kWorstCondition = 100;

struct LineFit {
  enum class State { good, too_few_rows, indistinguishable };
  State state = State::good;
  std::vector<double> value;  // one per column; only if good, as all below
  std::vector<double> half;   // value +- half holds the truth 95 times of 100
  double residual = 0;        // standard deviation of y around the law
  double condition = 1;       // of the columns, each scaled to length 1; also if indistinguishable
};

// columns: each as long as y. Needs at least two rows more than columns.
[[nodiscard]] LineFit least_squares(std::span<const std::vector<double>> columns,
                                    std::span<const double> y);

// Of Student's distribution, |T| stays below this 95 times of 100; freedom: its degrees of freedom,
// 1, 2 ...
[[nodiscard]] double student_95(std::size_t freedom);

}  // namespace burr::fit
