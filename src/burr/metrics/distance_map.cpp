#include "burr/metrics/distance_map.h"

#include <algorithm>
#include <atomic>

#include "burr/base/check.h"
#include "burr/rt/thread.h"

namespace burr::metrics {
namespace {

// A line of squared distances and the parabolas of its lower envelope.
struct Line {
  std::vector<std::int32_t> in, out;
  std::vector<int> parabola, from;  // which, and from where on it is the lowest
};

// out[x] = min over i of (x - i)^2 + in[i]
void lower_envelope(Line& line) {
  const int size = static_cast<int>(line.in.size());
  const auto at = [&line](int x, int i) {
    return (x - i) * (x - i) + line.in[static_cast<std::size_t>(i)];
  };
  line.parabola.clear();
  line.from.clear();
  for (int i = 0; i < size; ++i) {
    if (line.in[static_cast<std::size_t>(i)] >= kNowhere) continue;
    while (!line.parabola.empty() &&
           at(line.from.back(), line.parabola.back()) > at(line.from.back(), i)) {
      line.parabola.pop_back();
      line.from.pop_back();
    }
    int from = 0;
    if (!line.parabola.empty()) {
      const int top = line.parabola.back();
      // the last whole x at which the top parabola is not higher
      const int numerator = i * i - top * top + line.in[static_cast<std::size_t>(i)] -
                            line.in[static_cast<std::size_t>(top)];
      from = 1 + numerator / (2 * (i - top));
      if (from >= size) continue;
    }
    line.parabola.push_back(i);
    line.from.push_back(from);
  }
  std::size_t n = line.parabola.size();
  for (int x = size - 1; x >= 0; --x) {
    while (n > 1 && line.from[n - 1] > x) --n;
    line.out[static_cast<std::size_t>(x)] = n == 0 ? kNowhere : at(x, line.parabola[n - 1]);
  }
}

// All lines along one axis; each thread takes whole planes.
void along(int axis, const VoxelBox& box, int threads, std::vector<std::int32_t>& squares) {
  const int across = axis == 2 ? 1 : 2, other = 3 - axis - across;
  std::atomic<int> next{0};
  rt::on_threads(std::max(1, threads), [&](int) {
    Line line;
    line.in.resize(static_cast<std::size_t>(box.size[axis]));
    line.out.resize(line.in.size());
    const std::size_t stride = box.index(math::Ijk::Unit(axis));
    for (int plane = next++; plane < box.size[across]; plane = next++)
      for (int row = 0; row < box.size[other]; ++row) {
        const std::size_t start =
            box.index(plane * math::Ijk::Unit(across) + row * math::Ijk::Unit(other));
        for (std::size_t n = 0; n < line.in.size(); ++n) line.in[n] = squares[start + n * stride];
        lower_envelope(line);
        for (std::size_t n = 0; n < line.in.size(); ++n) squares[start + n * stride] = line.out[n];
      }
  });
}

}  // namespace

std::vector<std::int32_t> squared_distances(const VoxelBox& box,
                                            const std::vector<std::uint8_t>& set, int threads) {
  BURR_CHECK(set.size() == box.count() && (box.size.array() <= 8192).all());
  std::vector<std::int32_t> squares(set.size());
  for (std::size_t n = 0; n < set.size(); ++n) squares[n] = set[n] != 0 ? 0 : kNowhere;
  for (int axis = 0; axis < 3; ++axis) along(axis, box, threads, squares);
  return squares;
}

}  // namespace burr::metrics
