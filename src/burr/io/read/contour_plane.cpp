// Distances: exact, by the lower envelope of parabolas (Felzenszwalb & Huttenlocher 2012), along u and then along v.
#include "burr/io/read/contour_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace burr::io {
namespace {

constexpr float kFar = 1e12F;  // [mm^2]

// A vertex that lies on the line of pixels but for rounding lies on it.
double snapped(double pixels) {
  constexpr double kSteps = 1e6;
  return std::round(std::clamp(pixels, -1e7, 1e7) * kSteps) / kSteps;
}

// The squared distance to the nearest place where f is 0, along one line of n values with this distance and stride.
class Envelope {
 public:
  void run(float* f, int n, std::size_t stride, double gap) {
    const auto size = static_cast<std::size_t>(n);
    value_.resize(size);
    place_.resize(size);
    bound_.resize(size + 1);
    for (std::size_t q = 0; q < size; ++q) value_[q] = static_cast<double>(f[q * stride]);
    const double square = gap * gap;
    std::size_t k = 0;
    place_[0] = 0;
    bound_[0] = -std::numeric_limits<double>::infinity();
    bound_[1] = std::numeric_limits<double>::infinity();
    for (std::size_t q = 1; q < size; ++q) {
      double meet = crossing(q, place_[k], square);
      while (meet <= bound_[k]) meet = crossing(q, place_[--k], square);
      place_[++k] = q;
      bound_[k] = meet;
      bound_[k + 1] = std::numeric_limits<double>::infinity();
    }
    k = 0;
    for (std::size_t q = 0; q < size; ++q) {
      while (bound_[k + 1] < static_cast<double>(q)) ++k;
      const double off = static_cast<double>(q) - static_cast<double>(place_[k]);
      f[q * stride] =
          static_cast<float>(std::min(off * off * square + value_[place_[k]], double{kFar}));
    }
  }

 private:
  // Where the parabolas of two places meet, the later one being lower beyond.
  [[nodiscard]] double crossing(std::size_t q, std::size_t p, double square) const {
    const auto a = static_cast<double>(q), b = static_cast<double>(p);
    return ((value_[q] + square * a * a) - (value_[p] + square * b * b)) / (2 * square * (a - b));
  }

  std::vector<double> value_, bound_;
  std::vector<std::size_t> place_;
};

// The distance of each pixel to the nearest one that is inside (or, of_inside false, outside).
std::vector<float> distances(const std::vector<std::uint8_t>& inside, const PlaneGrid& grid,
                             bool of_inside) {
  std::vector<float> out(inside.size());
  for (std::size_t n = 0; n < inside.size(); ++n)
    out[n] = (inside[n] != 0) == of_inside ? 0.0F : kFar;
  Envelope envelope;
  const auto nu = static_cast<std::size_t>(grid.nu);
  for (int v = 0; v < grid.nv; ++v)
    envelope.run(out.data() + static_cast<std::size_t>(v) * nu, grid.nu, 1, grid.du);
  for (std::size_t u = 0; u < nu; ++u) envelope.run(out.data() + u, grid.nv, nu, grid.dv);
  for (float& square : out) square = std::sqrt(square);
  return out;
}

}  // namespace

PlaneMask::PlaneMask(const PlaneGrid& grid, const std::vector<Curve>& curves)
    : grid_(grid), inside_(static_cast<std::size_t>(grid.nu) * static_cast<std::size_t>(grid.nv)) {
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(grid.nv));
  for (const Curve& curve : curves) {
    std::array<double, 2> middle = {0, 0};
    for (const auto& corner : curve)
      for (std::size_t c = 0; c < 2; ++c)
        middle[c] += corner[c] / static_cast<double>(curve.size());
    const double u = std::round((middle[0] - grid.u0) / grid.du),
                 v = std::round((middle[1] - grid.v0) / grid.dv);
    if (u >= 0 && v >= 0 && u < grid.nu && v < grid.nv)
      seeds_.push_back(static_cast<std::size_t>(v) * static_cast<std::size_t>(grid.nu) +
                       static_cast<std::size_t>(u));
  }
  for (const Curve& curve : curves)
    for (std::size_t n = 0; n < curve.size(); ++n) {
      const auto pixel = [&](std::size_t at) {
        return std::array<double, 2>{snapped((curve[at][0] - grid.u0) / grid.du),
                                     snapped((curve[at][1] - grid.v0) / grid.dv)};
      };
      // from the lower end, so that both ways along an edge cross a line at the same place
      std::array<double, 2> a = pixel(n), b = pixel((n + 1) % curve.size());
      if (a[1] > b[1] || (a[1] == b[1] && a[0] > b[0])) std::swap(a, b);
      const int first = static_cast<int>(std::max(0.0, std::ceil(a[1]))),
                end = static_cast<int>(std::clamp(std::ceil(b[1]), 0.0, double{1} * grid.nv));
      for (int v = first; v < end; ++v)
        crossings[static_cast<std::size_t>(v)].push_back(a[0] + (v - a[1]) / (b[1] - a[1]) *
                                                                    (b[0] - a[0]));
    }
  for (int v = 0; v < grid.nv; ++v) {
    std::vector<double>& line = crossings[static_cast<std::size_t>(v)];
    std::sort(line.begin(), line.end());
    for (std::size_t n = 0; n + 1 < line.size(); n += 2) {
      const double most = grid.nu;
      const int from = static_cast<int>(std::clamp(std::ceil(snapped(line[n])), 0.0, most)),
                to = static_cast<int>(std::clamp(std::ceil(snapped(line[n + 1])), 0.0, most));
      for (int u = from; u < to; ++u)
        inside_[static_cast<std::size_t>(v) * static_cast<std::size_t>(grid.nu) +
                static_cast<std::size_t>(u)] = 1;
    }
  }
}

void PlaneMask::measure_depth() {
  if (measured()) return;
  depth_ = distances(inside_, grid_, false);
  const bool any = std::any_of(inside_.begin(), inside_.end(), [](auto v) { return v != 0; });
  std::vector<std::uint8_t> shape = inside_;
  if (!any)  // too small for a pixel: what leads to it ends at its middle
    for (const std::size_t seed : seeds_) shape[seed] = 1;
  const std::vector<float> out = distances(shape, grid_, true);
  // the edge runs half-way between two pixels
  const auto half = static_cast<float>(0.5 * std::min(grid_.du, grid_.dv));
  std::size_t n = 0;
  for (int v = 0; v < grid_.nv; ++v)
    for (int u = 0; u < grid_.nu; ++u, ++n) {
      if (inside_[n] == 0) {
        depth_[n] = (any ? half : 0.0F) - out[n];
        continue;
      }
      // beyond the grid nothing is inside
      const double border = std::min({(u + 1) * grid_.du, (grid_.nu - u) * grid_.du,
                                      (v + 1) * grid_.dv, (grid_.nv - v) * grid_.dv});
      depth_[n] = std::min(depth_[n], static_cast<float>(border)) - half;
    }
}

double PlaneMask::depth_at(double u_mm, double v_mm) const {
  const double u = (u_mm - grid_.u0) / grid_.du, v = (v_mm - grid_.v0) / grid_.dv;
  if (!(u >= 0 && v >= 0 && u <= grid_.nu - 1 && v <= grid_.nv - 1))
    return -std::max(grid_.du, grid_.dv);
  const int a = std::min(static_cast<int>(u), std::max(0, grid_.nu - 2)),
            b = std::min(static_cast<int>(v), std::max(0, grid_.nv - 2));
  const int a1 = std::min(a + 1, grid_.nu - 1), b1 = std::min(b + 1, grid_.nv - 1);
  const double s = u - a, t = v - b;
  return (1 - t) * ((1 - s) * depth(a, b) + s * depth(a1, b)) +
         t * ((1 - s) * depth(a, b1) + s * depth(a1, b1));
}

}  // namespace burr::io
