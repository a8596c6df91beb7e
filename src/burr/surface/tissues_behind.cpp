#include "burr/surface/tissues_behind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace burr::surface {
namespace {

using volume::BrickIndex;
using volume::kBrickEdge;
using volume::TissueId;

constexpr int kSamples = kPatchEdge + 1;  // voxels at the corners of a patch's cells

}  // namespace

TissuesBehind::TissuesBehind(const volume::Bone& from, double shine_through, int steps)
    : bone(from), reach(shine_through), steps_below(steps) {
  for (const volume::Tissue& tissue : bone.tissues().tissues)
    soft.push_back(tissue.kind == volume::TissueKind::soft);
  soft.resize(256);
  find_soft();
  find_borders();
}

// Only added material changes tissues, and that is solid: soft tissue stays where it is.
void TissuesBehind::find_soft() {
  if (std::find(soft.begin(), soft.end(), true) == soft.end()) return;
  std::vector<bool> wide(static_cast<std::size_t>(bone.brick_count()));
  bool any = false;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const TissueId* tissue = bone.brick_tissue(b);
    if (tissue == nullptr) continue;
    const bool holds =
        std::any_of(tissue, tissue + volume::kBrickVoxels, [&](TissueId one) { return soft[one]; });
    if (!holds) continue;
    any = true;
    const math::Ijk at = bone.brick_ijk(b) / kBrickEdge;
    const math::Ijk low = (at.array() - 1).max(0);
    const math::Ijk high = (at.array() + 1).min(bone.bricks().array() - 1);
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i)
          wide[static_cast<std::size_t>(bone.brick_at(i, j, k))] = true;
  }
  if (any) soft_bricks = std::move(wide);
}

// A brick beside one of another tissue counts too: a border may run between the two.
void TissuesBehind::find_borders() {
  std::vector<int> only(static_cast<std::size_t>(bone.brick_count()));  // its solid tissue; 0: none
  constexpr int kSeveral = -1;
  const auto joined = [](int a, int b) { return a == b || b == 0 ? a : a == 0 ? b : kSeveral; };
  std::array<int, 256> solids{};
  for (std::size_t n = 0; n < std::min(solids.size(), bone.tissues().tissues.size()); ++n)
    if (bone.tissues().tissues[n].kind == volume::TissueKind::solid)
      solids[n] = static_cast<int>(n);
  for (BrickIndex b = 0; b < bone.brick_count(); ++b)
    if (const TissueId* tissue = bone.brick_tissue(b); tissue != nullptr)
      for (int v = 0; v < volume::kBrickVoxels; ++v)
        only[static_cast<std::size_t>(b)] =
            joined(only[static_cast<std::size_t>(b)], solids[tissue[v]]);
  std::vector<bool> found(only.size());
  bool any = false;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    if (only[static_cast<std::size_t>(b)] == 0) continue;
    const math::Ijk at = bone.brick_ijk(b) / kBrickEdge;
    const math::Ijk low = (at.array() - 1).max(0);
    const math::Ijk high = (at.array() + 1).min(bone.bricks().array() - 1);
    int all = 0;
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i)
          all = joined(all, only[static_cast<std::size_t>(bone.brick_at(i, j, k))]);
    if (all != kSeveral) continue;
    found[static_cast<std::size_t>(b)] = any = true;
  }
  if (any) border_bricks = std::move(found);
}

bool TissuesBehind::any_soft_near(const math::Ijk& first) const {
  if (soft_bricks.empty()) return false;
  const math::Ijk low = ((first.array() - steps_below - 1) / kBrickEdge).max(0);
  const math::Ijk high =
      ((first.array() + kSamples + steps_below + 1) / kBrickEdge).min(bone.bricks().array() - 1);
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i)
        if (soft_bricks[static_cast<std::size_t>(bone.brick_at(i, j, k))]) return true;
  return false;
}

// Searches along the normal, voxel by voxel: one step out of the bone for tissue that fills a
// hollow, then inwards for tissue under it. Air on the way hides what is behind it.
void TissuesBehind::look_beneath(const math::Vec3& p_grid, const math::Vec3& n_grid,
                                 Vertex& v) const {
  const double voxel = bone.grid().voxel;
  const math::Ijk& size = bone.grid().size;
  const auto tissue_at = [&](double out) -> TissueId {
    const math::Ijk at = (p_grid + out * n_grid).array().round().cast<int>();
    if ((at.array() < 0).any() || (at.array() >= size.array()).any()) return 0;
    return bone.shared_tissue(at.x(), at.y(), at.z());
  };
  // nearly every vertex is far from all soft tissue. No point of the search is farther than half a
  // brick from one of these two points, so any soft tissue is in their bricks or in the neighbours
  const auto near_soft = [&](double out) {
    const math::Ijk at =
        (p_grid + out * n_grid).array().round().cast<int>().max(0).min(size.array() - 1);
    return static_cast<bool>(soft_bricks[static_cast<std::size_t>(
        bone.brick_at(at.x() / kBrickEdge, at.y() / kBrickEdge, at.z() / kBrickEdge))]);
  };
  if (!near_soft(0) && !near_soft(-8)) return;
  // share of soft voxels around one point outside the bone; interpolated, to smooth the labels'
  // stairs
  const math::Vec3 out = p_grid + 1.5 * n_grid;
  const math::Ijk low = out.array().floor().cast<int>();
  const math::Vec3 part = out - low.cast<double>();
  double filled = 0;
  TissueId filling = 0;
  for (int c = 0; c < 8; ++c) {
    const math::Ijk by(c & 1, (c >> 1) & 1, c >> 2), at = low + by;
    if ((at.array() < 0).any() || (at.array() >= size.array()).any()) continue;
    const TissueId tissue = bone.shared_tissue(at.x(), at.y(), at.z());
    if (!soft[tissue]) continue;
    filling = tissue;
    double weight = 1;
    for (int d = 0; d < 3; ++d) weight *= by[d] == 1 ? part[d] : 1 - part[d];
    filled += weight;
  }
  if (filled > 0) {
    v.beneath = filling;
    v.through = static_cast<std::uint8_t>(std::lround(217 * filled));  // its wall is still bone
    v.wall = static_cast<std::uint8_t>(std::lround(255 * std::min(filled, 1.0)));
    return;
  }
  const int steps = static_cast<int>(std::lround(reach / voxel));
  bool in_bone = false;
  for (int s = 1; s <= steps; ++s) {
    const TissueId tissue = tissue_at(-s);
    if (soft[tissue]) {
      const double left = std::max(0.0, 1 - (s - 0.5) * voxel / reach);
      v.through = static_cast<std::uint8_t>(std::lround(191 * left));
      v.beneath = v.through > 0 ? tissue : TissueId{0};
      return;
    }
    const bool air = bone.tissues()[tissue].kind == volume::TissueKind::air;
    if (air && in_bone) return;
    in_bone = in_bone || !air;
  }
}

// The share of the most frequent other solid tissue around a vertex, so that the border of two is a
// soft line and not the stairs of voxels. Weights: a tent of two voxels.
void TissuesBehind::look_aside(const math::Ijk& voxel, const math::Vec3& p_grid, Vertex& v) const {
  const math::Ijk& size = bone.grid().size;
  const auto inside = voxel.array().max(0).min(size.array() - 1).matrix();
  if (!border_bricks[static_cast<std::size_t>(bone.brick_at(
          inside.x() / kBrickEdge, inside.y() / kBrickEdge, inside.z() / kBrickEdge))])
    return;
  constexpr int kReach = 2, kWide = 2 * kReach + 1;
  std::array<std::array<double, kWide>, 3> tent{};
  for (int d = 0; d < 3; ++d)
    for (int n = 0; n < kWide; ++n)
      tent[static_cast<std::size_t>(d)][static_cast<std::size_t>(n)] =
          std::max(0.0, kReach - std::abs(voxel[d] + n - kReach - p_grid[d]));
  const math::Ijk low = (voxel.array() - kReach).max(0);
  const math::Ijk high = (voxel.array() + kReach).min(size.array() - 1);
  const volume::TissueTable& tissues = bone.tissues();
  const TissueId mine = v.tissue;
  double own = 0;
  struct Other {
    TissueId tissue = 0;
    double weight = 0;
  };
  std::array<Other, 4> others;  // more do not meet within two voxels
  const auto tent_at = [&](int axis, int at) {
    return tent[static_cast<std::size_t>(axis)]
               [static_cast<std::size_t>(at - voxel[axis] + kReach)];
  };
  for (int k = low.z(); k <= high.z(); ++k) {
    if (tent_at(2, k) <= 0) continue;  // about every fifth voxel along each axis has no weight
    for (int j = low.y(); j <= high.y(); ++j) {
      if (tent_at(1, j) <= 0) continue;
      for (int i = low.x(); i <= high.x(); ++i) {
        const double weight = tent_at(0, i) * tent_at(1, j) * tent_at(2, k);
        if (weight <= 0) continue;
        const TissueId tissue = bone.shared_tissue(i, j, k);
        if (tissue == mine) {
          own += weight;
        } else if (tissues[tissue].kind == volume::TissueKind::solid) {
          for (Other& other : others) {
            if (other.weight > 0 && other.tissue != tissue) continue;
            other.tissue = tissue;
            other.weight += weight;
            break;
          }
        }
      }
    }
  }
  const Other& second =
      *std::max_element(others.begin(), others.end(),
                        [](const Other& x, const Other& y) { return x.weight < y.weight; });
  if (second.weight <= 0) return;
  v.beneath = second.tissue;
  v.through = static_cast<std::uint8_t>(std::lround(255 * second.weight / (own + second.weight)));
}

}  // namespace burr::surface
