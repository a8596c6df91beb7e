#include "burr/volume/pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "burr/volume/sample.h"

namespace burr::volume {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

// floor as int, clamped to [lo, hi]; NaN becomes lo
int whole(double x, int lo, int hi) noexcept {
  const double f = std::floor(x);
  return !(f > lo) ? lo : f < hi ? static_cast<int>(f) : hi;
}

// The first t in [0, end] where a + b t + c t^2 + d t^3 becomes >= 0: the cubic along a ray in a
// trilinear cell. Splits where the slope is zero, so that each piece is monotonic, then bisects.
std::optional<double> first_crossing(double a, double b, double c, double d, double end) noexcept {
  const auto value = [&](double t) { return a + t * (b + t * (c + t * d)); };
  double knots[4] = {0, end, end, end};
  int count = 1;
  const double disc = c * c - 3 * d * b;
  if (disc > 0) {
    // numerically stable roots of 3 d t^2 + 2 c t + b
    const double q = -(c + std::copysign(std::sqrt(disc), c));
    double t1 = q / (3 * d), t2 = b / q;
    if (t1 > t2) std::swap(t1, t2);
    if (t1 > 0 && t1 < end) knots[count++] = t1;
    if (t2 > 0 && t2 < end && t2 > knots[count - 1]) knots[count++] = t2;
  }
  knots[count++] = end;
  if (value(0) >= 0) return 0.0;
  for (int n = 1; n < count; ++n) {
    double lo = knots[n - 1], hi = knots[n];
    if (!(value(hi) >= 0)) continue;
    for (int halving = 0; halving < 60 && hi - lo > 1e-14 * (1 + hi); ++halving) {
      const double middle = 0.5 * (lo + hi);
      (value(middle) >= 0 ? hi : lo) = middle;
    }
    return hi;
  }
  return std::nullopt;
}

}  // namespace

Pyramid::Pyramid(const Bone& bone) : bone_(bone) {
  math::Ijk size = bone.bricks();
  for (;;) {
    levels_.push_back({size, std::vector<Range>(static_cast<std::size_t>(size.x()) *
                                                static_cast<std::size_t>(size.y()) *
                                                static_cast<std::size_t>(size.z()))});
    if (size.maxCoeff() == 1) break;
    size = (size.array() + 1) / 2;
  }
  for (BrickIndex b = 0; b < bone.brick_count(); ++b)
    levels_[0].nodes[static_cast<std::size_t>(b)] = brick_range(b);
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    std::size_t n = 0;
    const math::Ijk& nodes = levels_[level].size;
    for (int k = 0; k < nodes.z(); ++k)
      for (int j = 0; j < nodes.y(); ++j)
        for (int i = 0; i < nodes.x(); ++i) levels_[level].nodes[n++] = of_children(level, i, j, k);
  }
}

// outside the grid is air
Pyramid::Range Pyramid::node(std::size_t level, int i, int j, int k) const BURR_RT {
  const Level& nodes = levels_[level];
  if (i < 0 || j < 0 || k < 0 || i >= nodes.size.x() || j >= nodes.size.y() || k >= nodes.size.z())
    return {};
  return nodes.nodes[static_cast<std::size_t>(i + nodes.size.x() * (j + nodes.size.y() * k))];
}

Pyramid::Range Pyramid::brick_range(BrickIndex brick) const BURR_RT {
  const Field* field = bone_.brick_field(brick);
  if (field == nullptr) return {};
  Field lowest = kSolid, highest = 0;
  for (int v = 0; v < kBrickVoxels; ++v) {
    lowest = field[v] < lowest ? field[v] : lowest;
    highest = field[v] > highest ? field[v] : highest;
  }
  return {lowest, highest};
}

Pyramid::Range Pyramid::of_children(std::size_t level, int i, int j, int k) const BURR_RT {
  Range sum{kSolid, 0};
  for (int c = 0; c < 8; ++c) {
    const Range child = node(level - 1, 2 * i + (c & 1), 2 * j + ((c >> 1) & 1), 2 * k + (c >> 2));
    sum.lowest = std::min(sum.lowest, child.lowest);
    sum.highest = std::max(sum.highest, child.highest);
  }
  return sum;
}

void Pyramid::update(BrickIndex brick) BURR_RT {
  Range now = brick_range(brick);
  math::Ijk at = bone_.brick_ijk(brick) / kBrickEdge;
  for (std::size_t level = 0;;) {
    Level& nodes = levels_[level];
    Range& kept = nodes.nodes[static_cast<std::size_t>(
        at.x() + nodes.size.x() * (at.y() + nodes.size.y() * at.z()))];
    if (kept.lowest == now.lowest && kept.highest == now.highest) return;  // no change further up
    kept = now;
    if (++level == levels_.size()) return;
    at /= 2;
    now = of_children(level, at.x(), at.y(), at.z());
  }
}

// Adds the ranges of the bricks first .. last, from this node down.
void Pyramid::gather(const math::Ijk& first, const math::Ijk& last, std::size_t level,
                     const math::Ijk& at, Range& sum) const BURR_RT {
  const Range here = node(level, at.x(), at.y(), at.z());
  if (here.lowest >= sum.lowest && here.highest <= sum.highest) return;  // adds nothing
  const int shift = static_cast<int>(level);
  bool within = true;
  for (int a = 0; a < 3; ++a) {
    const int from = at[a] << shift, to = from + (1 << shift) - 1;
    if (to < first[a] || from > last[a]) return;
    within = within && from >= first[a] && to <= last[a];
  }
  if (within || level == 0) {
    sum.lowest = std::min(sum.lowest, here.lowest);
    sum.highest = std::max(sum.highest, here.highest);
    return;
  }
  for (int c = 0; c < 8; ++c) {
    const math::Ijk child = 2 * at + math::Ijk(c & 1, (c >> 1) & 1, c >> 2);
    if ((child.array() < levels_[level - 1].size.array()).all())
      gather(first, last, level - 1, child, sum);
  }
}

Pyramid::Range Pyramid::range_in(const math::Aabb& box_grid) const BURR_RT {
  if (box_grid.empty()) return {};
  Range sum{kSolid, 0};
  math::Ijk first, last;
  bool inside = true;
  for (int a = 0; a < 3; ++a) {
    const int end = bone_.grid().size[a];
    const int lo = whole(box_grid.lo[a], -2, end + 1);
    // the cell that contains `hi` ends at the next voxel
    const int hi = whole(box_grid.hi[a], -2, end + 1) + 1;
    if (hi < 0 || lo >= end) return {};
    inside = inside && lo >= 0 && hi < end;
    first[a] = std::max(lo, 0) / kBrickEdge;
    last[a] = std::min(hi, end - 1) / kBrickEdge;
  }
  if (!inside) sum.lowest = 0;  // the box reaches into the air around the grid
  gather(first, last, levels_.size() - 1, math::Ijk::Zero(), sum);
  return sum;
}

bool Pyramid::surface_in(const math::Aabb& box_grid) const BURR_RT {
  const Range range = range_in(box_grid);
  return range.lowest < kIso && range.highest >= kIso;
}

bool Pyramid::material_in(const math::Aabb& box_grid) const BURR_RT {
  return range_in(box_grid).highest > 0;
}

std::optional<double> Pyramid::first_hit(const math::Vec3& origin_grid, const math::Vec3& direction,
                                         double length) const BURR_RT {
  if (!origin_grid.allFinite() || !direction.allFinite() || !(length >= 0)) return std::nullopt;

  // the part of the ray on which a cell can contain a voxel of the grid: -1 .. size
  double t = 0, end = length;
  for (int a = 0; a < 3; ++a) {
    const double lo = -1, hi = bone_.grid().size[a];
    if (direction[a] == 0) {
      if (origin_grid[a] < lo || origin_grid[a] > hi) return std::nullopt;
      continue;
    }
    const double t1 = (lo - origin_grid[a]) / direction[a];
    const double t2 = (hi - origin_grid[a]) / direction[a];
    t = std::max(t, std::min(t1, t2));
    end = std::min(end, std::max(t1, t2));
  }

  // each round leaves at least one cell or node; the bound guards against rounding at corners
  const int rounds = 8 * (bone_.grid().size.sum() + 16);
  for (int round = 0; round < rounds && t <= end; ++round) {
    // the cell just ahead, so that a ray along a face makes progress
    const math::Vec3 ahead = origin_grid + (t + 1e-9) * direction;
    math::Ijk cell;
    for (int a = 0; a < 3; ++a) cell[a] = whole(ahead[a], -1, bone_.grid().size[a] - 1);

    // the largest node around it whose cells hold no bone: its own voxels and the first ones of the
    // next nodes
    int lo_shift = -1;
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      const int shift = 3 + static_cast<int>(level);
      Field highest = 0;
      for (int c = 0; c < 8; ++c)
        highest = std::max(
            highest, node(level, (cell.x() >> shift) + (c & 1),
                          (cell.y() >> shift) + ((c >> 1) & 1), (cell.z() >> shift) + (c >> 2))
                         .highest);
      if (highest >= kIso) break;
      lo_shift = shift;
    }

    // where the ray leaves that node, or the single cell
    const int shift = std::max(lo_shift, 0);
    double leave = kForever;
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0) continue;
      const int first = (cell[a] >> shift) << shift;
      const double face = direction[a] > 0 ? first + (1 << shift) : first;
      leave = std::min(leave, (face - origin_grid[a]) / direction[a]);
    }
    leave = std::max(leave, t + 1e-9);

    if (lo_shift < 0) {
      // the trilinear field along the ray is a cubic in t; four values determine it
      const double stop = std::min(leave, end), step = (stop - t) / 3;
      double f[4];
      for (int n = 0; n < 4; ++n) {
        // stay inside this cell in spite of rounding
        math::Vec3 p = origin_grid + (t + n * step) * direction;
        double v[8];
        for (int c = 0; c < 8; ++c)
          v[c] = bone_.field(cell.x() + (c & 1), cell.y() + ((c >> 1) & 1), cell.z() + (c >> 2));
        p -= cell.cast<double>();
        const double x00 = v[0] + p.x() * (v[1] - v[0]), x10 = v[2] + p.x() * (v[3] - v[2]);
        const double x01 = v[4] + p.x() * (v[5] - v[4]), x11 = v[6] + p.x() * (v[7] - v[6]);
        const double y0 = x00 + p.y() * (x10 - x00), y1 = x01 + p.y() * (x11 - x01);
        f[n] = y0 + p.z() * (y1 - y0) - kIso;
      }
      if (f[0] >= 0) return t;
      // Newton's forward differences, as powers of s = (t' - t) / step
      const double d1 = f[1] - f[0], d2 = f[2] - 2 * f[1] + f[0],
                   d3 = f[3] - 3 * f[2] + 3 * f[1] - f[0];
      const auto s = first_crossing(f[0], d1 - d2 / 2 + d3 / 3, d2 / 2 - d3 / 2, d3 / 6, 3.0);
      if (s) return t + *s * step;
    }
    t = leave;
  }
  return std::nullopt;
}

}  // namespace burr::volume
