// metrics/distance_map.h - the distance of every voxel of a box to the nearest voxel of a set, whole
// voxels, exact. Of this room only.
//
// Three passes, one along each axis: the nearest voxel of a row, then the lower envelope of parabolas
// (Felzenszwalb & Huttenlocher 2012; in integers as Meijster et al. 2000), as volume/distance_to.h
// does for tissues. Thread: uses `threads` of its own; the result does not depend on their number.
// Memory: 4 bytes per voxel of the box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::metrics {

// A box of voxels of a grid; arrays over it are x fastest.
struct VoxelBox {
  math::Ijk first = {0, 0, 0}, size = {0, 0, 0};

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
           static_cast<std::size_t>(size.z());
  }
  // v: counted from `first`
  [[nodiscard]] std::size_t index(const math::Ijk& v) const {
    return static_cast<std::size_t>(v.x()) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(v.y()) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(v.z()));
  }
  [[nodiscard]] math::Ijk at(std::size_t index) const {
    const auto x = static_cast<std::size_t>(size.x()), y = static_cast<std::size_t>(size.y());
    return {static_cast<int>(index % x), static_cast<int>(index / x % y),
            static_cast<int>(index / (x * y))};
  }
  [[nodiscard]] bool has(const math::Ijk& v) const {
    return (v.array() >= 0).all() && (v.array() < size.array()).all();
  }
};

// No voxel of the set in the box.
inline constexpr std::int32_t kNowhere = 1 << 28;

// (box.count()) squared distance between voxel centres to the nearest voxel with set != 0
// [voxel^2]. Sides of the box: at most 8192.
[[nodiscard]] std::vector<std::int32_t> squared_distances(const VoxelBox& box,
                                                          const std::vector<std::uint8_t>& set,
                                                          int threads);

}  // namespace burr::metrics
