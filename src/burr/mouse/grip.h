// mouse/grip.h - how the mouse holds a tool that is no round burr.
//
// A mouse has no orientation. The handle leans away from the bone's normal, towards the side of the
// user's hand, by an angle that suits the tool and that the user may change; the user also turns the
// tool about its own axis. With a handle along the normal a blade lies from left to right.
// Thread: one, main. Frame: world. Units: SI.
#pragma once

#include "burr/math/pose.h"
#include "burr/render/camera.h"
#include "burr/scenario/rack.h"

namespace burr::mouse {

class Grip {
 public:
  // Takes a tool, as it is usually held; nullptr: the round burr. The tool outlives this.
  void take(const scenario::RackTool* tool);
  [[nodiscard]] bool burr() const { return tool_ == nullptr; }
  [[nodiscard]] const scenario::RackTool* tool() const { return tool_; }

  void roll(double by);  // about the tool's own axis  [rad]
  void lean(double by);  // between handle and normal, 0 to 90 degrees  [rad]
  [[nodiscard]] double rolled() const { return roll_; }
  [[nodiscard]] double leaned() const { return lean_; }

  // world_from_tool. out: unit, out of the bone.
  [[nodiscard]] math::Quat turn(const math::Vec3& out, const render::Camera& camera,
                                bool left_handed) const;
  // How far the cutting parts reach from the tool's origin: in any direction, and in this one.  [m]
  [[nodiscard]] double reach() const { return reach_; }
  [[nodiscard]] double reach_along(const math::Quat& world_from_tool,
                                   const math::Vec3& direction) const;

 private:
  const scenario::RackTool* tool_ = nullptr;
  double roll_ = 0, lean_ = scenario::kUsualLean, reach_ = 0;
};

}  // namespace burr::mouse
