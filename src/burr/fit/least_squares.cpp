#include "burr/fit/least_squares.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

#include "burr/base/check.h"

namespace burr::fit {
namespace {

// Probability that |T| stays below t: the finite series for integer degrees of freedom (Abramowitz
// & Stegun 26.7.3 and 26.7.4).
double share_below(double t, std::size_t freedom) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(freedom)));
  const double sine = std::sin(angle), square = std::cos(angle) * std::cos(angle);
  const bool odd = freedom % 2 == 1;
  double term = odd ? std::cos(angle) : 1, sum = freedom == 1 ? 0 : term;
  for (std::size_t n = odd ? 3 : 2; n + 2 <= freedom; n += 2) {
    term *= square * static_cast<double>(n - 1) / static_cast<double>(n);
    sum += term;
  }
  return odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

}  // namespace

double student_95(std::size_t freedom) {
  BURR_CHECK(freedom > 0);
  if (freedom > 400) {  // expansion in 1 / freedom around the normal distribution (26.7.5)
    const double z = 1.959963984540054, f = static_cast<double>(freedom);
    const double z3 = z * z * z, z5 = z3 * z * z;
    return z + (z3 + z) / (4 * f) + (5 * z5 + 16 * z3 + 3 * z) / (96 * f * f);
  }
  double low = 1, high = 20;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (share_below(middle, freedom) < 0.95 ? low : high) = middle;
  }
  return low;
}

LineFit least_squares(std::span<const std::vector<double>> columns, std::span<const double> y) {
  LineFit fit;
  const auto rows = static_cast<Eigen::Index>(y.size());
  const auto count = static_cast<Eigen::Index>(columns.size());
  BURR_CHECK(count > 0);
  if (rows < count + 2) {
    fit.state = LineFit::State::too_few_rows;
    return fit;
  }
  // scaled to length 1, so that the condition number does not depend on units
  Eigen::MatrixXd x(rows, count);
  Eigen::VectorXd length(count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const std::vector<double>& column = columns[static_cast<std::size_t>(c)];
    BURR_CHECK(column.size() == y.size());
    x.col(c) = Eigen::Map<const Eigen::VectorXd>(column.data(), rows);
    length[c] = x.col(c).norm();
    if (length[c] > 0) x.col(c) /= length[c];
  }
  const Eigen::VectorXd measured = Eigen::Map<const Eigen::VectorXd>(y.data(), rows);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(r).singularValues();
  fit.condition = singular[count - 1] > 0 ? singular[0] / singular[count - 1]
                                          : std::numeric_limits<double>::infinity();
  if (!(fit.condition <= kWorstCondition)) {
    fit.state = LineFit::State::indistinguishable;
    return fit;
  }
  const Eigen::VectorXd scaled = qr.solve(measured);
  const double freedom = static_cast<double>(rows - count);
  fit.residual = (measured - x * scaled).norm() / std::sqrt(freedom);
  const Eigen::MatrixXd inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(count, count));
  const double t = student_95(static_cast<std::size_t>(rows - count));
  for (Eigen::Index c = 0; c < count; ++c) {
    fit.value.push_back(scaled[c] / length[c]);
    fit.half.push_back(t * fit.residual * inverse.row(c).norm() / length[c]);
  }
  return fit;
}

}  // namespace burr::fit
