// haptics/baselines/voxel_springs.h - no proxy: every voxel of bone inside the burr pushes the
// burr's centre away, by a spring whose length is the voxel's depth below the burr's surface.
//
//     F = sum over voxels in the ball of  k_i (r - |x - p_i|) (x - p_i) / |x - p_i|
//
// The method of the thesis' Fig. 9; k_i grows with the share of bone in the voxel. In a half-space
// at distance a from the centre: F = k_i pi / h^3 (r^4/12 - a^2 r^2/2 + 2 r |a|^3/3 - a^4/4)
// (docs/understand/touch_methods.md, "Voxel springs"). So voxels half as large make it eight times
// as stiff; it becomes softer beyond half immersion, and gives no force at all when the burr is
// wholly inside.
#pragma once

#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class VoxelSprings : public TouchMethod {
 public:
  VoxelSprings(const volume::Bone& bone, const ProxySettings& settings, const math::Vec3& hand);

  // Stiffness of one voxel's spring, as a share of the force law's stiffness.
  static constexpr double kShare = 0.002;

  void place(const math::Vec3& p) BURR_RT override { proxy_ = p; }
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  void set_friction(double, double) BURR_RT override {}  // has no friction
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  const volume::Bone& bone_;
  double radius_;     // [m]
  math::Vec3 proxy_;  // the hand itself  [m]
};

}  // namespace burr::haptics
