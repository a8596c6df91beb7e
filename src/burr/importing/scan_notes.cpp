#include "burr/importing/scan_notes.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

// Sides of the patient, by the axis of LPS that leads out of the scan there: +x, -x, +y ...
constexpr std::array<const char*, 6> kSides = {"left", "right", "back", "front", "head", "feet"};

std::size_t side_of(const Vec3& outward) {
  Eigen::Index axis = 0;
  outward.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::size_t>(2 * axis) + (outward[axis] < 0 ? 1 : 0);
}

// The area of bone in one face of the region. A voxel whose four neighbours are no bone is noise.
double bone_in_face(const io::Scan& scan, const NotedRegion& region, int axis, bool last,
                    const std::function<bool(int, int, int)>& solid) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3, nu = region.size[u], nv = region.size[v];
  const int at = region.from[axis] + (last ? region.size[axis] - 1 : 0);
  std::vector<char> face(static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv));
  const auto cell = [&](int a, int b) -> char& {
    return face[static_cast<std::size_t>(a) +
                static_cast<std::size_t>(nu) * static_cast<std::size_t>(b)];
  };
  Ijk voxel;
  voxel[axis] = at;
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) {
      voxel[u] = region.from[u] + a;
      voxel[v] = region.from[v] + b;
      cell(a, b) = solid(voxel.x(), voxel.y(), voxel.z()) ? 1 : 0;
    }
  std::int64_t count = 0;
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) {
      if (cell(a, b) == 0) continue;
      const bool beside = (a > 0 && cell(a - 1, b) != 0) || (a + 1 < nu && cell(a + 1, b) != 0) ||
                          (b > 0 && cell(a, b - 1) != 0) || (b + 1 < nv && cell(a, b + 1) != 0);
      count += beside ? 1 : 0;
    }
  return static_cast<double>(count) * scan.spacing_mm[u] * scan.spacing_mm[v];
}

std::string border_note(const io::Scan& scan, const NotedRegion& region,
                        const std::function<bool(int, int, int)>& solid) {
  constexpr double kLeastMm2 = 1;
  std::array<double, 6> mm2{};
  double all = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool last : {false, true}) {
      const double here = bone_in_face(scan, region, axis, last, solid);
      mm2[side_of(scan.axes.col(axis) * (last ? 1.0 : -1.0))] += here;
      all += here;
    }
  if (all < kLeastMm2) return {};
  std::string where;
  for (std::size_t side = 0; side < mm2.size(); ++side)
    if (mm2[side] >= 0.005 * all)
      where += fmt::format("{}{} {:.3g}", where.empty() ? "" : ", ", kSides[side], mm2[side]);
  return fmt::format(
      "Bone reaches the border of the {}: {:.3g} mm2 ({}). It goes on beyond, but ends there in a "
      "flat face.",
      region.whole ? "scan" : "region", all, where);
}

}  // namespace

std::vector<std::string> scan_notes(const io::Scan& scan, const NotedRegion& region,
                                    const std::function<bool(int i, int j, int k)>& solid) {
  constexpr int kFewSlices = 5;
  constexpr double kThickMm = 3;
  std::vector<std::string> notes;
  if (region.size.z() < kFewSlices)
    notes.push_back(
        fmt::format("There are only {} slices: the shape of the bone across them is little more "
                    "than a guess.",
                    region.size.z()));
  if (scan.spacing_mm.z() > kThickMm)
    notes.push_back(
        fmt::format("The slices lie {:.3g} mm apart: thin bone between them is missing or too "
                    "thick, and the surface is stepped.",
                    scan.spacing_mm.z()));
  if (const double wide = std::max(scan.spacing_mm.x(), scan.spacing_mm.y()); wide > kThickMm)
    notes.push_back(
        fmt::format("The voxels are {:.3g} mm wide: thinner bone is missing or too thick.", wide));
  if (std::string note = border_note(scan, region, solid); !note.empty())
    notes.push_back(std::move(note));
  return notes;
}

}  // namespace burr::importing
