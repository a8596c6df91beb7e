#include "burr/tool/grid_of_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace burr::tool {
namespace {

using math::Vec3;

constexpr int kMargin = 3;          // cells around the body
constexpr double kCellsAlong = 64;  // of the longest side, if nobody says
constexpr double kInf = std::numeric_limits<double>::infinity();

// Nearest place of a triangle (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
Vec3 nearest_on(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return t[0];
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return t[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return t[0] + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return t[0] + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4, along = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 >= d3 && d5 >= d6 && along > 0) return t[1] + (d4 - d3) / along * (t[2] - t[1]);
  const double all = va + vb + vc;
  if (!(all > 0)) return t[0];  // no area
  return t[0] + vb / all * ab + vc / all * ac;
}

Status check_closed(const Triangles& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& face : mesh.faces)
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t a = face[n], b = face[(n + 1) % 3];
      if (a >= mesh.points.size()) return error("names a point that it does not have");
      if (a < b)
        ++edges[{a, b}];
      else
        --edges[{b, a}];
    }
  const auto open =
      std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; });
  if (open == 0) return fine();
  return error("has " + std::to_string(open) +
               " open edges; close its holes with another program (MeshLab, Blender) and make its "
               "faces look one way");
}

class Maker {
 public:
  Maker(const Triangles& mesh, const Vec3& first, double cell, const std::array<int, 3>& size)
      : mesh_(mesh), first_(first), cell_(cell), size_(size) {
    const std::size_t nodes = place(0, 0, size[2]);
    distance_.assign(nodes, kInf);
    nearest_.assign(nodes, kNone);
    inside_.assign(nodes, 0);
  }

  // Of all nodes: how often the surface is wound round them.
  [[nodiscard]] int least() const { return least_; }
  [[nodiscard]] int most() const { return most_; }

  bool make(MeshGrid& out) {
    for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face) splat(face);
    for (int pass = 0; pass < 2; ++pass)
      for (int way = 0; way < 8; ++way) sweep(way);
    if (!find_inside()) return false;
    out.cells.size = size_;
    for (std::size_t n = 0; n < distance_.size(); ++n) {
      const double cells = (inside_[n] != 0 ? -1 : 1) * distance_[n] / cell_;
      out.cells.phi.push_back(
          static_cast<std::int16_t>(std::lround(std::clamp(cells * kPerCell, -32767.0, 32767.0))));
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  [[nodiscard]] std::size_t place(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::array<Vec3, 3> triangle(std::uint32_t face) const {
    const auto& of = mesh_.faces[face];
    return {mesh_.points[of[0]], mesh_.points[of[1]], mesh_.points[of[2]]};
  }
  void look(int x, int y, int z, std::uint32_t face) {
    const Vec3 p = first_ + cell_ * Vec3(x, y, z);
    const double far = (nearest_on(triangle(face), p) - p).norm();
    const std::size_t at = place(x, y, z);
    if (far >= distance_[at]) return;
    distance_[at] = far;
    nearest_[at] = face;
  }

  // The nodes within two cells of a triangle.
  void splat(std::uint32_t face) {
    const auto corners = triangle(face);
    std::array<int, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const double least = std::min({corners[0][axis], corners[1][axis], corners[2][axis]}),
                   most = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
      const auto at = static_cast<std::size_t>(axis);
      low[at] = std::max(0, static_cast<int>(std::floor((least - first_[axis]) / cell_)) - 2);
      high[at] =
          std::min(size_[at] - 1, static_cast<int>(std::ceil((most - first_[axis]) / cell_)) + 2);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) look(x, y, z, face);
  }

  // Every node tries the triangles that its neighbours behind it found; `way`: a bit for each axis.
  void sweep(int way) {
    const auto from = [&](int axis, int n) {
      return ((way >> axis) & 1) != 0 ? size_[static_cast<std::size_t>(axis)] - 1 - n : n;
    };
    const int sx = (way & 1) != 0 ? 1 : -1, sy = (way & 2) != 0 ? 1 : -1,
              sz = (way & 4) != 0 ? 1 : -1;
    for (int k = 0; k < size_[2]; ++k)
      for (int j = 0; j < size_[1]; ++j)
        for (int i = 0; i < size_[0]; ++i)
          for (int step = 1; step < 8; ++step) {
            const int x = from(0, i), y = from(1, j), z = from(2, k);
            const int nx = x + ((step & 1) != 0 ? sx : 0), ny = y + ((step & 2) != 0 ? sy : 0),
                      nz = z + ((step & 4) != 0 ? sz : 0);
            if (nx < 0 || ny < 0 || nz < 0 || nx >= size_[0] || ny >= size_[1] || nz >= size_[2])
              continue;
            const std::uint32_t face = nearest_[place(nx, ny, nz)];
            if (face != kNone && face != nearest_[place(x, y, z)]) look(x, y, z, face);
          }
  }

  // Rows along x, moved off the nodes a little so that none meets an edge. False: a row that goes in
  // does not come out.
  bool find_inside() {
    const double off_y = 1.7e-5 * cell_, off_z = 2.9e-5 * cell_;
    std::vector<std::vector<std::pair<double, int>>> rows(static_cast<std::size_t>(size_[1]) *
                                                          static_cast<std::size_t>(size_[2]));
    for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face) cross(face, off_y, off_z, rows);
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y) {
        auto& row = rows[static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
                         static_cast<std::size_t>(y)];
        std::sort(row.begin(), row.end());
        int wound = 0;
        std::size_t next = 0;
        for (int x = 0; x < size_[0]; ++x) {
          while (next < row.size() && row[next].first < first_.x() + cell_ * x)
            wound += row[next++].second;
          inside_[place(x, y, z)] = static_cast<char>(wound > 0);
          least_ = std::min(least_, wound);
          most_ = std::max(most_, wound);
        }
        if (wound != 0) return false;
      }
    return true;
  }

  void cross(std::uint32_t face, double off_y, double off_z,
             std::vector<std::vector<std::pair<double, int>>>& rows) const {
    const auto t = triangle(face);
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (n.x() == 0) return;  // lies along the rows
    const double least_y = std::min({t[0].y(), t[1].y(), t[2].y()}),
                 most_y = std::max({t[0].y(), t[1].y(), t[2].y()}),
                 least_z = std::min({t[0].z(), t[1].z(), t[2].z()}),
                 most_z = std::max({t[0].z(), t[1].z(), t[2].z()});
    const auto from = [&](double value, double first) {
      return static_cast<int>(std::floor((value - first) / cell_)) - 1;
    };
    for (int z = std::max(0, from(least_z, first_.z()));
         z <= std::min(size_[2] - 1, from(most_z, first_.z()) + 2); ++z)
      for (int y = std::max(0, from(least_y, first_.y()));
           y <= std::min(size_[1] - 1, from(most_y, first_.y()) + 2); ++y) {
        const double py = first_.y() + cell_ * y + off_y, pz = first_.z() + cell_ * z + off_z;
        int left = 0, right = 0;
        for (std::size_t e = 0; e < 3; ++e) {
          // from the lower numbered point to the other, so that both faces of an edge agree
          std::uint32_t a = mesh_.faces[face][e], b = mesh_.faces[face][(e + 1) % 3];
          const bool turned = a > b;
          if (turned) std::swap(a, b);
          const Vec3 &pa = mesh_.points[a], &pb = mesh_.points[b];
          const double side = (pb.y() - pa.y()) * (pz - pa.z()) - (pb.z() - pa.z()) * (py - pa.y());
          ((side > 0) != turned ? left : right) += 1;
        }
        if (left != 3 && right != 3) continue;
        const double x = t[0].x() - (n.y() * (py - t[0].y()) + n.z() * (pz - t[0].z())) / n.x();
        rows[static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
             static_cast<std::size_t>(y)]
            .emplace_back(x, n.x() < 0 ? 1 : -1);
      }
  }

  const Triangles& mesh_;
  Vec3 first_;
  double cell_;
  std::array<int, 3> size_;
  std::vector<double> distance_;
  std::vector<std::uint32_t> nearest_;
  std::vector<char> inside_;
  int least_ = 0, most_ = 0;
};

}  // namespace

double volume_inside(const Triangles& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces)
    sum += mesh.points[face[0]].dot(mesh.points[face[1]].cross(mesh.points[face[2]]));
  return sum / 6;
}

Result<MeshGrid> grid_of(const Triangles& mesh, double cell, bool turns) {
  if (mesh.faces.empty()) return error("has no triangles");
  for (const Vec3& p : mesh.points)
    if (!p.allFinite()) return error("has a point that is not a number");
  if (const Status closed = check_closed(mesh); !closed) return closed.error();
  Triangles outwards = mesh;
  const double volume = std::abs(volume_inside(mesh));
  if (volume_inside(mesh) < 0)
    for (auto& face : outwards.faces) std::swap(face[1], face[2]);
  Vec3 lo = Vec3::Constant(kInf), hi = Vec3::Constant(-kInf);
  for (const auto& face : mesh.faces)
    for (const std::uint32_t n : face) {
      lo = lo.cwiseMin(mesh.points[n]);
      hi = hi.cwiseMax(mesh.points[n]);
    }
  if (!(volume > 0) || !((hi - lo).minCoeff() > 0)) return error("holds no volume");
  for (int axis = 0; turns && axis < 2; ++axis) {
    hi[axis] = std::max(std::abs(lo[axis]), std::abs(hi[axis]));
    lo[axis] = -hi[axis];
  }

  MeshGrid out;
  const bool chosen = cell > 0;
  out.cell = chosen ? cell : (hi - lo).maxCoeff() / kCellsAlong;
  std::array<int, 3> size;
  const auto fits = [&] {
    double nodes = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = std::ceil((hi - lo)[axis] / out.cell) + 2 * kMargin + 1;
      if (along > 128 - kMargin) return false;  // a distance must fit its 16 bits
      size[static_cast<std::size_t>(axis)] = static_cast<int>(along);
      nodes *= along;
    }
    return nodes <= kMostNodes;
  };
  while (!fits()) {
    if (chosen) return error("takes too many cells of that size; make them larger");
    out.cell *= 1.05;
  }
  out.middle = 0.5 * (lo + hi);
  const Vec3 first = out.middle - 0.5 * out.cell * Vec3(size[0] - 1, size[1] - 1, size[2] - 1);
  Maker maker(outwards, first, out.cell, size);
  if (!maker.make(out)) return error("crosses itself in a way that leaves no inside");
  if (maker.most() > 1)
    return error("has parts that overlap; join them to one body with another program");
  if (maker.least() < 0)
    return error("has a part whose faces look inwards; turn them with another program");
  const ShapeGrid* kept = keep_grid(out.cells);
  if (kept == nullptr) return error("is thinner than a cell; give a smaller cell");
  const GridSurface surface = surface_of(*kept);
  Triangles found;
  found.points = surface.points;
  for (std::size_t n = 0; n + 2 < surface.triangles.size(); n += 3)
    found.faces.push_back(
        {surface.triangles[n], surface.triangles[n + 1], surface.triangles[n + 2]});
  out.volume = volume_inside(found) * out.cell * out.cell * out.cell;
  return out;
}

}  // namespace burr::tool
