#include "burr/metrics/same_math.h"

#include <cmath>
#include <limits>

namespace burr::metrics {
namespace {

// 0 <= x <= 1: halved three times by atan x = 2 atan(x / (1 + sqrt(1 + x^2))), then a series
double arc_tangent_of(double x) {
  for (int n = 0; n < 3; ++n) x = x / (1 + std::sqrt(1 + x * x));
  const double square = x * x;
  double sum = 0;
  for (int n = 19; n >= 1; n -= 2) sum = 1.0 / n - square * sum;
  return 8 * x * sum;
}

struct Turn {
  double rest = 0;  // -pi/4 .. pi/4
  int quarter = 0;  // 0 .. 3
};

Turn turn_of(double angle) {
  // pi / 2 in two parts, so that the rest keeps its digits
  constexpr double kHigh = 1.5707963267341256, kLow = 6.077100506506192e-11;
  const double quarters = std::floor(angle / (kPi / 2) + 0.5);
  const double in_turn = quarters - 4 * std::floor(quarters / 4);
  return {(angle - quarters * kHigh) - quarters * kLow, static_cast<int>(in_turn)};
}

double sine_series(double x) {
  const double square = x * x;
  double sum = 1;
  for (int n = 18; n >= 2; n -= 2) sum = 1 - square / (n * (n + 1.0)) * sum;
  return x * sum;
}

double cosine_series(double x) {
  const double square = x * x;
  double sum = 1;
  for (int n = 19; n >= 1; n -= 2) sum = 1 - square / (n * (n + 1.0)) * sum;
  return sum;
}

}  // namespace

double arc_tangent(double y, double x) {
  const double u = std::abs(x), v = std::abs(y);
  if (u == 0 && v == 0) return 0;
  double angle = v <= u ? arc_tangent_of(v / u) : kPi / 2 - arc_tangent_of(u / v);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double sine(double angle) {
  const Turn turn = turn_of(angle);
  const double value = turn.quarter % 2 == 0 ? sine_series(turn.rest) : cosine_series(turn.rest);
  return turn.quarter < 2 ? value : -value;
}

double cosine(double angle) {
  const Turn turn = turn_of(angle);
  const double value = turn.quarter % 2 == 0 ? cosine_series(turn.rest) : sine_series(turn.rest);
  return turn.quarter == 0 || turn.quarter == 3 ? value : -value;
}

double logarithm(double x) {
  if (!(x > 0)) return -std::numeric_limits<double>::infinity();
  constexpr double kHalfRoot = 0.7071067811865476, kLog2 = 0.6931471805599453;
  int power = 0;
  double m = std::frexp(x, &power);  // 0.5 .. 1, exact
  if (m < kHalfRoot) {
    m *= 2;
    --power;
  }
  const double t = (m - 1) / (m + 1), square = t * t;  // log m = 2 artanh t, |t| < 0.172
  double sum = 0;
  for (int n = 23; n >= 1; n -= 2) sum = 1.0 / n + square * sum;
  return power * kLog2 + 2 * t * sum;
}

double two_to(double x) {
  const double whole = std::floor(x + 0.5), rest = (x - whole) * 0.6931471805599453;
  double sum = 1;
  for (int n = 16; n >= 1; --n) sum = 1 + rest / n * sum;
  return std::ldexp(sum, static_cast<int>(whole));
}

}  // namespace burr::metrics
