#include "burr/volume/greys.h"

#include <algorithm>
#include <cstddef>

namespace burr::volume {

bool Greys::at(const math::Vec3& world, double& value) const {
  math::Vec3 p = (axes.transpose() * (world - origin)).cwiseQuotient(spacing);
  const math::Vec3 last = (size.array() - 1).cast<double>();
  if ((p.array() < -0.5).any() || (p.array() > last.array() + 0.5).any()) return false;
  p = p.cwiseMax(0).cwiseMin(last);
  const math::Ijk low = p.cast<int>(), high = (low.array() + 1).min(size.array() - 1);
  const math::Vec3 part = p - low.cast<double>();
  const auto voxel = [&](int i, int j, int k) {
    return static_cast<double>(
        stored[static_cast<std::size_t>(i) +
               static_cast<std::size_t>(size.x()) *
                   (static_cast<std::size_t>(j) +
                    static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k))]);
  };
  const auto along = [&](int j, int k) {
    const double a = voxel(low.x(), j, k);
    return a + part.x() * (voxel(high.x(), j, k) - a);
  };
  const auto across = [&](int k) {
    const double a = along(low.y(), k);
    return a + part.y() * (along(high.y(), k) - a);
  };
  const double a = across(low.z());
  value = least + step * (a + part.z() * (across(high.z()) - a));
  return true;
}

}  // namespace burr::volume
