#include "burr/render/thin_patch.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>

namespace burr::render {
namespace {

using math::Vec3;

constexpr double kWorth = 0.9;  // of the level before: more triangles than this save too little
constexpr double kFlip = 0.2;   // least cosine between a triangle's normals before and after

// Sum of squared distances from planes, weighted by area.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0, weight = 0;

  void add(const Vec3& n, double d, double w) {
    a += w * n * n.transpose();
    b += w * d * n;
    c += w * d * d;
    weight += w;
  }
  void add(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    weight += other.weight;
  }
  // mean square
  [[nodiscard]] double at(const Vec3& p) const {
    return weight > 0 ? std::max(0.0, (p.dot(a * p) + 2 * b.dot(p) + c) / weight) : 0;
  }
};

struct Collapse {
  double cost = 0;
  std::uint32_t from = 0, to = 0;
};

class Thinning {
 public:
  Thinning(std::span<const SkinVertex> vertices, std::vector<std::uint32_t> triangles);
  // Collapses until the error is reached.
  void thin(double error);
  [[nodiscard]] const std::vector<std::uint32_t>& triangles() const { return triangles_; }

 private:
  void find_neighbours();
  void lock_borders(std::span<const SkinVertex> vertices);
  [[nodiscard]] std::vector<Collapse> candidates(double most) const;
  [[nodiscard]] bool good(const Collapse& collapse) const;
  [[nodiscard]] bool one_pass(double most);
  template <class Visit>
  void around(std::uint32_t vertex, const Visit& visit) const {
    for (std::uint32_t n = first_[vertex]; n < first_[vertex + 1]; ++n)
      visit(&triangles_[std::size_t{3} * of_[n]]);
  }

  std::vector<std::uint32_t> triangles_;
  std::vector<Vec3> p_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint8_t> locked_;
  std::vector<std::uint32_t> first_, of_;  // the triangles of each vertex
};

Thinning::Thinning(std::span<const SkinVertex> vertices, std::vector<std::uint32_t> triangles)
    : triangles_(std::move(triangles)) {
  const math::Vec3f origin = vertices.empty() ? math::Vec3f::Zero().eval() : vertices.front().p;
  p_.reserve(vertices.size());
  // from the first vertex on: squares of large numbers would leave few digits
  for (const SkinVertex& vertex : vertices) p_.push_back((vertex.p - origin).cast<double>());
  quadrics_.resize(p_.size());
  locked_.resize(p_.size());
  for (std::size_t t = 0; t + 2 < triangles_.size(); t += 3) {
    const Vec3& a = p_[triangles_[t]];
    const Vec3 n = (p_[triangles_[t + 1]] - a).cross(p_[triangles_[t + 2]] - a);
    const double twice = n.norm();
    if (twice <= 0) continue;
    const Vec3 unit = n / twice;
    for (std::size_t c = 0; c < 3; ++c) quadrics_[triangles_[t + c]].add(unit, -unit.dot(a), twice);
  }
  find_neighbours();
  lock_borders(vertices);
}

void Thinning::find_neighbours() {
  first_.assign(p_.size() + 1, 0);
  for (const std::uint32_t v : triangles_) ++first_[v + 1];
  for (std::size_t v = 0; v < p_.size(); ++v) first_[v + 1] += first_[v];
  of_.resize(triangles_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t n = 0; n < triangles_.size(); ++n)
    of_[next[triangles_[n]]++] = static_cast<std::uint32_t>(n / 3);
}

// An edge that has not two triangles, or one that goes from one tissue to another.
void Thinning::lock_borders(std::span<const SkinVertex> vertices) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(triangles_.size());
  for (std::size_t t = 0; t + 2 < triangles_.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles_[t + c], b = triangles_[t + (c + 1) % 3];
      if (tissue_of(vertices[a]) != tissue_of(vertices[b])) locked_[a] = locked_[b] = 1;
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t n = 0; n < edges.size();) {
    std::size_t end = n + 1;
    while (end < edges.size() && edges[end] == edges[n]) ++end;
    if (end - n != 2) locked_[edges[n].first] = locked_[edges[n].second] = 1;
    n = end;
  }
}

std::vector<Collapse> Thinning::candidates(double most) const {
  std::vector<Collapse> all;
  for (std::size_t t = 0; t + 2 < triangles_.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles_[t + c], b = triangles_[t + (c + 1) % 3];
      if (locked_[a] != 0) continue;  // each edge comes in both directions, from its two triangles
      Quadric both = quadrics_[a];
      both.add(quadrics_[b]);
      const double cost = both.at(p_[b]);
      if (cost <= most) all.push_back({cost, a, b});
    }
  std::sort(all.begin(), all.end(), [](const Collapse& x, const Collapse& y) {
    return std::tie(x.cost, x.from, x.to) < std::tie(y.cost, y.from, y.to);
  });
  return all;
}

// The surface stays one without folds: the two ends have just two neighbours in common, and no triangle
// turns round.
bool Thinning::good(const Collapse& collapse) const {
  int common = 0;
  bool turned = false;
  std::array<std::uint32_t, 64> near{};
  std::size_t count = 0;
  around(collapse.to, [&](const std::uint32_t* t) {
    for (int c = 0; c < 3; ++c)
      if (t[c] != collapse.to && count < near.size()) near[count++] = t[c];
  });
  if (count == near.size()) return false;
  std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
  const auto end = std::unique(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
  std::array<std::uint32_t, 64> seen{};
  std::size_t seen_count = 0;
  around(collapse.from, [&](const std::uint32_t* t) {
    bool goes = false;
    std::array<Vec3, 3> before, after;
    for (std::size_t c = 0; c < 3; ++c) {
      before[c] = p_[t[c]];
      after[c] = t[c] == collapse.from ? p_[collapse.to] : before[c];
      goes = goes || t[c] == collapse.to;
      if (t[c] == collapse.from || seen_count == seen.size()) continue;
      if (std::find(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(seen_count), t[c]) !=
          seen.begin() + static_cast<std::ptrdiff_t>(seen_count))
        continue;
      seen[seen_count++] = t[c];
      if (std::binary_search(near.begin(), end, t[c])) ++common;
    }
    if (goes) return;
    const Vec3 n = (before[1] - before[0]).cross(before[2] - before[0]),
               m = (after[1] - after[0]).cross(after[2] - after[0]);
    turned = turned || n.dot(m) <= kFlip * n.norm() * m.norm();
  });
  return common == 2 && !turned && seen_count < seen.size();
}

// Collapses that do not touch each other, cheapest first. False: there was none.
bool Thinning::one_pass(double most) {
  std::vector<std::uint8_t> taken(p_.size());
  std::vector<std::uint32_t> to(p_.size());
  for (std::uint32_t v = 0; v < to.size(); ++v) to[v] = v;
  bool any = false;
  for (const Collapse& one : candidates(most)) {
    if (taken[one.from] != 0 || taken[one.to] != 0 || !good(one)) continue;
    any = true;
    to[one.from] = one.to;
    quadrics_[one.to].add(quadrics_[one.from]);
    around(one.from, [&](const std::uint32_t* t) { taken[t[0]] = taken[t[1]] = taken[t[2]] = 1; });
  }
  if (!any) return false;
  std::size_t kept = 0;
  for (std::size_t t = 0; t + 2 < triangles_.size(); t += 3) {
    const std::uint32_t a = to[triangles_[t]], b = to[triangles_[t + 1]], c = to[triangles_[t + 2]];
    if (a == b || b == c || c == a) continue;
    triangles_[kept++] = a;
    triangles_[kept++] = b;
    triangles_[kept++] = c;
  }
  triangles_.resize(kept);
  find_neighbours();
  return true;
}

void Thinning::thin(double error) {
  while (one_pass(error * error)) {
  }
}

}  // namespace

std::vector<CoarseLevel> thinned(std::span<const SkinVertex> vertices,
                                 std::vector<std::uint32_t> triangles,
                                 std::span<const double> errors) {
  std::vector<CoarseLevel> levels;
  if (triangles.empty()) return levels;
  std::size_t before = triangles.size();
  Thinning thinning(vertices, std::move(triangles));
  for (const double error : errors) {
    thinning.thin(error);
    const std::size_t now = thinning.triangles().size();
    if (static_cast<double>(now) > kWorth * static_cast<double>(before)) continue;
    levels.push_back({error, thinning.triangles()});
    before = now;
  }
  return levels;
}

std::vector<CoarseLevel> thinned(const SkinMesh& mesh, std::span<const double> errors) {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(mesh.index_count());
  for (std::size_t n = 0; n < mesh.index_count(); ++n) triangles.push_back(mesh.index(n));
  return thinned(mesh.vertices(), std::move(triangles), errors);
}

}  // namespace burr::render
