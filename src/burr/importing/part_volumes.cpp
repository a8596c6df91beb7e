#include "burr/importing/part_volumes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "burr/surface/enclosed.h"

namespace burr::importing {
namespace {

using math::Ijk;

// The part that a voxel of the bone belongs to. One that changed sides lies, over faces, beside one of
// its part that did not, a few steps away at most.
std::optional<std::uint32_t> part_of(const volume::Bone& bone, const Ijk& margin,
                                     const Parts& parts, const Ijk& voxel) {
  if (const auto part = parts.part_at(voxel - margin)) return part;
  constexpr std::size_t kMost = 64;  // voxels looked at
  std::vector<Ijk> seen{voxel};
  for (std::size_t n = 0; n < seen.size() && seen.size() < kMost; ++n)
    for (int a = 0; a < 6; ++a) {
      const Ijk next = seen[n] + (a % 2 == 0 ? 1 : -1) * Ijk::Unit(a / 2);
      if (bone.field(next.x(), next.y(), next.z()) < volume::kIso ||
          std::find(seen.begin(), seen.end(), next) != seen.end())
        continue;
      if (const auto part = parts.part_at(next - margin)) return part;
      seen.push_back(next);
    }
  return std::nullopt;
}

}  // namespace

void measure_parts(const volume::Bone& bone, const Ijk& margin, Parts& parts) {
  parts.volumes.assign(parts.parts.size(), 0.0);
  surface::each_triangle_volume(bone, [&](const Ijk& solid, double voxels) {
    if (const auto part = part_of(bone, margin, parts, solid)) parts.volumes[*part] += voxels;
  });
}

}  // namespace burr::importing
