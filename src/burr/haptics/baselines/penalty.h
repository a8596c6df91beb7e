// haptics/baselines/penalty.h - the burr floats where the hand's spring and the springs at its
// points in bone are in balance.
//
//     minimum over c of  1/2 |x - c|^2 + 1/2 q sum_i w_i depth(c + r u_i)^2
//
// After J. Barbic and D. James 2008 (points against a distance field, quasi-static coupling), here
// with the points on the burr and the bone's own field as the distance. It uses no planes, facets
// or candidates, so in shallow contact it is an independent check of `constraint`: its contact is
// softer by a few hundredths of a voxel. The field contains distances up to two voxels only: deeper
// points are pushed no harder, and a fast hand falls through.
#pragma once

#include <array>

#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class PenaltyProxy : public TouchMethod {
 public:
  PenaltyProxy(const volume::Bone& bone, const ProxySettings& settings, const math::Vec3& hand);

  void place(const math::Vec3& p) BURR_RT override;
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  void set_friction(double, double) BURR_RT override {}  // has no friction
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  static constexpr int kPoints = 4000;

  const volume::Bone& bone_;
  double radius_;                                            // [m]
  std::unique_ptr<std::array<math::Vec3, kPoints>> points_;  // on the unit ball
  math::Vec3 c_;                                             // p_grid
  math::Vec3 proxy_;                                         // world [m]
};

}  // namespace burr::haptics
