#include "burr/importing/tissue_volumes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "burr/importing/settle.h"
#include "burr/volume/volume_of.h"

namespace burr::importing {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::TissueId;

std::vector<double> restore_tissue_volumes(Bone& bone, const std::vector<double>& wanted_voxels,
                                           int law) {
  // count voxels by tissue and field, in steps of 16: 1/1024 of a voxel of depth
  constexpr int kStep = 16, kBins = 65536 / kStep;
  const std::size_t tissues = bone.tissues().tissues.size();
  std::vector<std::vector<std::int64_t>> bins(tissues);
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const Field* field = bone.brick_field(b);
    if (field == nullptr) continue;
    const TissueId* tissue = bone.brick_tissue(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] == 0 || tissue[v] >= tissues) continue;
      auto& own = bins[tissue[v]];
      if (own.empty()) own.resize(kBins);
      ++own[field[v] / kStep];
    }
  }
  const auto volume_at = [&](std::size_t t, int shift) {
    std::int64_t sum = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      const int field =
          bin == kBins - 1 ? 65535 : std::clamp(bin * kStep + kStep / 2 + shift, 0, 65535);
      sum += bins[t][static_cast<std::size_t>(bin)] * volume::volume_units(field);
    }
    return static_cast<double>(sum) / static_cast<double>(volume::kVoxelUnits);
  };
  // volume grows with the shift: bisection
  std::vector<int> shifts(tissues);
  const int most = static_cast<int>(0.35 * volume::kFieldPerVoxel);
  std::size_t largest = 0;
  for (std::size_t t = 1; t < tissues; ++t) {
    if (t >= wanted_voxels.size() || wanted_voxels[t] <= 0 || bins[t].empty()) continue;
    if (largest == 0 || wanted_voxels[t] > wanted_voxels[largest]) largest = t;
    int lo = -most, hi = most;
    while (hi - lo > 1) {
      const int middle = (lo + hi) / 2;
      (volume_at(t, middle) < wanted_voxels[t] ? lo : hi) = middle;
    }
    shifts[t] = std::abs(volume_at(t, lo) - wanted_voxels[t]) <
                        std::abs(volume_at(t, hi) - wanted_voxels[t])
                    ? lo
                    : hi;
  }
  // the ramp that reaches into soft labels moves with the largest solid, so that there is no step
  for (std::size_t t = 1; t < tissues; ++t)
    if (bone.tissues()[static_cast<TissueId>(t)].kind == volume::TissueKind::soft)
      shifts[t] = shifts[largest];
  // a voxel that the shift takes to the other side goes there only if no part comes or goes
  std::vector<Flip> flips;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    if (bone.brick_field(b) == nullptr || bone.is_uniform(b)) continue;
    Field* field = bone.build_field(b);
    const TissueId* tissue = bone.brick_tissue(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] == 0 || field[v] == volume::kSolid) continue;
      const int shift = shifts[tissue[v] < tissues ? tissue[v] : 0];
      const auto moved = static_cast<Field>(std::clamp(int{field[v]} + shift, 1, 65534));
      const bool inside = field[v] >= volume::kIso;
      if (law == 1 || inside == (moved >= volume::kIso)) {
        field[v] = moved;
        continue;
      }
      flips.push_back({bone.brick_ijk(b) + math::Ijk(v % 8, v / 8 % 8, v / 64), moved});
      field[v] = volume::field_from_depth(inside ? kBesideSurface : -kBesideSurface);
    }
  }
  settle(bone, flips);
  std::vector<double> moved(tissues);
  for (std::size_t t = 0; t < tissues; ++t) moved[t] = shifts[t] / volume::kFieldPerVoxel;
  return moved;
}

}  // namespace burr::importing
