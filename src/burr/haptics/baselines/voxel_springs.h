// haptics/baselines/voxel_springs.h - no proxy: every voxel of bone inside the burr pushes its centre
// away, by a spring as long as the voxel is deep below the burr's surface.
//
//     F = sum over voxels in the ball of  k_i (r - |x - p_i|) (x - p_i) / |x - p_i|
//
// The method of the thesis' Fig. 9; k_i grows with how much of the voxel is bone. In a half-space
// at distance a from the centre: F = k_i pi / h^3 (r^4/12 - a^2 r^2/2 + 2 r |a|^3/3 - a^4/4)
// (docs/touch.md, "Voxel springs"). So it is eight times as stiff with voxels half as large,
// softens from half immersion on, and gives no force at all to a burr that is wholly inside.
#pragma once

#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class VoxelSprings : public TouchMethod {
 public:
  VoxelSprings(const volume::Bone& bone, const ProxySettings& settings, const math::Vec3& hand);

  // Of the force law's stiffness that one voxel's spring has.
  static constexpr double kShare = 0.002;

  void place(const math::Vec3& p) BURR_RT override { proxy_ = p; }
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  void set_friction(double, double) BURR_RT override {}  // it has none
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  const volume::Bone& bone_;
  double radius_;     // [m]
  math::Vec3 proxy_;  // the hand itself  [m]
};

}  // namespace burr::haptics
