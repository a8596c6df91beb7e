// metrics/solidity.h - how solid a place is for the eye, before and after: what lengths of bone
// along a line of sight are made of.
//
//     sigma(p) = clamp(1/2 + 3 (f(p) - 1/2), 0, 1)    f: the field as a share, trilinear
//     rho(p)   = max(0, sigma_before - sigma_after)   removed
//
// The integral of sigma along a line is the length of bone on it, right to a few hundredths of a
// voxel where the field is a distance. Labels decide besides the field: inside the structure that
// is looked for sigma is 0; in any other soft tissue it is 1, for nobody sees a nerve through a
// sinus; tissues that the case lists as glass (eardrum, marrow) count by their field alone. Volumes
// use volume/volume_of.h instead; the two are not to be mixed.
//
// Frame: p_grid [voxel]. Thread: any number at once, while nothing writes to the bones. Memory: one
// byte per brick of the grid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

[[nodiscard]] constexpr double solidity_of(double share) {
  const double s = 0.5 + 3 * (share - 0.5);
  return s < 0 ? 0 : s > 1 ? 1 : s;
}

[[nodiscard]] bool same_grid(const volume::Bone& a, const volume::Bone& b);

class Solidity {
 public:
  // `before` and `after`: the same grid. seen: the structure that is looked for; may be nullptr.
  // All are kept by reference.
  Solidity(const volume::Bone& before, const volume::Bone& after, const VoxelSet* seen,
           std::span<const volume::TissueId> glass);

  // Bone alone: no tissue hides.
  [[nodiscard]] static Solidity of_bone(const volume::Bone& before, const volume::Bone& after);

  struct Pair {
    double before = 0, after = 0;
  };
  [[nodiscard]] Pair at(const math::Vec3& p_grid) const;
  // of the bone alone, whatever the labels
  [[nodiscard]] double before(const math::Vec3& p_grid) const;
  [[nodiscard]] double after(const math::Vec3& p_grid) const;

  // Air before and after, and no tissue that hides: nothing to count in this brick and just behind
  // it. ijk: any voxel.
  [[nodiscard]] bool is_clear(int i, int j, int k) const;
  [[nodiscard]] const volume::Grid& grid() const { return before_.grid(); }

 private:
  enum : std::uint8_t { kClear = 1, kUncut = 2, kWithoutSeen = 4 };
  void find_flags();
  [[nodiscard]] std::uint8_t flags_of(volume::BrickIndex brick) const;
  [[nodiscard]] double share_of_seen(const math::Vec3& p_grid) const;

  const volume::Bone &before_, &after_;
  const VoxelSet* seen_;
  std::array<bool, 256> hides_ = {};  // tissues that are opaque though no bone
  // (bricks) what holds for a brick and all its neighbours, so for all that a point in it reads
  std::vector<std::uint8_t> flags_;
};

class OpenCavity;

// What a ray meets from a point, in world lengths [m].
struct Met {
  double bone = 0;     // after                                            integral of sigma
  double across = 0;   // the same, each piece times max(1/2, n . w)
  double removed = 0;  // integral of rho
  double near = 0;     // bone before, within `near_reach` of the start
  bool opened = true;  // it came into the open cavity, where one was given
};

struct RaySettings {
  double most_bone = 3e-3;   // the ray ends when it has met more             [m]
  double near_reach = 3e-3;  // for `near`                                    [m]
  // With it, air between bone and this cavity counts as bone: cells that nobody opened hide what lies behind them.
  const OpenCavity* open = nullptr;
};

// Walks from `from` (p_grid) along the unit vector w (grid axes) to the end of the grid, in steps of
// half a voxel. n: the surface's outward normal at the start, grid axes. The start is first moved
// back, by a voxel at most, to where sigma is least: a voxel of a surface stands in its ramp.
[[nodiscard]] Met walk(const Solidity& solidity, const math::Vec3& from, const math::Vec3& w,
                       const math::Vec3& n, const RaySettings& settings);

// True if bone (sigma of `after` at least one half) or a tissue that hides lies on the way within
// `reach` [voxel].
[[nodiscard]] bool is_blocked(const Solidity& solidity, const math::Vec3& from, const math::Vec3& w,
                              double reach);

}  // namespace burr::metrics
