// mouse/mouse_aim.h - where the hand of the window goes while it follows a point in
// the picture.
//
//     not pressed  the burr hovers over what is seen there: in free air, on the eye's ray, as near
//                  to the bone as it has room. It is set down there at once, however far that is
//     pressed      the arm pulls it from there into the bone, along the surface's normal
//
// One exception: in a hole as narrow as the burr there is no other room than that of the burr. It
// stays there when it is lifted, as long as it is seen and the point is on the bone around it.
// Thread: one, main. Frame: world. Units: SI.
#pragma once

#include <optional>

#include "burr/mouse/grip.h"
#include "burr/mouse/mouse_hand.h"
#include "burr/render/pick.h"
#include "burr/render/scene.h"

namespace burr::mouse {

class MouseAim {
 public:
  static constexpr double kHover = 1e-3;  // air between the burr that hovers and the bone  [m]

  // How the tool is held; outlives this. nullptr: as a round burr.
  void hold(const Grip* grip) { grip_ = grip; }

  // voxel: edge of the bone's voxels [m]
  explicit MouseAim(double voxel) : air_(std::max(kHover, voxel)) {}

  struct Push {
    double depth = 0;    // of the arm's target below the surface [m]
    double spindle = 0;  // 0..1
  };
  // The hand for this picture. scene: with camera and burr as they are now; eye: through the point
  // in the picture; push: nothing while it is not pressed. Without bone there it is never pressed.
  [[nodiscard]] MouseHand::Aim at(const render::Scene& scene, const render::Ray& eye,
                                  const std::optional<Push>& push, bool left_handed);
  // The same for a hand that is somewhere else, with the handle leaning as ever. out: away from
  // the bone there.
  [[nodiscard]] MouseHand::Aim held_at(const math::Vec3& tip, const math::Vec3& out, double spindle,
                                       const render::Camera& camera, bool left_handed);

  // of the surface under the point, smoothed; zero before the first picture
  [[nodiscard]] const math::Vec3& normal() const { return normal_; }
  // While it hovers: in the bone under the point, half a burr deep. Nothing: there is no bone.
  [[nodiscard]] const std::optional<math::Vec3>& bone_below() const { return below_; }
  // For another hand than this: where it touches.
  void touches(const math::Vec3& p, const std::optional<math::Vec3>& normal);

 private:
  [[nodiscard]] math::Vec3 hover(const render::Scene& scene, const render::Ray& eye,
                                 const std::optional<render::Hit>& hit, double surface);
  [[nodiscard]] MouseHand::Aim over_drape(const render::Scene& scene, const render::Ray& eye,
                                          double covered, bool left_handed);
  [[nodiscard]] MouseHand::Aim lean(const math::Vec3& tip, const render::Camera& camera,
                                    bool left_handed) const;

  [[nodiscard]] bool other() const { return grip_ != nullptr && !grip_->burr(); }
  // Of the ball that holds the working part: so much room it needs  [m]
  [[nodiscard]] double reach(const render::Scene& scene) const {
    return other() ? grip_->reach() : scene.burr.radius;
  }
  const Grip* grip_ = nullptr;
  double air_;
  math::Vec3 normal_ = math::Vec3::Zero();
  std::optional<math::Vec3> point_;  // of the last work
  std::optional<math::Vec3> below_;
  bool in_work_ = false;  // pressed, or lifted and not set down elsewhere yet
};

}  // namespace burr::mouse
