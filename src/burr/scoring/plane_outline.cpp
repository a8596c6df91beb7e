#include "burr/scoring/plane_outline.h"

#include <cmath>
#include <optional>

#include "burr/volume/sample.h"

namespace burr::scoring {
namespace {

using math::Vec3;

// Two unit vectors across n, a unit vector.
std::array<Vec3, 2> across(const Vec3& n) {
  const Vec3 other = std::abs(n.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX();
  const Vec3 u = other.cross(n).normalized();
  return {u, n.cross(u)};
}

// The depth of the bone over a grid of points of one plane.
struct Sheet {
  Vec3 origin, u, v;
  int wide = 0, high = 0;
  std::vector<double> depth;
  [[nodiscard]] Vec3 point(int i, int j) const { return origin + i * u + j * v; }
  [[nodiscard]] double at(int i, int j) const {
    return depth[static_cast<std::size_t>(i) +
                 static_cast<std::size_t>(wide) * static_cast<std::size_t>(j)];
  }
};

Sheet sheet_of(const Vec3& at, const Vec3& normal, const volume::Bone& bone) {
  const double h = bone.grid().voxel;
  const Vec3 middle = bone.grid().world_from_grid(0.5 * bone.grid().size.cast<double>());
  const int half =
      static_cast<int>(std::ceil(0.5 * bone.grid().size.cast<double>().norm())) + 1;  // voxels
  const auto [u, v] = across(normal);
  const Vec3 foot = middle - (middle - at).dot(normal) * normal;
  Sheet sheet{foot - half * h * (u + v), h * u, h * v, 2 * half + 1, 2 * half + 1, {}};
  sheet.depth.reserve(static_cast<std::size_t>(sheet.wide) * static_cast<std::size_t>(sheet.high));
  for (int j = 0; j < sheet.high; ++j)
    for (int i = 0; i < sheet.wide; ++i)
      sheet.depth.push_back(volume::depth_at(bone, sheet.point(i, j)));
  return sheet;
}

// Where the surface lies between a point inside and one outside: the depth does not change evenly on the way.
Vec3 between(const volume::Bone& bone, Vec3 in, Vec3 out) {
  for (int n = 0; n < 10; ++n) {
    const Vec3 middle = 0.5 * (in + out);
    (volume::depth_at(bone, middle) >= 0 ? in : out) = middle;
  }
  return 0.5 * (in + out);
}

// The surface crosses the sides of a triangle of the sheet twice, or not at all.
void cross(const volume::Bone& bone, const std::array<Vec3, 3>& p, const std::array<double, 3>& d,
           std::vector<std::array<Vec3, 2>>& lines) {
  std::optional<Vec3> first;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t m = (n + 1) % 3;
    if ((d[n] >= 0) == (d[m] >= 0)) continue;
    const Vec3 at = d[n] >= 0 ? between(bone, p[n], p[m]) : between(bone, p[m], p[n]);
    if (first)
      lines.push_back({*first, at});
    else
      first = at;
  }
}

}  // namespace

std::vector<std::array<Vec3, 2>> outline_of(const scenario::CaseRegion& region,
                                            const metrics::Region& where,
                                            const volume::Bone& bone) {
  std::vector<std::array<Vec3, 2>> lines, kept;
  for (const auto* shapes : {&region.add, &region.take})
    for (const scenario::Shape& shape : *shapes) {
      if (shape.kind != scenario::ShapeKind::half_space) continue;
      const Sheet sheet = sheet_of(shape.a.at, shape.normal, bone);
      for (int j = 0; j + 1 < sheet.high; ++j)
        for (int i = 0; i + 1 < sheet.wide; ++i) {
          const auto corner = [&](int a, int b) { return sheet.point(i + a, j + b); };
          const auto depth = [&](int a, int b) { return sheet.at(i + a, j + b); };
          cross(bone, {corner(0, 0), corner(1, 0), corner(1, 1)},
                {depth(0, 0), depth(1, 0), depth(1, 1)}, lines);
          cross(bone, {corner(0, 0), corner(1, 1), corner(0, 1)},
                {depth(0, 0), depth(1, 1), depth(0, 1)}, lines);
        }
    }
  const double near = bone.grid().voxel;
  for (const auto& line : lines)
    if (metrics::depth_in(where, 0.5 * (line[0] + line[1])) > -near) kept.push_back(line);
  return kept;
}

}  // namespace burr::scoring
