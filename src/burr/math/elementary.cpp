#include "burr/math/elementary.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace burr::math {
namespace {

// A number as the sum of two doubles; `low` is at most half a unit in the last place of `high`.
struct Two {
  double high = 0, low = 0;
};

// a + b without loss (Knuth)
constexpr Two sum(double a, double b) noexcept {
  const double high = a + b, part = high - a;
  return {high, (a - (high - part)) + (b - part)};
}

// a * b without loss (Dekker, Veltkamp): halves of 26 bits
constexpr Two product(double a, double b) noexcept {
  constexpr double kSplit = 134217729;  // 2^27 + 1
  const double as = kSplit * a, a1 = as - (as - a), a2 = a - a1;
  const double bs = kSplit * b, b1 = bs - (bs - b), b2 = b - b1;
  const double high = a * b;
  return {high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

constexpr Two plus(Two a, Two b) noexcept {
  const Two high = sum(a.high, b.high);
  return sum(high.high, high.low + (a.low + b.low));
}

constexpr Two times(Two a, Two b) noexcept {
  const Two high = product(a.high, b.high);
  return sum(high.high, high.low + (a.high * b.low + a.low * b.high));
}

constexpr Two over(Two a, double whole) noexcept {
  const double first = a.high / whole;
  const Two back = product(first, whole);
  return sum(first, ((a.high - back.high) - back.low + a.low) / whole);
}

constexpr Two over(Two a, Two b) noexcept {
  const double first = a.high / b.high;
  const Two rest = plus(a, times(b, {-first, 0}));
  return sum(first, rest.high / b.high);
}

constexpr Two minus(Two a) noexcept { return {-a.high, -a.low}; }

constexpr Two kLn2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr Two kPi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

// x rounded to its first 32 bits, so that the product with a whole number below 2^20 is exact
constexpr double first_bits(double x) noexcept {
  constexpr double kSplit = 2097153;  // 2^21 + 1
  const double far = kSplit * x;
  return far - (far - x);
}

constexpr std::int64_t nearest(double x) noexcept {
  return static_cast<std::int64_t>(x < 0 ? x - 0.5 : x + 0.5);
}

// ---- tables, made by the compiler

constexpr int kSteps = 128;

// 2^(n / 128)
constexpr std::array<Two, kSteps> powers() noexcept {
  std::array<Two, kSteps> out;
  for (int n = 0; n < kSteps; ++n) {
    const Two x = over(times(kLn2, {static_cast<double>(n), 0}), kSteps);
    Two term = {1, 0}, all = {1, 0};
    for (int k = 1; k <= 30; ++k) {
      term = over(times(term, x), k);
      all = plus(all, term);
    }
    out[static_cast<std::size_t>(n)] = all;
  }
  return out;
}

struct Turn {
  Two sine, cosine;
};

// The sine and cosine of n / 128 of a whole turn: an eighth of the turn by series, the rest by symmetry, so that the
// zeros are zeros.
constexpr std::array<Turn, kSteps> turns() noexcept {
  std::array<Turn, kSteps> out;
  constexpr int kQuarter = kSteps / 4;
  for (int n = 0; n <= kQuarter / 2; ++n) {
    const Two x = over(times(kPi, {2.0 * n, 0}), kSteps), square = times(x, x);
    Two s = x, c = {1, 0}, s_term = x, c_term = {1, 0};
    for (int k = 1; k <= 15; ++k) {
      c_term = minus(over(times(c_term, square), (2.0 * k - 1) * (2.0 * k)));
      s_term = minus(over(times(s_term, square), (2.0 * k) * (2.0 * k + 1)));
      c = plus(c, c_term);
      s = plus(s, s_term);
    }
    out[static_cast<std::size_t>(n)] = {s, c};
    out[static_cast<std::size_t>(kQuarter - n)] = {c, s};
  }
  for (int n = kQuarter; n < kSteps; ++n) {
    const Turn before = out[static_cast<std::size_t>(n - kQuarter)];
    out[static_cast<std::size_t>(n)] = {before.cosine, minus(before.sine)};
  }
  return out;
}

constexpr int kSlopes = 64;

// The arctangent of n / 64, by Euler's series: atan x = sum of 2^2k (k!)^2 / (2k + 1)! x^(2k+1) / (1 + x^2)^(k+1)
constexpr std::array<Two, kSlopes + 1> arctangents() noexcept {
  std::array<Two, kSlopes + 1> out;
  for (int n = 1; n <= kSlopes; ++n) {
    const double x = static_cast<double>(n) / kSlopes;  // exact, as is its square
    const Two ratio = over(Two{x * x, 0}, 1 + x * x);
    Two term = over(Two{x, 0}, 1 + x * x), all = term;
    for (int k = 1; k <= 120; ++k) {
      term = over(times(times(term, ratio), {2.0 * k, 0}), 2.0 * k + 1);
      all = plus(all, term);
    }
    out[static_cast<std::size_t>(n)] = all;
  }
  return out;
}

constexpr std::array<Two, kSteps> kPowers = powers();
constexpr std::array<Turn, kSteps> kTurns = turns();
constexpr std::array<Two, kSlopes + 1> kArctangents = arctangents();

// ---- exp

// e^x = 2^exponent * power * (1 + more), |more| < 0.0028
struct Exponential {
  Two power;
  double more;
  int exponent;
};

Exponential split_exponential(double x) noexcept {
  constexpr double kFirst = first_bits(kLn2.high / kSteps);
  constexpr double kRest = (kLn2.high / kSteps - kFirst) + kLn2.low / kSteps;
  const std::int64_t k = nearest(x * (kSteps / kLn2.high));
  const auto steps = static_cast<double>(k);
  const double r = (x - steps * kFirst) - steps * kRest;
  const double more = r + r * r * (1.0 / 2 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120))));
  const std::int64_t n = ((k % kSteps) + kSteps) % kSteps;
  return {kPowers[static_cast<std::size_t>(n)], more, static_cast<int>((k - n) / kSteps)};
}

}  // namespace

double exponential(double x) noexcept {
  if (!(x > -746)) return x <= -746 ? 0 : x;  // a NaN stays one
  if (x > 710) return std::numeric_limits<double>::infinity();
  const Exponential e = split_exponential(x);
  return std::ldexp(e.power.high + (e.power.low + e.power.high * e.more), e.exponent);
}

double exponential_minus_one(double x) noexcept {
  if (!(x > -40)) return x <= -40 ? -1 : x;
  if (x > 710) return std::numeric_limits<double>::infinity();
  if (std::fabs(x) < 1.0 / 16) {  // its own series: the 1 would take digits away
    double series = 1.0 / 39916800;
    for (const double part : {3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0})
      series = 1 / part + x * series;
    return x + x * x * series;
  }
  const Exponential e = split_exponential(x);
  const double high = std::ldexp(e.power.high, e.exponent);
  const Two less = sum(high, -1);
  return less.high + (less.low + (std::ldexp(e.power.low, e.exponent) + high * e.more));
}

// ---- sin and cos

namespace {

// The sine (quarter 0) or cosine (quarter 1) of x: as the sine of x and a quarter turn more.
double sine_from(double x, int quarter) noexcept {
  constexpr double kStep = kPi.high * 2 / kSteps;
  constexpr double kFirst = first_bits(kStep);
  constexpr double kSecond = kStep - kFirst;
  constexpr double kThird = kPi.low * 2 / kSteps;
  static_assert(kFirst + kSecond == kStep);
  if (std::fabs(x) > 50000) x = std::remainder(x, 2 * kPi.high);
  const std::int64_t k = nearest(x / kStep);
  const auto steps = static_cast<double>(k);
  const Two near = sum(x - steps * kFirst, -(steps * kSecond));
  const Two r = sum(near.high, near.low - steps * kThird);
  const double rr = r.high * r.high;
  const double s_more =  // sin r - r.high
      r.low + r.high * rr * (-1.0 / 6 + rr * (1.0 / 120 + rr * (-1.0 / 5040)));
  const double c_more =  // cos r - 1
      rr * (-1.0 / 2 + rr * (1.0 / 24 + rr * (-1.0 / 720 + rr * (1.0 / 40320)))) - r.high * r.low;
  const auto at =
      static_cast<std::size_t>((((k + quarter * (kSteps / 4)) % kSteps) + kSteps) % kSteps);
  const Two s = kTurns[at].sine, c = kTurns[at].cosine;
  // sin(a + r) = sin a cos r + cos a sin r
  const Two main = product(c.high, r.high);
  const Two all = sum(s.high, main.high);
  return all.high +
         (all.low + (main.low + (s.low + (s.high * c_more + (c.high * s_more + c.low * r.high)))));
}

}  // namespace

double sine(double x) noexcept { return std::isfinite(x) ? sine_from(x, 0) : x - x; }
double cosine(double x) noexcept { return std::isfinite(x) ? sine_from(x, 1) : x - x; }

// ---- atan2 and hypot

double angle_of(double y, double x) noexcept {
  const double wide = std::fabs(x), high = std::fabs(y);
  if (!(wide < std::numeric_limits<double>::infinity()) ||
      !(high < std::numeric_limits<double>::infinity()))
    return std::numeric_limits<double>::quiet_NaN();
  const bool steep = high > wide;
  const double n = steep ? wide : high, d = steep ? high : wide;
  if (d == 0) return 0;
  const std::int64_t at = nearest(n / d * kSlopes);
  const double c = static_cast<double>(at) / kSlopes;
  // the tangent of what is left: (n - c d) / (d + c n)
  const Two cd = product(c, d), cn = product(c, n);
  const Two left = over(plus({n, 0}, minus(cd)), plus({d, 0}, cn));
  const double t = left.high, tt = t * t;
  const double more =
      left.low + t * tt * (-1.0 / 3 + tt * (1.0 / 5 + tt * (-1.0 / 7 + tt * (1.0 / 9))));
  const Two known = kArctangents[static_cast<std::size_t>(at)];
  Two angle = sum(known.high, t);
  angle.low += known.low + more;
  // in the first octant; now in its own
  constexpr Two kHalf = {kPi.high / 2, kPi.low / 2};
  if (steep)
    angle = plus(kHalf, x < 0 ? angle : minus(angle));
  else if (x < 0)
    angle = plus(kPi, minus(angle));
  const double whole = angle.high + angle.low;
  return y < 0 ? -whole : whole;
}

double hypotenuse(double x, double y) noexcept {
  const Two square = plus(product(x, x), product(y, y));
  if (!(square.high > 0)) return square.high;
  const double root = std::sqrt(square.high);
  const Two back = product(root, root);
  return root + ((square.high - back.high) - back.low + square.low) / (2 * root);
}

}  // namespace burr::math
