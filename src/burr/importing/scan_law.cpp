#include "burr/importing/scan_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "burr/surface/cases.h"
#include "burr/surface/enclosed.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

// The scan's values, less the level; beyond its border nothing.
class Values {
 public:
  Values(const io::Scan& scan, double level)
      : scan_(scan), level_(static_cast<float>(level)), low_(std::numeric_limits<float>::max()) {
    for (const float value : scan.values)
      if (value != scan.outside) low_ = std::min(low_, value);
  }
  [[nodiscard]] bool contains(const Ijk& v) const {
    return v.minCoeff() >= 0 && (v.array() < scan_.size.array()).all();
  }
  [[nodiscard]] float at(const Ijk& v) const {
    const float value = scan_.values[static_cast<std::size_t>(v.x()) +
                                     static_cast<std::size_t>(scan_.size.x()) *
                                         (static_cast<std::size_t>(v.y()) +
                                          static_cast<std::size_t>(scan_.size.y()) *
                                              static_cast<std::size_t>(v.z()))];
    return (value == scan_.outside ? std::max(value, low_) : value) - level_;
  }
  [[nodiscard]] bool inside(const Ijk& v) const { return contains(v) && at(v) >= 0; }

 private:
  const io::Scan& scan_;
  float level_, low_;
};

// Six times the volume under the triangles of one cell, seen from `about`  [voxel of the scan]
double cell_volume(const Values& values, const Ijk& low, const Vec3& about) {
  std::array<double, 8> depth{};
  std::array<bool, 8> in_grid{};
  int solid = 0;
  for (int n = 0; n < 8; ++n) {
    const Ijk corner = low + Ijk(n & 1, n >> 1 & 1, n >> 2);
    const auto c = static_cast<std::size_t>(n);
    in_grid[c] = values.contains(corner);
    depth[c] = in_grid[c] ? double{values.at(corner)} : -1;
    if (depth[c] >= 0) solid |= 1 << n;
  }
  if (solid == 0 || solid == 255) return 0;
  const auto& edges = surface::cell_edges();
  const surface::CellCase& triangles = surface::cell_cases()[static_cast<std::size_t>(solid)];
  std::array<Vec3, surface::kCellEdges> vertex;
  for (std::size_t e = 0; e < surface::kCellEdges; ++e) {
    const auto a = static_cast<std::size_t>(edges[e].low),
               b = a | std::size_t{1} << static_cast<std::size_t>(edges[e].axis);
    if ((depth[a] >= 0) == (depth[b] >= 0)) continue;
    const double t = in_grid[a] && in_grid[b] ? depth[a] / (depth[a] - depth[b]) : 0.5;
    vertex[e] = (low + Ijk(edges[e].x, edges[e].y, edges[e].z)).cast<double>() +
                t * Vec3::Unit(edges[e].axis) - about;
  }
  double six = 0;
  for (std::size_t t = 0; t < triangles.count; ++t)
    six += vertex[triangles.edge[3 * t]].dot(
        vertex[triangles.edge[3 * t + 1]].cross(vertex[triangles.edge[3 * t + 2]]));
  return six;
}

double marching_cubes_mm3(const io::Scan& scan, const Values& values) {
  const Vec3 about = 0.5 * scan.size.cast<double>();
  double six = 0;
  for (int k = -1; k < scan.size.z(); ++k)
    for (int j = -1; j < scan.size.y(); ++j)
      for (int i = -1; i < scan.size.x(); ++i) six += cell_volume(values, {i, j, k}, about);
  return six / 6 * scan.spacing_mm.prod();
}

// Whether a voxel for which ok() holds lies within `reach` of a place; reach and place in voxels of a
// grid, `unit` how many of these count as one along each axis.
template <class Ok>
bool any_within(const Vec3& at, double reach, const Vec3& unit, const Ok& ok) {
  const Ijk nearest(at.array().round().cast<int>());
  if (((nearest.cast<double>() - at).cwiseQuotient(unit)).norm() <= reach && ok(nearest))
    return true;
  const Ijk from((at - reach * unit).array().ceil().cast<int>()),
      to((at + reach * unit).array().floor().cast<int>());
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i)
        if ((Vec3(i, j, k) - at).cwiseQuotient(unit).squaredNorm() <= reach * reach &&
            ok({i, j, k}))
          return true;
  return false;
}

// The same for a box: within one `unit` along each axis.
template <class Ok>
bool any_in_box(const Vec3& at, const Vec3& unit, const Ok& ok) {
  const Ijk nearest(at.array().round().cast<int>());
  if (ok(nearest)) return true;
  const Ijk from((at - unit).array().ceil().cast<int>()),
      to((at + unit).array().floor().cast<int>());
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i)
        if (ok({i, j, k})) return true;
  return false;
}

}  // namespace

ScanLaw scan_law(const io::Scan& scan, const volume::Bone& bone, double level) {
  ScanLaw out;
  const Values values(scan, level);
  const volume::Grid& grid = bone.grid();
  // from the bone's voxels to the scan's: along each axis a shift and a scale
  const auto scan_at = [&](const Vec3& p_grid) {
    return Vec3((scan.axes.transpose() * (1e3 * grid.world_from_grid(p_grid) - scan.origin_mm))
                    .cwiseQuotient(scan.spacing_mm));
  };
  const double voxel_mm = grid.voxel * 1e3;
  const Vec3 first = scan_at(Vec3::Zero()),
             step = Vec3::Constant(voxel_mm).cwiseQuotient(scan.spacing_mm),
             larger = step.cwiseMax(1.0);  // the larger voxel, in voxels of the scan
  const auto at_level = [&values](const Ijk& v) { return values.inside(v); };
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const volume::Field field = bone.field(i, j, k);
        if (field == 0) continue;
        const Vec3 at = first + step.cwiseProduct(Vec3(i, j, k));
        if (field >= volume::kIso) {
          if (!any_within(at, kNear, larger, at_level)) ++out.ghosts;
        } else if (!any_within(at, kFar, larger, at_level)) {
          ++out.ramps;
        }
      }
  const auto is_bone = [&](const Ijk& v) {
    return grid.contains(v) && bone.field(v.x(), v.y(), v.z()) >= volume::kIso;
  };
  const Vec3 one = step.cwiseInverse().cwiseMax(1.0);  // the larger voxel, in voxels of the bone
  for (int k = 0; k < scan.size.z(); ++k)
    for (int j = 0; j < scan.size.y(); ++j)
      for (int i = 0; i < scan.size.x(); ++i) {
        const Ijk v(i, j, k);
        if (values.at(v) >= 0 &&
            !any_in_box((v.cast<double>() - first).cwiseQuotient(step), one, is_bone))
          ++out.lost;
      }
  out.scan_mm3 = marching_cubes_mm3(scan, values);
  out.mesh_mm3 = surface::enclosed_volume(bone) * 1e9;
  NoProgress progress;
  const auto parts = find_parts(
      grid.size,
      [&](int j, int k, std::span<std::uint8_t> row) {
        for (std::size_t i = 0; i < row.size(); ++i)
          row[i] = bone.field(static_cast<int>(i), j, k) >= volume::kIso ? 1 : 0;
      },
      progress);
  out.parts = parts->parts.size();
  return out;
}

}  // namespace burr::importing
