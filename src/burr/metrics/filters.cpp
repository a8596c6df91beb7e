#include "burr/metrics/filters.h"

#include <algorithm>
#include <cstddef>

#include "burr/metrics/same_math.h"

namespace burr::metrics {
namespace {

struct Biquad {
  double b0, b1, b2, a1, a2;
};

// Part `part` of the order / 2 parts of second order that a Butterworth is made of.
Biquad butterworth(double rate, double corner, int order, int part) {
  const double w = kPi * corner / rate, k = sine(w) / cosine(w);
  const double damping = 2 * cosine(kPi * (2 * part + 1) / (2 * order));
  const double norm = 1 / (1 + damping * k + k * k);
  return {k * k * norm, 2 * k * k * norm, k * k * norm, 2 * (k * k - 1) * norm,
          (1 - damping * k + k * k) * norm};
}

// Begins in the state that a constant of the first value would have left.
void run(const Biquad& f, std::span<double> values) {
  if (values.empty()) return;
  double x1 = values[0], x2 = x1, y1 = x1, y2 = x1;
  for (double& value : values) {
    const double x = value;
    value = f.b0 * x + f.b1 * x1 + f.b2 * x2 - f.a1 * y1 - f.a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = value;
  }
}

}  // namespace

void low_pass(std::span<double> values, double rate, double corner, int order) {
  if (values.size() < 3) return;
  const auto count = values.size();
  const std::size_t margin =
      std::min(count - 1, static_cast<std::size_t>((1 + order) * rate / corner));
  std::vector<double> all(count + 2 * margin);
  for (std::size_t n = 0; n < margin; ++n) {
    all[margin - 1 - n] = 2 * values[0] - values[n + 1];
    all[margin + count + n] = 2 * values[count - 1] - values[count - 2 - n];
  }
  std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(margin));
  for (int way = 0; way < 2; ++way) {
    for (int part = 0; 2 * part < order; ++part) run(butterworth(rate, corner, order, part), all);
    std::reverse(all.begin(), all.end());
  }
  std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(margin), count, values.begin());
}

std::vector<double> band(std::span<const double> values, double rate, double low, double high) {
  std::vector<double> upper(values.begin(), values.end()), lower = upper;
  constexpr int kSteep = 8;
  low_pass(upper, rate, high, kSteep);
  low_pass(lower, rate, low, kSteep);
  for (std::size_t n = 0; n < upper.size(); ++n) upper[n] -= lower[n];
  return upper;
}

}  // namespace burr::metrics
