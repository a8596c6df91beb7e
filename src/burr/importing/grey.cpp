#include "burr/importing/grey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burr/importing/smooth_kernel.h"
#include "burr/io/workers.h"
#include "burr/rt/simd.h"

namespace burr::importing {
namespace {

std::size_t count(const math::Ijk& size) {
  return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
         static_cast<std::size_t>(size.z());
}

const float* row_of(const io::Scan& scan, int i, int j, int k) {
  return scan.values.data() + static_cast<std::size_t>(i) +
         static_cast<std::size_t>(scan.size.x()) *
             (static_cast<std::size_t>(j) +
              static_cast<std::size_t>(scan.size.y()) * static_cast<std::size_t>(k));
}

double catmull_rom(double x) {
  x = std::abs(x);
  if (x < 1) return 1 + x * x * (1.5 * x - 2.5);
  if (x < 2) return 2 - x * (4 - x * (2.5 - 0.5 * x));
  return 0;
}

// The old samples that make one new sample, and their weights.
struct Taps {
  int first = 0;
  // on a finer axis the two around it, those around them, and how far it lies from `below` to `above`;
  // below -1: a coarser axis
  int before = 0, below = -1, above = 0, after = 0;
  float share = 0;
  std::vector<float> weights;
};

std::vector<Taps> taps(int from, int to, double scale, double first) {
  const double wide = std::max(1.0, scale);
  std::vector<Taps> all(static_cast<std::size_t>(to));
  for (int n = 0; n < to; ++n) {
    const double at = first + n * scale;
    const int lo = static_cast<int>(std::floor(at - 2 * wide)) + 1,
              hi = static_cast<int>(std::ceil(at + 2 * wide)) - 1;
    Taps& tap = all[static_cast<std::size_t>(n)];
    tap.first = std::clamp(lo, 0, from - 1);
    const int last = std::clamp(hi, 0, from - 1);
    std::vector<double> sum(static_cast<std::size_t>(last - tap.first + 1), 0.0);
    double total = 0;
    for (int s = lo; s <= hi; ++s) {
      const double w = catmull_rom((s - at) / wide);
      // beyond the border the last sample is repeated
      sum[static_cast<std::size_t>(std::clamp(s, 0, from - 1) - tap.first)] += w;
      total += w;
    }
    for (const double w : sum) tap.weights.push_back(static_cast<float>(w / total));
    if (scale > 1) continue;
    tap.below = std::clamp(static_cast<int>(std::floor(at)), 0, from - 1);
    tap.above = std::clamp(tap.below + 1, 0, from - 1);
    tap.before = std::clamp(tap.below - 1, 0, from - 1);
    tap.after = std::clamp(tap.below + 2, 0, from - 1);
    tap.share = std::clamp(static_cast<float>(at - tap.below), 0.0F, 1.0F);
  }
  return all;
}

std::int16_t rounded(float value) {
  return static_cast<std::int16_t>(std::lrintf(std::clamp(value, -32768.0F, 32767.0F)));
}

// The new value at the share t of the way from a to b; `before` and `after` lie around these two. In a wall
// one or two voxels thin the straight line between them, as marching cubes takes it: a cubic is wider
// there. Else the cubic, within the range of a and b; the line would leave terraces.
inline std::int16_t faithful(std::int16_t cubic, int before, int a, int b, int after, float t,
                             int level) {
  const int low = a < b ? a : b, high = a < b ? b : a;
  const bool thin = (before < level || a < level) && (after < level || b < level);
  if (thin && high >= level)
    return static_cast<std::int16_t>(
        std::lrintf(static_cast<float>(a) + t * static_cast<float>(b - a)));
  return static_cast<std::int16_t>(cubic < low ? low : cubic > high ? high : int{cubic});
}

// The same for a row, given the four rows around it. Where all is below the level nothing changes.
void make_faithful(const std::array<const std::int16_t*, 4>& rows, float t, std::size_t length,
                   std::int16_t level, std::int16_t* target) {
  constexpr std::size_t kChunk = 32;
  for (std::size_t from = 0; from < length; from += kChunk) {
    const std::size_t to = std::min(length, from + kChunk);
    std::int16_t highest = std::numeric_limits<std::int16_t>::min();
    for (std::size_t x = from; x < to; ++x) {
      const std::int16_t a = rows[1][x] > rows[2][x] ? rows[1][x] : rows[2][x];
      const std::int16_t b = a > target[x] ? a : target[x];
      highest = highest > b ? highest : b;
    }
    if (highest < level) continue;
    for (std::size_t x = from; x < to; ++x)
      target[x] = faithful(target[x], rows[0][x], rows[1][x], rows[2][x], rows[3][x], t, level);
  }
}

// weighted sums of whole rows: for the y and z axis
void sum_rows(const std::int16_t* const* rows, const float* weights, std::size_t n,
              std::size_t length, std::vector<float>& work, std::int16_t* out) {
  std::fill(work.begin(), work.begin() + static_cast<std::ptrdiff_t>(length), 0.0F);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t x = 0; x < length; ++x) work[x] += weights[t] * static_cast<float>(rows[t][x]);
  for (std::size_t x = 0; x < length; ++x) out[x] = rounded(work[x]);
}

}  // namespace

Grey take_grey(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size) {
  Grey grey;
  grey.size = size;
  grey.voxels.resize(count(size));
  const auto for_each_row = [&](const auto& work) {
    std::size_t v = 0;
    for (int k = 0; k < size.z(); ++k)
      for (int j = 0; j < size.y(); ++j, v += static_cast<std::size_t>(size.x()))
        work(row_of(scan, from.x(), from.y() + j, from.z() + k), grey.voxels.data() + v);
  };
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for_each_row([&](const float* row, std::int16_t*) {
    for (int i = 0; i < size.x(); ++i) {
      if (row[i] == scan.outside) continue;
      low = row[i] < low ? row[i] : low;
      high = row[i] > high ? row[i] : high;
    }
  });
  // what was not measured may be far below; it is as dark as the darkest
  const auto value_of = [&](float value) {
    return value == scan.outside && value < low ? low : value;
  };
  bool is_whole = low >= -30000 && high <= 30000;
  if (is_whole)
    for_each_row([&](const float* row, std::int16_t* to) {
      int broken = 0;
      for (int i = 0; i < size.x(); ++i) {
        const float value = value_of(row[i]);
        const int number = static_cast<int>(value);
        broken |= static_cast<int>(static_cast<float>(number) != value);
        to[i] = static_cast<std::int16_t>(number);
      }
      is_whole = is_whole && broken == 0;
    });
  if (is_whole) return grey;
  grey.zero = 0.5 * (double{low} + double{high});
  grey.step = std::max((double{high} - double{low}) / 40000.0, 1e-30);  // leaves room for cubic
                                                                        // overshoot
  const double inverse = 1 / grey.step;
  for_each_row([&](const float* row, std::int16_t* to) {
    for (int i = 0; i < size.x(); ++i)
      to[i] = rounded(static_cast<float>((double{value_of(row[i])} - grey.zero) * inverse));
  });
  return grey;
}

double measure_noise(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size,
                     double iso) {
  if (size.minCoeff() < 3) return 0;
  // about a million samples, evenly spread
  const double all = static_cast<double>(count(size));
  const int step = std::max(1, static_cast<int>(std::cbrt(all / 1.0e6)));
  std::vector<float> inside, around;
  float low = std::numeric_limits<float>::infinity();
  for (int k = 1; k + 1 < size.z(); k += step)
    for (int j = 1; j + 1 < size.y(); j += step) {
      const float* row = row_of(scan, from.x(), from.y() + j, from.z() + k);
      for (int i = 1; i + 1 < size.x(); i += step)
        if (row[i] != scan.outside) low = std::min(low, row[i]);
    }
  const float level = static_cast<float>(iso);
  // air itself is often clipped and shows no noise: "around" begins a third of the way up to the
  // iso
  const float floor_value = low + (level - low) * 0.35F;
  for (int k = 1; k + 1 < size.z(); k += step)
    for (int j = 1; j + 1 < size.y(); j += step) {
      const float* row = row_of(scan, from.x(), from.y() + j, from.z() + k);
      const float* up = row_of(scan, from.x(), from.y() + j - 1, from.z() + k);
      const float* down = row_of(scan, from.x(), from.y() + j + 1, from.z() + k);
      const float* front = row_of(scan, from.x(), from.y() + j, from.z() + k - 1);
      const float* back = row_of(scan, from.x(), from.y() + j, from.z() + k + 1);
      for (int i = 1; i + 1 < size.x(); i += step) {
        const float near[6] = {row[i - 1], row[i + 1], up[i], down[i], front[i], back[i]};
        if (scan.outside &&
            (row[i] == scan.outside || std::find(near, near + 6, *scan.outside) != near + 6))
          continue;
        const auto [least, most] = std::minmax_element(near, near + 6);
        const float mean = (near[0] + near[1] + near[2] + near[3] + near[4] + near[5]) / 6;
        const float differs = std::abs(row[i] - mean);
        if (*least >= level && row[i] >= level) {
          inside.push_back(differs);
        } else if (*most < level && row[i]<level&& * least> floor_value) {
          around.push_back(differs);
        }
      }
    }
  // Edges and texture hardly move the lower quartile. It is 0.3186 sigma for a normal distribution,
  // and the difference to a mean of six has 7/6 of the variance.
  const auto sigma = [](std::vector<float>& found) {
    if (found.size() < 500) return std::numeric_limits<double>::infinity();
    const auto quarter = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 4);
    std::nth_element(found.begin(), quarter, found.end());
    return double{*quarter} / 0.3186 * std::sqrt(6.0 / 7.0);
  };
  const double noise = std::min(sigma(inside), sigma(around));
  return std::isfinite(noise) ? noise : 0.0;
}

double otsu(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size) {
  constexpr std::size_t kBins = 1024;
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const float* row = row_of(scan, from.x(), from.y() + j, from.z() + k);
      for (int i = 0; i < size.x(); ++i) {
        if (row[i] == scan.outside) continue;
        low = std::min(low, row[i]);
        high = std::max(high, row[i]);
      }
    }
  if (!(high > low)) return double{low};
  std::vector<double> bins(kBins);
  const double scale = static_cast<double>(kBins - 1) / (double{high} - double{low});
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const float* row = row_of(scan, from.x(), from.y() + j, from.z() + k);
      for (int i = 0; i < size.x(); ++i)
        if (row[i] != scan.outside)
          bins[static_cast<std::size_t>((double{row[i]} - double{low}) * scale + 0.5)] += 1;
    }
  double total = 0, sum = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    total += bins[b];
    sum += bins[b] * static_cast<double>(b);
  }
  // between classes the best split is often a plateau: take its middle
  double below = 0, sum_below = 0, best = -1, first = 0, last = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    below += bins[b];
    sum_below += bins[b] * static_cast<double>(b);
    const double above = total - below;
    if (below == 0 || above == 0) continue;
    const double apart = sum_below / below - (sum - sum_below) / above;
    const double between = below * above * apart * apart;
    if (between > best * (1 + 1e-12)) {
      best = between;
      first = last = static_cast<double>(b);
    } else if (between >= best * (1 - 1e-12)) {
      last = static_cast<double>(b);
    }
  }
  return double{low} + (0.5 * (first + last) + 0.5) / scale;
}

namespace {

// Whether a surface lies within two voxels, along an axis, of the voxels of a row.
class NearRow {
 public:
  explicit NearRow(int length) : length_(length), near_(static_cast<std::size_t>(length)) {}

  // row: the row's first voxel; sy, sz: from it to the next along y and z. Values from `level` on are
  // inside.
  void look(const std::int16_t* row, std::ptrdiff_t sy, std::ptrdiff_t sz, std::int16_t level) {
    std::fill(near_.begin(), near_.end(), std::int16_t{0});
    for (const std::ptrdiff_t s : {std::ptrdiff_t{1}, sy, sz})
      for (int i = 2; i < length_ - 2; ++i) {
        const std::int16_t* at = row + i;
        // 0 or 1 for each voxel; the sum is 0 or 5 where all are on the same side
        const int in = (at[0] >= level) + (at[s] >= level) + (at[-s] >= level) +
                       (at[2 * s] >= level) + (at[-2 * s] >= level);
        near_[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(
            near_[static_cast<std::size_t>(i)] | static_cast<int>(in != 0 && in != 5));
      }
  }
  [[nodiscard]] bool any(int first, int count) const {
    const auto from = near_.begin() + first;
    return std::find(from, from + count, std::int16_t{1}) != from + count;
  }

 private:
  int length_;
  std::vector<std::int16_t> near_;
};

SmoothEight smooth_kernel() noexcept {
  if constexpr (rt::kWideKernels)
    if (rt::simd() != rt::Simd::scalar) return avx2::smooth_eight;
  return scalar::smooth_eight;
}

}  // namespace

bool smooth_near(Grey& grey, double iso_stored, double noise_stored, const math::Vec3& spacing_mm,
                 bool faithful, Progress& progress) {
  constexpr int kReach = 2, kLanes = 8;
  const int nx = grey.size.x(), ny = grey.size.y(), nz = grey.size.z();
  if (grey.size.minCoeff() <= 2 * kReach || iso_stored > 32767) return true;  // no surface
  const double finest = spacing_mm.minCoeff();

  std::vector<SmoothNeighbour> neighbours;
  for (int dz = -kReach; dz <= kReach; ++dz)
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const math::Vec3 d = math::Vec3(dx, dy, dz).cwiseProduct(spacing_mm) / finest;
        const double weight = std::exp(-d.squaredNorm() / (2 * 1.3 * 1.3));
        if (weight < 0.01) continue;
        neighbours.push_back({dx + std::ptrdiff_t{nx} * (dy + std::ptrdiff_t{ny} * dz),
                              static_cast<float>(weight), static_cast<float>(d.x()),
                              static_cast<float>(d.y()), static_cast<float>(d.z())});
      }
  const float iso = static_cast<float>(iso_stored);
  SmoothRule rule;
  rule.neighbours = neighbours.data();
  rule.count = static_cast<int>(neighbours.size());
  rule.range = static_cast<float>(1.0 / (3.0 * 3.0 * noise_stored * noise_stored));
  for (const SmoothNeighbour& o : neighbours) {
    rule.moment_x += o.weight * o.x * o.x;
    rule.moment_y += o.weight * o.y * o.y;
    rule.moment_z += o.weight * o.z * o.z;
  }
  const std::ptrdiff_t sy = nx, sz = std::ptrdiff_t{nx} * ny;
  std::vector<std::int16_t> source;
  source.reserve(grey.voxels.size() + kLanes);
  source = grey.voxels;
  source.resize(grey.voxels.size() + kLanes);  // the last lanes of the last row read beyond it
  const SmoothEight smooth_eight = smooth_kernel();
  // whole numbers, so they are above the level when they are above the next whole number
  const auto level = static_cast<std::int16_t>(std::clamp(std::ceil(iso), -32768.0F, 32767.0F));
  return io::in_pieces(nz, progress, "smoothing", [&](int k) {
    if (k < kReach || k >= nz - kReach) return;
    NearRow near_surface(nx);
    for (int j = kReach; j < ny - kReach; ++j) {
      const std::ptrdiff_t row = sy * j + sz * k;
      near_surface.look(source.data() + row, sy, sz, level);
      for (int i0 = kReach; i0 < nx - kReach; i0 += kLanes) {
        const int lanes = std::min(kLanes, nx - kReach - i0);
        if (!near_surface.any(i0, lanes)) continue;
        smooth_eight(source.data() + row + i0, rule, lanes, grey.voxels.data() + row + i0);
        if (!faithful) continue;
        for (std::ptrdiff_t v = row + i0; v < row + i0 + lanes; ++v) {
          const std::int16_t* at = source.data() + v;
          std::int16_t& now = grey.voxels[static_cast<std::size_t>(v)];
          // no bone where neither the voxel nor one beside it reached the level
          if (now >= level && at[0] < level && at[1] < level && at[-1] < level && at[sy] < level &&
              at[-sy] < level && at[sz] < level && at[-sz] < level)
            now = at[0];
        }
      }
    }
  });
}

bool resample(Grey& grey, const NewGrid& to, Progress& progress,
              std::vector<std::int16_t>* before_it) {
  const auto same = [&](int axis) {
    return std::abs(to.scale[axis] - 1) < 1e-9 && std::abs(to.first[axis]) < 1e-9 &&
           to.size[axis] == grey.size[axis];
  };
  for (const int axis : {0, 1, 2}) {
    if (same(axis)) continue;
    const math::Ijk old = grey.size;
    math::Ijk fresh = old;
    fresh[axis] = to.size[axis];
    const std::vector<Taps> all = taps(old[axis], to.size[axis], to.scale[axis], to.first[axis]);
    std::vector<std::int16_t> out(count(fresh));
    const auto nx = static_cast<std::size_t>(old.x()), ny = static_cast<std::size_t>(old.y());
    const auto fx = static_cast<std::size_t>(fresh.x()), fy = static_cast<std::size_t>(fresh.y());
    const bool done = io::in_pieces(fresh.z(), progress, "making voxels cubic", [&](int z) {
      const auto k = static_cast<std::size_t>(z);
      std::vector<float> work(nx);
      std::vector<const std::int16_t*> rows;
      for (std::size_t j = 0; j < fy; ++j) {
        std::int16_t* target = out.data() + fx * (j + fy * k);
        if (axis == 0) {
          const std::int16_t* row = grey.voxels.data() + nx * (j + ny * k);
          for (std::size_t i = 0; i < fx; ++i) {
            const Taps& tap = all[i];
            float sum = 0;
            for (std::size_t t = 0; t < tap.weights.size(); ++t)
              sum +=
                  tap.weights[t] * static_cast<float>(row[static_cast<std::size_t>(tap.first) + t]);
            target[i] = rounded(sum);
            if (to.faithful && tap.below >= 0 &&
                std::max({target[i], row[tap.below], row[tap.above]}) >= to.level)
              target[i] = faithful(target[i], row[tap.before], row[tap.below], row[tap.above],
                                   row[tap.after], tap.share, to.level);
          }
          continue;
        }
        const Taps& tap = all[axis == 1 ? j : k];
        const auto line = [&](int n) {
          const auto at = static_cast<std::size_t>(n);
          return grey.voxels.data() + (axis == 1 ? nx * (at + ny * k) : nx * (j + ny * at));
        };
        rows.clear();
        for (std::size_t t = 0; t < tap.weights.size(); ++t)
          rows.push_back(line(tap.first + static_cast<int>(t)));
        sum_rows(rows.data(), tap.weights.data(), rows.size(), nx, work, target);
        if (!to.faithful || tap.below < 0) continue;
        const std::int16_t *before = line(tap.before), *below = line(tap.below),
                           *above = line(tap.above), *after = line(tap.after);
        make_faithful({before, below, above, after}, tap.share, nx, to.level, target);
      }
    });
    if (!done) return false;
    grey.voxels.swap(out);
    if (before_it != nullptr && before_it->empty()) *before_it = std::move(out);
    grey.size = fresh;
  }
  return true;
}

bool make_cubic(Grey& grey, std::int16_t level, NewGrid to, Progress& progress) {
  const bool finer = to.scale.maxCoeff() <= 1 + 1e-9, changes = !to.scale.isOnes(1e-9);
  if (!to.faithful || !finer || !changes) return resample(grey, to, progress);
  to.level = level;
  const math::Ijk size = grey.size;
  std::vector<std::int16_t> old;
  if (!resample(grey, to, progress, &old)) return false;
  if (old.empty()) return true;  // nothing was changed
  // along each axis, of an old voxel: the new one before it, and the nearest
  std::array<std::vector<std::size_t>, 3> before, nearest;
  for (int a = 0; a < 3; ++a)
    for (int n = 0; n < size[a]; ++n) {
      const double at = (n - to.first[a]) / to.scale[a];
      const auto bounded = [&](double v) {
        return static_cast<std::size_t>(std::clamp(v, 0.0, to.size[a] - 1.0));
      };
      before[static_cast<std::size_t>(a)].push_back(bounded(std::floor(at)));
      nearest[static_cast<std::size_t>(a)].push_back(bounded(std::round(at)));
    }
  const auto nx = static_cast<std::size_t>(to.size.x()), ny = static_cast<std::size_t>(to.size.y()),
             nz = static_cast<std::size_t>(to.size.z());
  std::size_t v = 0;
  for (std::size_t k = 0; k < before[2].size(); ++k)
    for (std::size_t j = 0; j < before[1].size(); ++j) {
      const std::size_t y = before[1][j], z = before[2][k];
      const std::size_t up = y + 1 < ny ? nx : 0, above = z + 1 < nz ? nx * ny : 0;
      for (std::size_t i = 0; i < before[0].size(); ++i, ++v) {
        if (old[v] < level) continue;
        const std::size_t x = before[0][i], right = x + 1 < nx ? 1 : 0;
        const std::int16_t* at = grey.voxels.data() + x + nx * (y + ny * z);
        if (at[0] >= level || at[right] >= level || at[up] >= level || at[up + right] >= level ||
            at[above] >= level || at[above + right] >= level || at[above + up] >= level ||
            at[above + up + right] >= level)
          continue;
        grey.voxels[nearest[0][i] + nx * (nearest[1][j] + ny * nearest[2][k])] = old[v];
      }
    }
  return true;
}

}  // namespace burr::importing
