// haptics/baselines/sample_method.h - points on the burr's surface: the gradients at those in bone are
// summed to one direction, and the proxy moves perpendicular to it.
//
//     e0 = normalised sum of the normals at the points in bone;  e1 = (I - e0 e0^T)(x - p)
//     p += e1, and along e0 only outward
//
// E. Vidholm and J. Agmund 2004 (the thesis' Fig. 10) with K. Lundin's law along e0. The method
// does not check whether a step leads into bone: once all points are inside, their normals cancel
// or vanish, and the proxy stays there for ever (Fig. 11).
#pragma once

#include <array>

#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class SampleProxy : public TouchMethod {
 public:
  SampleProxy(const volume::Bone& bone, const ProxySettings& settings, const math::Vec3& hand);

  void place(const math::Vec3& p) BURR_RT override;
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  void set_friction(double, double) BURR_RT override {}  // has no friction
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  static constexpr int kSamples = 200;
  // Number of points in bone when the burr is at p_grid; sum: of their normals, grid axes.
  [[nodiscard]] int in_bone(const math::Vec3& p_grid, math::Vec3& sum) const BURR_RT;

  const volume::Bone& bone_;
  double radius_;                            // [m]
  std::array<math::Vec3, kSamples> points_;  // on the unit ball
  math::Vec3 p_;                             // p_grid
  math::Vec3 proxy_;                         // world [m]
  bool touching_ = false;
};

}  // namespace burr::haptics
