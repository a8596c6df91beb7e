// haptics/baselines/thesis_method.h - the proxy of the thesis that this project began with: slide along
// the tangent, return to the iso-surface along the gradient, and rest a radius above it.
//
//     n = normal at s;   s1 = s + (I - n n^T)(x - s);   march from s1 along +-normal(s1) to the
//     iso-surface: the new s;   c = s + r n
//
// M. Eriksson, Haptic and Visual Simulation of a Material Cutting Process, KTH 2006, 1.6.2. Where
// the text leaves details open (docs/understand/touch_methods.md, "The eight methods"): contact
// begins where the path of the hand crosses the surface; the march goes in fifths of a voxel, at
// most two radii; friction is burr's own cone. Correct on smooth convex bone. One gradient
// represents one wall only: in a groove the burr penetrates the other wall.
#pragma once

#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class ThesisProxy : public TouchMethod {
 public:
  // literal: the force pulls to c, so that it jumps by k r at contact; otherwise to s.
  ThesisProxy(const volume::Bone& bone, const ProxySettings& settings, const math::Vec3& hand,
              bool literal);

  void place(const math::Vec3& p) BURR_RT override;
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return proxy_; }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override;
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  [[nodiscard]] bool inside(const math::Vec3& p_grid) const BURR_RT;
  [[nodiscard]] math::Vec3 normal_at(const math::Vec3& p_grid) const BURR_RT;
  [[nodiscard]] math::Vec3 crossing(math::Vec3 outside, math::Vec3 inside) const BURR_RT;
  [[nodiscard]] bool project(math::Vec3& p_grid) const BURR_RT;

  const volume::Bone& bone_;
  ProxySettings settings_;
  bool literal_;
  bool touching_ = false, sliding_ = false;
  math::Vec3 last_;                    // hand of the last tick                     p_grid
  math::Vec3 s_ = math::Vec3::Zero();  // on the surface                   p_grid
  math::Vec3 n_ = math::Vec3::Zero();  // unit, out of the bone, grid axes
  math::Vec3 proxy_;                   // world [m]
};

}  // namespace burr::haptics
