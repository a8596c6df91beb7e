// tests/render/formula_surfaces.h - surfaces by formula, so that the tests of this room need no other room.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "burr/render/scene.h"

namespace burr::test {

// A ball of triangles by longitude and latitude, `steps` from pole to pole. Error of the radius:
// about radius (pi / steps)^2 / 8.
inline surface::Patch ball(const math::Vec3& centre, double radius, int steps,
                           volume::TissueId tissue = 1) {
  surface::Patch patch;
  const int around = 2 * steps;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= around; ++i) {
      const double lat = (static_cast<double>(j) / steps - 0.5) * std::numbers::pi;
      const double lon = static_cast<double>(i) / around * 2 * std::numbers::pi;
      const math::Vec3 n(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                         std::sin(lat));
      patch.vertices.push_back({(centre + radius * n).cast<float>(), n.cast<float>(), tissue});
    }
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < around; ++i) {
      const auto at = [&](int a, int b) {
        return static_cast<std::uint32_t>((j + b) * (around + 1) + i + a);
      };
      for (const std::uint32_t v : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)})
        patch.triangles.push_back(v);
    }
  return patch;
}

// Makes a patch from what a scene keeps of it.
inline surface::Patch unpacked(const render::SkinMesh& mesh) {
  surface::Patch patch;
  for (const render::SkinVertex& v : mesh.vertices())
    patch.vertices.push_back({v.p, render::normal_of(v), render::tissue_of(v),
                              static_cast<volume::TissueId>(v.under & 0xFFU),
                              static_cast<std::uint8_t>(v.under >> 8 & 0xFFU),
                              static_cast<std::uint8_t>(v.under >> 16)});
  for (std::size_t n = 0; n < mesh.index_count(); ++n) patch.triangles.push_back(mesh.index(n));
  return patch;
}

// The same surface in n x n x n patches, as a mesher would divide it: each triangle belongs where
// its middle lies.
inline std::vector<surface::Patch> cut(const surface::Patch& whole, int n) {
  math::Aabb box;
  for (const auto& v : whole.vertices) box.extend(v.p.cast<double>());
  std::vector<surface::Patch> parts(static_cast<std::size_t>(n * n * n));
  std::vector<std::map<std::uint32_t, std::uint32_t>> known(parts.size());
  for (std::size_t t = 0; t < whole.triangles.size(); t += 3) {
    math::Vec3 middle = math::Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      middle += whole.vertices[whole.triangles[t + c]].p.cast<double>() / 3;
    std::size_t place = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double u = (middle[axis] - box.lo[axis]) / box.extent()[axis];
      place = place * static_cast<std::size_t>(n) +
              static_cast<std::size_t>(std::clamp(static_cast<int>(u * n), 0, n - 1));
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = whole.triangles[t + c];
      const auto [entry, fresh] =
          known[place].try_emplace(v, static_cast<std::uint32_t>(parts[place].vertices.size()));
      if (fresh) parts[place].vertices.push_back(whole.vertices[v]);
      parts[place].triangles.push_back(entry->second);
    }
  }
  return parts;
}

// A bumpy, hollowed ball of `radius`; like bone, no part of it is flat. The radius varies with the
// direction; normals by differences.
inline surface::Patch bumpy(double radius, int steps) {
  const auto point = [radius](double lon, double lat) {
    const math::Vec3 d(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
    const double wave =
        0.10 * std::sin(5 * d.x() + 1) * std::cos(4 * d.z()) +
        0.04 * std::sin(17 * d.y()) * std::sin(13 * d.z() + 2) +
        0.012 * std::sin(60 * d.x()) * std::sin(55 * d.z() + 1) * std::cos(58 * d.y());
    // a milled bowl towards -y
    const double bowl = 0.28 * std::exp(-12 * (d + math::Vec3::UnitY()).squaredNorm());
    return math::Vec3(radius * (1 + wave - bowl) * d);
  };
  surface::Patch patch = ball(math::Vec3::Zero(), radius, steps);
  constexpr double kStep = 1e-4;
  for (auto& v : patch.vertices) {
    const math::Vec3 d = v.n.cast<double>();
    const double lat = std::clamp(std::asin(std::clamp(d.z(), -1.0, 1.0)), -1.5706, 1.5706);
    const double lon = std::atan2(d.y(), d.x());
    v.p = point(lon, lat).cast<float>();
    v.n = (point(lon + kStep, lat) - point(lon - kStep, lat))
              .cross(point(lon, lat + kStep) - point(lon, lat - kStep))
              .normalized()
              .cast<float>();
    v.tissue = d.z() > 0.75 ? volume::TissueId{2} : volume::TissueId{1};
  }
  return patch;
}

}  // namespace burr::test
