#include "jpeg_2000_wavelet.h"

#include <algorithm>
#include <cmath>

namespace burr::web {
namespace {

constexpr std::ptrdiff_t kMargin = 4;

// A line with a margin that mirrors it; the first value has the parity `odd`.
void mirror(std::vector<float>& line, std::ptrdiff_t count) {
  const std::ptrdiff_t period = 2 * (count - 1);
  for (std::ptrdiff_t n = 1; n <= kMargin; ++n) {
    const auto at = [&](std::ptrdiff_t place) {
      place = (place % period + period) % period;
      return place < count ? place : period - place;
    };
    line[static_cast<std::size_t>(kMargin - n)] = line[static_cast<std::size_t>(kMargin + at(-n))];
    line[static_cast<std::size_t>(kMargin + count - 1 + n)] =
        line[static_cast<std::size_t>(kMargin + at(count - 1 + n))];
  }
}

// line: values from kMargin on.
void unwave_line(std::vector<float>& line, std::ptrdiff_t count, bool odd, bool whole) {
  if (count == 1) {
    if (odd) line[kMargin] = whole ? std::floor(0.5F * line[kMargin]) : 0.5F * line[kMargin];
    return;
  }
  const auto begin = static_cast<std::ptrdiff_t>(odd ? 1 : 0);  // of the first even place
  if (whole) {
    mirror(line, count);
    float* x = line.data() + kMargin;
    for (std::ptrdiff_t n = begin - 2 * begin; n <= count; ++n)
      if (((n + begin) & 1) == 0) x[n] -= std::floor(0.25F * (x[n - 1] + x[n + 1]) + 0.5F);
    for (std::ptrdiff_t n = 0; n < count; ++n)
      if (((n + begin) & 1) != 0) x[n] += std::floor(0.5F * (x[n - 1] + x[n + 1]));
    return;
  }
  constexpr float kHigh = 1.230174104914001F;
  constexpr float kSteps[] = {0.443506852043971F, 0.882911075530934F, -0.052980118572961F,
                              -1.586134342059924F};
  for (std::ptrdiff_t n = 0; n < count; ++n)
    line[static_cast<std::size_t>(kMargin + n)] *= ((n + begin) & 1) == 0 ? kHigh : 1 / kHigh;
  mirror(line, count);
  float* x = line.data() + kMargin;
  for (std::ptrdiff_t step = 0; step < 4; ++step)
    for (std::ptrdiff_t n = step - 3; n < count + 3 - step; ++n)
      if (((n + begin + step) & 1) == 0) x[n] -= kSteps[step] * (x[n - 1] + x[n + 1]);
}

}  // namespace

void unwave(std::vector<float>& values, const Area& area, bool whole) {
  const std::ptrdiff_t wide = area.wide(), high = area.high();
  std::vector<float> line(static_cast<std::size_t>(std::max(wide, high) + 2 * kMargin));
  for (std::ptrdiff_t y = 0; y < high; ++y) {
    float* row = values.data() + y * wide;
    std::copy(row, row + wide, line.begin() + kMargin);
    unwave_line(line, wide, (area.x0 & 1) != 0, whole);
    std::copy(line.begin() + kMargin, line.begin() + kMargin + wide, row);
  }
  for (std::ptrdiff_t x = 0; x < wide; ++x) {
    for (std::ptrdiff_t y = 0; y < high; ++y)
      line[static_cast<std::size_t>(kMargin + y)] = values[static_cast<std::size_t>(y * wide + x)];
    unwave_line(line, high, (area.y0 & 1) != 0, whole);
    for (std::ptrdiff_t y = 0; y < high; ++y)
      values[static_cast<std::size_t>(y * wide + x)] = line[static_cast<std::size_t>(kMargin + y)];
  }
}

}  // namespace burr::web
