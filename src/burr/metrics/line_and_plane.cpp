#include "burr/metrics/line_and_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/base/check.h"
#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using Square = std::array<std::array<double, 3>, 3>;

// Turns the symmetric matrix by Jacobi's rotations until it is diagonal; the columns of `axes` are
// its eigenvectors.
void diagonalise(Square& m, Square& axes) {
  axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 30; ++sweep)
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t =
            (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double a = m[k][p], b = m[k][q];
          m[k][p] = c * a - s * b;
          m[k][q] = s * a + c * b;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double a = m[p][k], b = m[q][k];
          m[p][k] = c * a - s * b;
          m[q][k] = s * a + c * b;
          const double u = axes[k][p], v = axes[k][q];
          axes[k][p] = c * u - s * v;
          axes[k][q] = s * u + c * v;
        }
      }
}

struct Fit {
  double at_zero = 0, slope = 0;
};

Fit straight(std::span<const double> t, std::span<const double> y, std::span<const double> w) {
  double sum = 0, mean_t = 0, mean_y = 0, tt = 0, ty = 0;
  for (std::size_t n = 0; n < t.size(); ++n) {
    sum += w[n];
    mean_t += w[n] * t[n];
    mean_y += w[n] * y[n];
  }
  mean_t /= sum;
  mean_y /= sum;
  for (std::size_t n = 0; n < t.size(); ++n) {
    tt += w[n] * (t[n] - mean_t) * (t[n] - mean_t);
    ty += w[n] * (t[n] - mean_t) * (y[n] - mean_y);
  }
  const double slope = tt > 0 ? ty / tt : 0;
  return {mean_y - slope * mean_t, slope};
}

}  // namespace

PlaneThrough plane_through(std::span<const WeightedPoint> points) {
  BURR_CHECK(points.size() >= 3);
  double all = 0;
  PlaneThrough plane;
  for (const WeightedPoint& one : points) {
    all += one.weight;
    plane.centre += one.weight * one.place;
  }
  plane.centre /= all;
  Square spread = {};
  for (const WeightedPoint& one : points) {
    const Vec3 d = one.place - plane.centre;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        spread[r][c] += one.weight * d[static_cast<int>(r)] * d[static_cast<int>(c)];
  }
  Square axes;
  diagonalise(spread, axes);
  std::size_t least = 0;
  for (std::size_t n = 1; n < 3; ++n)
    if (spread[n][n] < spread[least][least]) least = n;
  plane.normal = math::normalized(Vec3(axes[0][least], axes[1][least], axes[2][least]));
  plane.rms = std::sqrt(std::max(0.0, spread[least][least] / all));
  return plane;
}

LineThrough robust_line(std::span<const WeightedPoint> points, const Vec3& origin,
                        const Vec3& along) {
  BURR_CHECK(points.size() >= 2);
  const std::size_t count = points.size();
  std::vector<double> t(count), w(count), far(count);
  std::array<std::vector<double>, 3> y;
  for (std::vector<double>& one : y) one.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    t[n] = math::dot(points[n].place - origin, along);
    w[n] = points[n].weight;
    for (std::size_t a = 0; a < 3; ++a) y[a][n] = points[n].place[static_cast<int>(a)];
  }
  LineThrough line;
  for (int round = 0; round < 20; ++round) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Fit fit = straight(t, y[a], w);
      line.at_zero[static_cast<int>(a)] = fit.at_zero;
      line.slope[static_cast<int>(a)] = fit.slope;
    }
    for (std::size_t n = 0; n < count; ++n)
      far[n] = math::norm(points[n].place - (line.at_zero + t[n] * line.slope));
    std::vector<double> sorted = far;
    std::sort(sorted.begin(), sorted.end());
    const double limit = 1.5 * 1.4826 * sorted[count / 2];
    for (std::size_t n = 0; n < count; ++n)
      w[n] = points[n].weight * (far[n] > limit && far[n] > 0 ? limit / far[n] : 1);
    if (!(limit > 0)) break;
  }
  return line;
}

double weighted_quantile(std::vector<std::pair<double, double>> value_and_weight, double share) {
  BURR_CHECK(!value_and_weight.empty());
  std::sort(value_and_weight.begin(), value_and_weight.end());
  double all = 0, sum = 0;
  for (const auto& [value, weight] : value_and_weight) all += weight;
  for (const auto& [value, weight] : value_and_weight) {
    sum += weight;
    if (sum >= share * all) return value;
  }
  return value_and_weight.back().first;
}

}  // namespace burr::metrics
