// haptics/baselines/triangles.h - a god object on the triangles of the picture, which are rebuilt
// 30 times a second.
//
//     distance(c, triangle) >= r for the triangles that c is in front of;  c as near the hand as
//     these allow
//
// C. Zilles and K. Salisbury 1995 with the ball of D. Ruspini et al. 1997, on the input that
// OpenHaptics and similar libraries get: the rendered mesh (the thesis' Fig. 8). Correct while the
// bone does not change. While it is milled the mesh under the burr is replaced every frame: at the
// moment without triangles the burr follows the hand into the bone, finds the new triangles facing
// away from it, and falls through. The caller supplies the triangles (tick/touch_methods.h): this
// file knows no mesh.
#pragma once

#include <memory>
#include <vector>

#include "burr/haptics/least_move.h"
#include "burr/haptics/touch_method.h"

namespace burr::haptics {

class TriangleProxy : public TouchMethod {
 public:
  TriangleProxy(double voxel, const ProxySettings& settings, const math::Vec3& hand);

  // Corners counter-clockwise seen from the air, world [m].
  struct Triangle {
    math::Vec3f a, b, c;
  };
  static constexpr std::size_t kMost = 1 << 17;
  void clear() BURR_RT { triangles_.clear(); }
  // False: no room for more.
  bool add(const Triangle& triangle) BURR_RT;
  [[nodiscard]] std::size_t size() const BURR_RT { return triangles_.size(); }

  void place(const math::Vec3& p) BURR_RT override { c_ = p; }
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return c_; }
  void set_friction(double, double) BURR_RT override {}  // has no friction
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;

 private:
  struct Known {
    math::Vec3f a, b, c, normal, middle;
    float reach;  // distance of the corners from the middle [m]
  };
  void collect(double within) BURR_RT;

  double voxel_, radius_;  // [m]
  MostViolated most_violated_;
  std::vector<Known> triangles_;
  std::unique_ptr<Candidates> candidates_;
  math::Vec3 c_;  // world [m]
};

}  // namespace burr::haptics
