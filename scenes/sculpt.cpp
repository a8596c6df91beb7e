#include "scenes/sculpt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/base/hash.h"

namespace burr::scenes {
namespace {

// 64 fixed bits of a lattice point
std::uint64_t bits_at(int i, int j, int k, std::uint32_t seed) {
  const auto word = [](int n) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(n)); };
  // 21 bits of each coordinate: unique within two million lattice points a side
  const std::uint64_t at = (word(i) & 0x1fffff) | (word(j) & 0x1fffff) << 21 | word(k) << 42;
  return base::mix(base::mix(seed, std::uint64_t{0}), at);
}

// 21 of them as 0..1
double share(std::uint64_t bits, int which) {
  return static_cast<double>((bits >> (21 * which)) & 0x1fffff) / 0x1fffff;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

double blend(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::max(a, b) + overlap * overlap * width / 4;
}

double carve_soft(double a, double b, double width) { return -blend(-a, -b, width); }

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radius) {
  const Vec3 q = p - centre;
  const double k0 = q.cwiseQuotient(radius).norm();
  const double k1 = q.cwiseQuotient(radius.cwiseProduct(radius)).norm();
  if (k1 == 0) return radius.minCoeff();
  return std::min(k0 * (1 - k0) / k1, radius.minCoeff());
}

// after the closed form of Quilez, "Round cone", for balls neither of which holds the other
double RoundCone::depth(const Vec3& p) const {
  const Vec3 axis = b - a;
  const double length2 = axis.squaredNorm(), length = std::sqrt(length2);
  const double taper = radius_a - radius_b;
  if (length <= std::abs(taper))
    return std::max(radius_a - (p - a).norm(), radius_b - (p - b).norm());
  const Vec3 u = axis / length;
  const double sin_t = taper / length, cos_t = std::sqrt(1 - sin_t * sin_t);
  const double along = (p - a).dot(u), across = (p - a - along * u).norm();
  // in the plane of p and the axis, the mantle leans by the taper
  const double foot = along - across * sin_t / cos_t;
  if (foot < 0) return radius_a - (p - a).norm();
  if (foot > length) return radius_b - (p - b).norm();
  return radius_a - (across * cos_t + along * sin_t);
}

Curve::Curve(const std::vector<Vec3>& through, double exact_within, int steps)
    : exact_within_(exact_within) {
  const auto n = through.size();
  const auto point = [&](std::size_t i, int shift) {
    const auto at = static_cast<std::ptrdiff_t>(i) + shift;
    return through[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(n) - 1))];
  };
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vec3 p0 = point(i, -1), p1 = point(i, 0), p2 = point(i, 1), p3 = point(i, 2);
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      points_.push_back(0.5 * (2 * p1 + t * (p2 - p0) + t * t * (2 * p0 - 5 * p1 + 4 * p2 - p3) +
                               t * t * t * (3 * p1 - p0 - 3 * p2 + p3)));
    }
  }
  points_.push_back(through.back());
  constexpr std::size_t kPieces = 6;
  for (std::size_t first = 0; first + 1 < points_.size(); first += kPieces) {
    Stretch s{first, std::min(first + kPieces, points_.size() - 1), Vec3::Zero(), 0};
    s.centre = 0.5 * (points_[s.first] + points_[s.last]);
    for (std::size_t i = s.first; i <= s.last; ++i)
      s.reach = std::max(s.reach, (points_[i] - s.centre).norm());
    stretches_.push_back(s);
  }
}

double Curve::distance(const Vec3& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Stretch& s : stretches_) {
    const double at_least = (p - s.centre).norm() - s.reach;
    if (at_least >= nearest) continue;
    if (at_least > exact_within_) {
      nearest = at_least;
      continue;
    }
    for (std::size_t i = s.first; i < s.last; ++i)
      nearest = std::min(nearest, distance_to_segment(p, points_[i], points_[i + 1]));
  }
  return nearest;
}

double Circle::distance(const Vec3& p) const {
  const Vec3 q = p - centre;
  const double height = q.dot(axis);
  return std::hypot((q - height * axis).norm() - radius, height);
}

double noise(const Vec3& p, double wavelength, std::uint32_t seed) {
  const Vec3 q = p / wavelength;
  const int i = static_cast<int>(std::floor(q.x())), j = static_cast<int>(std::floor(q.y())),
            k = static_cast<int>(std::floor(q.z()));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double u = ease(q.x() - i), v = ease(q.y() - j), w = ease(q.z() - k);
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int x = c & 1, y = (c >> 1) & 1, z = c >> 2;
    const double weight = (x == 1 ? u : 1 - u) * (y == 1 ? v : 1 - v) * (z == 1 ? w : 1 - w);
    sum += weight * (2 * share(bits_at(i + x, j + y, k + z, seed), 0) - 1);
  }
  return sum;
}

double foam(const Vec3& p, double spacing, double open, std::uint32_t seed) {
  const Vec3 q = p / spacing;
  const int i = static_cast<int>(std::floor(q.x())), j = static_cast<int>(std::floor(q.y())),
            k = static_cast<int>(std::floor(q.z()));
  struct Seed {
    double distance;
    std::uint64_t bits;
  };
  Seed seeds[27];
  std::size_t nearest = 0;
  for (std::size_t n = 0; n < 27; ++n) {
    const auto c = static_cast<int>(n);
    const int x = i + c % 3 - 1, y = j + c / 3 % 3 - 1, z = k + c / 9 - 1;
    const std::uint64_t bits = bits_at(x, y, z, seed);
    const Vec3 at(x + 0.15 + 0.7 * share(bits, 0), y + 0.15 + 0.7 * share(bits, 1),
                  z + 0.15 + 0.7 * share(bits, 2));
    seeds[n] = {(q - at).norm(), bits};
    if (seeds[n].distance < seeds[nearest].distance) nearest = n;
  }
  // the two nearest walls that are there, their corner rounded; half the difference of two
  // distances is continuous where a missing wall is crossed
  double first = 1, second = 1;
  for (std::size_t n = 0; n < 27; ++n) {
    if (n == nearest) continue;
    const std::uint64_t pair = seeds[n].bits ^ seeds[nearest].bits;  // the same from both sides
    if (share(base::mix(pair, std::uint64_t{1}), 1) < open) continue;
    const double wall = 0.5 * (seeds[n].distance - seeds[nearest].distance);
    if (wall < first) {
      second = first;
      first = wall;
    } else {
      second = std::min(second, wall);
    }
  }
  return spacing * carve_soft(first, second, 0.12);
}

}  // namespace burr::scenes
