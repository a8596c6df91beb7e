#include "burr/edit/reached.h"

#include <algorithm>
#include <bit>

namespace burr::edit {

using volume::BrickField;
using volume::BrickIndex;
using volume::kBrickEdge;

Reached::Reached(BoneWriter& writer)
    : writer_(writer),
      kernel_(carve_kernel()),
      energy_of_(256, 1e9),
      excess_(2 * kMostBricksPerSide),
      bricks_(2 * kMostBricksPerSide) {
  const std::vector<volume::Tissue>& tissues = writer.bone().tissues().tissues;
  for (std::size_t t = 0; t < tissues.size(); ++t) energy_of_[t] = tissues[t].cutting_energy;
}

double Reached::mean_energy() BURR_RT {
  double energy = 0, weight = 0;
  for (std::size_t w = 0; w < hand_count_; ++w) {
    const Excess& excess = bricks_[w].excess;
    const auto units = static_cast<double>(std::max<std::int64_t>(excess.units, 0));
    const std::uint8_t one = writer_.tissue_of(bricks_[w].brick);
    double mean = energy_of_[one];
    if (one == BoneWriter::kMixed) {
      const volume::TissueId* tissue = writer_.bone().brick_tissue(bricks_[w].brick);
      double sum = 0, all = 0;
      for (std::uint32_t pairs = excess.pairs; pairs != 0; pairs &= pairs - 1) {
        const int first = 2 * kBrickEdge * std::countr_zero(pairs);
        for (int v = first; v < first + 2 * kBrickEdge; ++v) {
          const auto share = static_cast<double>(excess_[w].voxel[v]);
          sum += share * energy_of_[tissue[v]];
          all += share;
        }
      }
      if (all > 0) mean = sum / all;
    }
    energy += units * mean;
    weight += units;
  }
  if (weight > 0) last_energy_ = energy / weight;
  return last_energy_;
}

template <class Write>
Reached::Done Reached::apply(double share, bool deposit, const Write& write) BURR_RT {
  Done done;
  const auto fixed = static_cast<std::int32_t>(std::clamp(share, 0.0, 1.0) * 65536.0);
  if (fixed == 0) return done;
  BrickField now;
  for (std::size_t w = 0; w < count_; ++w) {
    const BrickIndex brick = bricks_[w].brick;
    const Applied applied =
        kernel_.apply(writer_.bone().brick_field(brick), excess_[w].voxel, bricks_[w].excess.pairs,
                      fixed, deposit ? 1 : 0, now.voxel);
    if (applied.most == 0) continue;
    write(brick, now, applied);
    (w < hand_count_ ? done.hand : done.image) += applied.units;
  }
  return done;
}

Reached::Done Reached::take(double share, std::uint32_t& flags) BURR_RT {
  return apply(share, false,
               [&](BrickIndex brick, const BrickField& now, const Applied& applied)
                   BURR_RT { writer_.write_less(brick, now, applied, flags); });
}

Reached::Done Reached::put(double share, volume::TissueId material, std::uint32_t& flags) BURR_RT {
  return apply(share, true,
               [&](BrickIndex brick, const BrickField& now, const Applied& applied)
                   BURR_RT { writer_.write_more(brick, now, applied, material, flags); });
}

}  // namespace burr::edit
