#include "burr/surface/shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace burr::surface {
namespace {

using math::Vec3;

struct Shell {
  double volume = 0;           // below 0: a cavity  [m^3]
  std::size_t a_triangle = 0;  // one of its triangles
};

struct Sorted {
  std::vector<std::uint32_t> of_vertex;  // shell of each vertex that has a triangle
  std::vector<Shell> shells;
  [[nodiscard]] std::optional<std::uint32_t> largest() const {
    const auto at =
        std::max_element(shells.begin(), shells.end(),
                         [](const Shell& a, const Shell& b) { return a.volume < b.volume; });
    if (at == shells.end() || at->volume <= 0) return std::nullopt;
    return static_cast<std::uint32_t>(at - shells.begin());
  }
};

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) {
    parent[v] = parent[parent[v]];
    v = parent[v];
  }
  return v;
}

Vec3 corner(const Mesh& mesh, std::size_t triangle, std::size_t c) {
  return mesh.vertices[mesh.triangles[3 * triangle + c]].p.cast<double>();
}

Sorted sort(const Mesh& mesh) {
  Sorted out;
  const std::size_t triangles = mesh.triangles.size() / 3;
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t c = 1; c < 3; ++c) {
      const std::uint32_t a = root(parent, mesh.triangles[3 * t]),
                          b = root(parent, mesh.triangles[3 * t + c]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  out.of_vertex.assign(parent.size(), kNone);
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::uint32_t top = root(parent, mesh.triangles[3 * t]);
    if (out.of_vertex[top] == kNone) {
      out.of_vertex[top] = static_cast<std::uint32_t>(out.shells.size());
      out.shells.push_back({0, t});
    }
    const std::uint32_t shell = out.of_vertex[top];
    for (std::size_t c = 0; c < 3; ++c) out.of_vertex[mesh.triangles[3 * t + c]] = shell;
    // from a point of the shell, where little is lost to rounding
    Shell& one = out.shells[shell];
    const Vec3 about = corner(mesh, one.a_triangle, 0), a = corner(mesh, t, 0) - about,
               b = corner(mesh, t, 1) - about, c = corner(mesh, t, 2) - about;
    one.volume += a.dot(b.cross(c)) / 6;
  }
  return out;
}

// One point on each cavity's wall, and the parts that a ray from it along x leaves more often than
// it enters.
struct Inquiry {
  std::uint32_t shell = 0;
  Vec3 at = Vec3::Zero();
  std::vector<std::uint32_t> met;  // a part for each crossing
};

// The points by rows of equal z, so that each triangle finds those at its height.
struct Rows {
  double low = 0, high = 0;
  std::vector<std::vector<std::size_t>> rows = std::vector<std::vector<std::size_t>>(4096);
  [[nodiscard]] std::size_t row_of(double z) const {
    const double share = (z - low) / std::max(high - low, 1e-30);
    return static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) *
                                    static_cast<double>(rows.size() - 1));
  }
};

// x at which the line through (y, z) along x crosses the triangle.
std::optional<double> crossing(const std::array<Vec3, 3>& p, const Vec3& at) {
  const auto side = [&](const Vec3& a, const Vec3& b) {
    return (b.y() - a.y()) * (at.z() - a.z()) - (b.z() - a.z()) * (at.y() - a.y());
  };
  const double a = side(p[1], p[2]), b = side(p[2], p[0]), c = side(p[0], p[1]);
  const bool in = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
  if (!in) return std::nullopt;
  return (a * p[0].x() + b * p[1].x() + c * p[2].x()) / (a + b + c);
}

void cast_rays(const Mesh& mesh, const Sorted& sorted, std::vector<Inquiry>& asked) {
  Rows rows;
  rows.low = std::numeric_limits<double>::infinity();
  rows.high = -rows.low;
  for (const Inquiry& one : asked) {
    rows.low = std::min(rows.low, one.at.z());
    rows.high = std::max(rows.high, one.at.z());
  }
  for (std::size_t n = 0; n < asked.size(); ++n)
    rows.rows[rows.row_of(asked[n].at.z())].push_back(n);
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    const std::uint32_t shell = sorted.of_vertex[mesh.triangles[3 * t]];
    if (sorted.shells[shell].volume <= 0) continue;
    const std::array<Vec3, 3> p = {corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2)};
    const auto [low, high] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
    if (high < rows.low || low > rows.high) continue;
    for (std::size_t row = rows.row_of(low); row <= rows.row_of(high); ++row)
      for (const std::size_t n : rows.rows[row]) {
        const auto x = crossing(p, asked[n].at);
        if (x && *x > asked[n].at.x()) asked[n].met.push_back(shell);
      }
  }
}

// The smallest part around the point: a shell that is crossed an odd number of times.
std::optional<std::uint32_t> part_around(const Sorted& sorted, Inquiry& one) {
  std::optional<std::uint32_t> smallest;
  std::sort(one.met.begin(), one.met.end());
  for (auto at = one.met.begin(); at != one.met.end();) {
    const auto next = std::upper_bound(at, one.met.end(), *at);
    if ((next - at) % 2 == 1 &&
        (!smallest || sorted.shells[*at].volume < sorted.shells[*smallest].volume))
      smallest = *at;
    at = next;
  }
  return smallest;
}

// The triangles of these shells.
Mesh shells_from(const Mesh& mesh, const Sorted& sorted, const std::vector<bool>& kept) {
  Mesh out;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> moved(mesh.vertices.size(), kNone);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const std::uint32_t v = mesh.triangles[n];
    if (!kept[sorted.of_vertex[v]]) continue;
    if (moved[v] == kNone) {
      moved[v] = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(mesh.vertices[v]);
    }
    out.triangles.push_back(moved[v]);
  }
  return out;
}

}  // namespace

Shells shells_of(const Mesh& mesh) {
  Shells out;
  for (const Shell& shell : sort(mesh).shells) {
    out.volume += shell.volume;
    if (shell.volume <= 0) {
      ++out.cavities;
      continue;
    }
    ++out.parts;
    if (shell.volume < kIsland) ++out.islands;
    out.largest = std::max(out.largest, shell.volume);
  }
  return out;
}

Mesh largest_part(const Mesh& mesh) {
  const Sorted sorted = sort(mesh);
  const auto largest = sorted.largest();
  if (!largest) return mesh;
  std::vector<Inquiry> asked;
  for (std::uint32_t n = 0; n < sorted.shells.size(); ++n) {
    if (sorted.shells[n].volume > 0) continue;
    const std::size_t t = sorted.shells[n].a_triangle;
    // no corner and no middle, so that the ray meets no edge
    asked.push_back(
        {n, 0.41 * corner(mesh, t, 0) + 0.33 * corner(mesh, t, 1) + 0.26 * corner(mesh, t, 2), {}});
  }
  if (!asked.empty()) cast_rays(mesh, sorted, asked);
  std::vector<bool> kept(sorted.shells.size());
  kept[*largest] = true;
  for (Inquiry& one : asked) kept[one.shell] = part_around(sorted, one) == largest;

  return shells_from(mesh, sorted, kept);
}

Mesh without_crumbs(const Mesh& mesh, double least, LeftOut& left_out) {
  const Sorted sorted = sort(mesh);
  std::vector<bool> kept(sorted.shells.size());
  left_out = {};
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const double volume = sorted.shells[n].volume;
    kept[n] = std::abs(volume) >= least;  // a cavity of a crumb is smaller still
    if (kept[n]) continue;
    left_out.volume += volume;
    if (volume > 0) ++left_out.parts;
  }
  return left_out.parts > 0 ? shells_from(mesh, sorted, kept) : mesh;
}

}  // namespace burr::surface
