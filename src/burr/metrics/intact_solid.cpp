#include "burr/metrics/intact_solid.h"

#include <algorithm>
#include <cstdint>

#include "burr/base/check.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {

using volume::Bone;
using volume::Field;

Assessed<IntactSolid> intact_solid(const Bone& before, const Bone& after, const VoxelSet& structure,
                                   const Worked& worked, const IntactSolidSettings& settings) {
  BURR_CHECK(same_grid(before, after));
  const volume::Grid& grid = before.grid();
  const double voxel = grid.voxel * grid.voxel * grid.voxel;
  const double unit = voxel / static_cast<double>(volume::kVoxelUnits);
  std::int64_t lost = 0, standing = 0, whole = 0;
  std::int32_t most = 0;
  IntactSolid out;
  structure.for_each([&](const math::Ijk& v) {
    const Field was = before.field(v.x(), v.y(), v.z());
    if (was < volume::kIso) return;  // a soft label
    const Field is = after.field(v.x(), v.y(), v.z());
    const std::int32_t had = volume::volume_units(std::int32_t{was});
    const std::int32_t loss = std::max(0, had - volume::volume_units(std::int32_t{is}));
    whole += had;
    lost += loss;
    if (is >= volume::kIso) standing += loss;
    if (loss > most) {
      most = loss;
      out.at = grid.world_from_grid(v.cast<double>());
    }
  });
  if (whole == 0)
    return NotAssessable{structure.count() == 0
                             ? "the structure is not in this bone: no voxel has its label"
                             : "the structure is soft: a burr cuts none of it, so its volume says "
                               "nothing"};
  out.whole = static_cast<double>(whole) * unit;
  out.most_lost = static_cast<double>(most) / static_cast<double>(volume::kVoxelUnits);
  out.mark = intact_mark(static_cast<double>(lost) * unit,
                         settings.v.value_or(std::max(0.05e-9, 3 * voxel)),
                         static_cast<double>(standing) * unit, worked);
  return out;
}

}  // namespace burr::metrics
