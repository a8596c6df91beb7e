// fit/least_squares.h - a straight law through the origin, y = a x1 + b x2, and how well the rows
// tell its constants: 95 % intervals by Student's t.
//
// The intervals hold where the rows' errors are in y, alike and independent. Thread: any.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace burr::fit {

// Above it the columns rise and fall together so closely that their constants are made of noise.
inline constexpr double kWorstCondition = 100;

struct LineFit {
  enum class State { good, too_few_rows, not_told_apart };
  State state = State::good;
  std::vector<double> value;  // of each column; only if good, as all below
  std::vector<double> half;   // value +- half holds the truth 95 times of 100
  double residual = 0;        // standard deviation of y about the law
  double condition = 1;       // of the columns, each scaled to length 1; also if not told apart
};

// columns: each as long as y. Needs two rows more than columns.
[[nodiscard]] LineFit least_squares(std::span<const std::vector<double>> columns,
                                    std::span<const double> y);

// |T| of Student's distribution stays below it 95 times of 100. freedom: 1, 2 ...
[[nodiscard]] double student_95(std::size_t freedom);

}  // namespace burr::fit
