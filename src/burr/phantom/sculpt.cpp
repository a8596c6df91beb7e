#include "burr/phantom/sculpt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burr/base/hash.h"

namespace burr::phantom {
namespace {

// 64 pseudo-random bits of a lattice point; always the same.
std::uint64_t bits_at(int i, int j, int k, std::uint32_t seed) {
  const auto word = [](int n) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(n)); };
  // 21 bits of each coordinate: unique within two million lattice points per axis
  const std::uint64_t at = (word(i) & 0x1fffff) | (word(j) & 0x1fffff) << 21 | word(k) << 42;
  return base::mix(base::mix(seed, std::uint64_t{0}), at);
}

// 21 of these bits as a number 0..1.
double share(std::uint64_t bits, int which) {
  return static_cast<double>((bits >> (21 * which)) & 0x1fffff) / 0x1fffff;
}

// A cache of what a lattice cell gives, because the next voxel usually needs the same cell. One
// entry for each of a few seeds; an entry that another seed uses is filled again.
template <class Said>
class Remembered {
 public:
  template <class Ask>
  const Said& at(int i, int j, int k, std::uint32_t seed, Ask&& ask) {
    Cell& cell = cells_[seed % kCells];
    if (!cell.filled || cell.i != i || cell.j != j || cell.k != k || cell.seed != seed) {
      cell = {true, i, j, k, seed, {}};
      ask(cell.said);
    }
    return cell.said;
  }

 private:
  static constexpr std::uint32_t kCells = 32;
  struct Cell {
    bool filled = false;
    int i = 0, j = 0, k = 0;
    std::uint32_t seed = 0;
    Said said{};
  };
  std::array<Cell, kCells> cells_;
};

}  // namespace

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radius) {
  const Vec3 q = p - centre;
  const double k0 = q.cwiseQuotient(radius).norm();
  const double k1 = q.cwiseQuotient(radius.cwiseProduct(radius)).norm();
  if (k1 == 0) return radius.minCoeff();
  return std::min(k0 * (1 - k0) / k1, radius.minCoeff());
}

RoundCone::RoundCone(const Vec3& a, const Vec3& b, double radius_a, double radius_b)
    : a_(a),
      b_(b),
      radius_a_(radius_a),
      radius_b_(radius_b),
      length_((b - a).norm()),
      middle_(0.5 * (a + b)),
      reach_(0.5 * length_ + std::max(radius_a, radius_b) + 1e-9) {
  const double taper = radius_a - radius_b;
  if (length_ <= std::abs(taper)) return;
  u_ = (b - a) / length_;
  sin_t_ = taper / length_;
  cos_t_ = std::sqrt(1 - sin_t_ * sin_t_);
}

// closed form of Quilez, "Round cone", for balls neither of which contains the other
double RoundCone::depth(const Vec3& p) const {
  const Vec3 q = p - a_;
  if (length_ <= std::abs(radius_a_ - radius_b_))
    return std::max(radius_a_ - q.norm(), radius_b_ - (p - b_).norm());
  const double along = q.dot(u_), across = (q - along * u_).norm();
  // in the plane of p and the axis: the mantle is inclined by the taper
  const double foot = along - across * sin_t_ / cos_t_;
  if (foot < 0) return radius_a_ - q.norm();
  if (foot > length_) return radius_b_ - (p - b_).norm();
  return radius_a_ - (across * cos_t_ + along * sin_t_);
}

Curve::Curve(const std::vector<Vec3>& through, double exact_within, int steps)
    : exact_within_(exact_within) {
  const auto n = through.size();
  std::vector<Vec3> points;
  const auto point = [&](std::size_t i, int shift) {
    const auto at = static_cast<std::ptrdiff_t>(i) + shift;
    return through[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(n) - 1))];
  };
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vec3 p0 = point(i, -1), p1 = point(i, 0), p2 = point(i, 1), p3 = point(i, 2);
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      points.push_back(0.5 * (2 * p1 + t * (p2 - p0) + t * t * (2 * p0 - 5 * p1 + 4 * p2 - p3) +
                              t * t * t * (3 * p1 - p0 - 3 * p2 + p3)));
    }
  }
  points.push_back(through.back());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 along = points[i + 1] - points[i];
    pieces_.push_back({points[i], along, along.squaredNorm()});
  }
  constexpr std::size_t kPieces = 6;
  for (std::size_t first = 0; first < pieces_.size(); first += kPieces) {
    Stretch s{first, std::min(first + kPieces, pieces_.size()), Vec3::Zero(), 0};
    s.centre = 0.5 * (points[s.first] + points[s.end]);
    for (std::size_t i = s.first; i <= s.end; ++i)
      s.reach = std::max(s.reach, (points[i] - s.centre).norm());
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
    double nearest2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = s.first; i < s.end; ++i) {
      const Piece& piece = pieces_[i];
      const Vec3 q = p - piece.from;
      const double t =
          piece.length2 > 0 ? std::clamp(q.dot(piece.along) / piece.length2, 0.0, 1.0) : 0.0;
      nearest2 = std::min(nearest2, (q - t * piece.along).squaredNorm());
    }
    nearest = std::min(nearest, std::sqrt(nearest2));
  }
  return nearest;
}

std::vector<Vec3> Curve::points() const {
  std::vector<Vec3> points;
  for (const Piece& piece : pieces_) points.push_back(piece.from);
  if (!pieces_.empty()) points.push_back(pieces_.back().from + pieces_.back().along);
  return points;
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
  thread_local Remembered<std::array<double, 8>> remembered;
  const std::array<double, 8>& corners = remembered.at(i, j, k, seed, [&](auto& said) {
    for (int c = 0; c < 8; ++c)
      said[static_cast<std::size_t>(c)] =
          2 * share(bits_at(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2), seed), 0) - 1;
  });
  double sum = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    const bool x = (c & 1) != 0, y = (c & 2) != 0, z = (c & 4) != 0;
    sum += (x ? u : 1 - u) * (y ? v : 1 - v) * (z ? w : 1 - w) * corners[c];
  }
  return sum;
}

double foam(const Vec3& p, double spacing, double open, std::uint32_t seed) {
  const Vec3 q = p / spacing;
  const int i = static_cast<int>(std::floor(q.x())), j = static_cast<int>(std::floor(q.y())),
            k = static_cast<int>(std::floor(q.z()));
  struct Seed {
    Vec3 at = Vec3::Zero();
    std::uint64_t bits = 0;
  };
  thread_local Remembered<std::array<Seed, 27>> remembered;
  const std::array<Seed, 27>& seeds = remembered.at(i, j, k, seed, [&](auto& said) {
    for (int c = 0; c < 27; ++c) {
      const int x = i + c % 3 - 1, y = j + c / 3 % 3 - 1, z = k + c / 9 - 1;
      const std::uint64_t bits = bits_at(x, y, z, seed);
      said[static_cast<std::size_t>(c)] = {
          Vec3(x + 0.15 + 0.7 * share(bits, 0), y + 0.15 + 0.7 * share(bits, 1),
               z + 0.15 + 0.7 * share(bits, 2)),
          bits};
    }
  });
  double distance[27];
  std::size_t nearest = 0;
  for (std::size_t n = 0; n < 27; ++n) {
    distance[n] = (q - seeds[n].at).norm();
    if (distance[n] < distance[nearest]) nearest = n;
  }
  // the two nearest walls that exist, with a rounded corner; half the difference of two distances
  // is continuous across a missing wall
  double first = 1, second = 1;
  for (std::size_t n = 0; n < 27; ++n) {
    if (n == nearest) continue;
    const double wall = 0.5 * (distance[n] - distance[nearest]);
    if (wall >= second) continue;
    const std::uint64_t pair = seeds[n].bits ^ seeds[nearest].bits;  // the same from both sides
    if (share(base::mix(pair, std::uint64_t{1}), 1) < open) continue;
    if (wall < first) {
      second = first;
      first = wall;
    } else {
      second = wall;
    }
  }
  return spacing * carve_soft(first, second, 0.12);
}

}  // namespace burr::phantom
