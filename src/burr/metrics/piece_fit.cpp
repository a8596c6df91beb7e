#include "burr/metrics/piece_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "burr/volume/sample.h"

namespace burr::metrics {

using math::Ijk;
using math::Vec3;
using volume::Bone;
using volume::BrickIndex;

namespace {

// A point of a surface; p_grid, lengths in voxels.
struct Point {
  Vec3 p, out;  // out: unit, out of the bone
  double area = 0;
};

struct Box {
  Vec3 lo = Vec3::Constant(-std::numeric_limits<double>::infinity()), hi = -lo;
};

// The crossings of voxel edges with the surface, inside the box.
std::vector<Point> points_of(const Bone& bone, const Box& box) {
  std::vector<Point> points;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    if (bone.brick_field(brick) == nullptr) continue;
    const Ijk first = bone.brick_ijk(brick);
    const Vec3 corner = first.cast<double>();
    if ((corner.array() > box.hi.array()).any() || ((corner.array() + 9) < box.lo.array()).any())
      continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const Ijk at = first + Ijk(v & 7, v >> 3 & 7, v >> 6);
      const int here = bone.field(at.x(), at.y(), at.z());
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          if (here < volume::kIso) continue;  // from inside out: each crossing once
          Ijk next = at;
          next[axis] += side;
          const int there = bone.field(next.x(), next.y(), next.z());
          if (there >= volume::kIso) continue;
          Point point;
          point.p = at.cast<double>();
          point.p[axis] += side * (static_cast<double>(here - volume::kIso) / (here - there));
          if ((point.p.array() < box.lo.array()).any() || (point.p.array() > box.hi.array()).any())
            continue;
          const Vec3 slope = volume::gradient(bone, point.p);
          if (!(slope.norm() > 0)) continue;
          point.out = -slope.normalized();
          point.area = std::abs(point.out[axis]);
          points.push_back(point);
        }
    }
  }
  return points;
}

// Along `out` to the other bone that looks back; below 0: inside it. In voxels.
std::optional<double> gap_at(const Point& point, const Bone& other, double reach) {
  constexpr double kStep = 0.25, kLooksBack = -0.5;
  const auto share = [&](double t) {
    return volume::sample(other, point.p + t * point.out) - volume::kIsoShare;
  };
  double before = share(0);
  const double way = before >= 0 ? -kStep : kStep;  // out of an overlap, or to the other side
  for (double t = way; std::abs(t) <= reach; t += way) {
    const double now = share(t);
    if ((before >= 0) != (now >= 0)) {
      const double at = t - way * (now / (now - before));
      const Vec3 slope = volume::gradient(other, point.p + at * point.out);
      if (!(slope.norm() > 0) || -slope.normalized().dot(point.out) > kLooksBack)
        return std::nullopt;
      return at;
    }
    before = now;
  }
  return std::nullopt;
}

// Value that `share` of the weights lie below.
double share_below(std::vector<std::pair<double, double>>& values, double share) {
  std::sort(values.begin(), values.end());
  double whole = 0, sum = 0;
  for (const auto& [value, weight] : values) whole += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= share * whole) return value;
  return values.empty() ? 0 : values.back().first;
}

double mean_of(const std::vector<std::pair<double, double>>& values) {
  double whole = 0, sum = 0;
  for (const auto& [value, weight] : values) {
    whole += weight;
    sum += weight * value;
  }
  return whole > 0 ? sum / whole : 0;
}

// Points by the cell of a coarse lattice.
class Cells {
 public:
  explicit Cells(double edge) : edge_(edge) {}
  void add(const Point& point) { cells_[key(cell_of(point.p))].push_back(point); }
  template <class See>
  void around(const Vec3& p, const See& see) const {
    const Ijk middle = cell_of(p);
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const auto found = cells_.find(key(middle + Ijk(i, j, k)));
          if (found == cells_.end()) continue;
          for (const Point& point : found->second) see(point);
        }
  }

 private:
  [[nodiscard]] Ijk cell_of(const Vec3& p) const {
    return {static_cast<int>(std::floor(p.x() / edge_)),
            static_cast<int>(std::floor(p.y() / edge_)),
            static_cast<int>(std::floor(p.z() / edge_))};
  }
  static std::uint64_t key(const Ijk& cell) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    const auto part = [](int n) { return static_cast<std::uint64_t>(std::int64_t{n}) & kMask; };
    return part(cell.x()) | part(cell.y()) << 21 | part(cell.z()) << 42;
  }
  double edge_;
  std::unordered_map<std::uint64_t, std::vector<Point>> cells_;
};

}  // namespace

PieceFit piece_fit(const Bone& piece, const Bone& other) {
  const double h = piece.grid().voxel, reach = PieceFit::kReach / h, rim = PieceFit::kRim / h;
  PieceFit fit;
  const std::vector<Point> mine = points_of(piece, {});
  std::vector<Point> outer;
  std::vector<std::pair<double, double>> gaps;  // and areas
  Cells faces(rim);
  Box box;
  box.lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  box.hi = -box.lo;
  for (const Point& point : mine) {
    box.lo = box.lo.cwiseMin(point.p);
    box.hi = box.hi.cwiseMax(point.p);
    const std::optional<double> gap = gap_at(point, other, reach);
    if (!gap) {
      outer.push_back(point);
      continue;
    }
    gaps.emplace_back(*gap, point.area);
    faces.add(point);
    fit.facing += point.area * h * h;
    if (*gap <= 1) fit.contact += point.area * h * h;
  }
  if (gaps.empty()) return fit;
  fit.gap = mean_of(gaps) * h;
  fit.gap_most = share_below(gaps, 0.95) * h;
  fit.gap_least = share_below(gaps, 0.05) * h;

  // the outer surface of the other bone beside the piece, where it does not face the piece
  const double wide = std::max(0.0, fit.gap_most / h) + 2 * rim;
  box.lo -= Vec3::Constant(wide);
  box.hi += Vec3::Constant(wide);
  Cells others(wide);
  for (const Point& point : points_of(other, box))
    if (!gap_at(point, piece, reach)) others.add(point);
  std::vector<std::pair<double, double>> steps;
  constexpr double kAlike = 0.9;  // cosine between the normals of the two
  constexpr double kLeans = 0.3;  // cosine between a normal and that of the cut
  for (const Point& point : outer) {
    Vec3 cut = Vec3::Zero();
    faces.around(point.p, [&](const Point& face) {
      if ((face.p - point.p).squaredNorm() < rim * rim) cut += face.area * face.out;
    });
    if (!(cut.norm() > 0)) continue;
    cut.normalize();
    if (std::abs(point.out.dot(cut)) > kLeans) continue;
    double least = wide * wide;
    const Point* nearest = nullptr;
    others.around(point.p, [&](const Point& one) {
      const double far = (one.p - point.p).squaredNorm();
      if (far >= least || one.out.dot(point.out) < kAlike || std::abs(one.out.dot(cut)) > kLeans)
        return;
      least = far;
      nearest = &one;
    });
    if (nearest == nullptr) continue;
    const Vec3 both = nearest->out + point.out, normal = (both - both.dot(cut) * cut).normalized();
    steps.emplace_back(std::abs(normal.dot(nearest->p - point.p)), point.area);
  }
  fit.has_step = !steps.empty();
  fit.step = mean_of(steps) * h;
  fit.step_most = share_below(steps, 0.95) * h;
  return fit;
}

}  // namespace burr::metrics
