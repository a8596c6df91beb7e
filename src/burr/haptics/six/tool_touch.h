// haptics/six/tool_touch.h - a tool of any shape in the hand: all its parts touch, by the proxy of six
// unknowns (six_proxy.h), as a method of touch.
//
// Friction holds it along the bone and about any axis (six_friction.h). The stretch changes no faster
// than ProxySettings::slip allows, while a contact holds and until the spring has caught up.
//
// Thread: servo. Frame: world. Memory: taken at construction.
#pragma once

#include "burr/haptics/six/six_proxy.h"
#include "burr/haptics/six/slip_limit.h"
#include "burr/haptics/touch_method.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

class ToolTouch final : public TouchMethod {
 public:
  // settings: radius is not used. lever: L = sqrt(k_r / k_t)  [m]
  ToolTouch(const volume::IsoVertices& surface, const tool::Tool& tool,
            const ProxySettings& settings, double lever, const math::Pose& hand);

  // Takes another tool at the same pose, free or not.
  void take(const tool::Tool& tool) BURR_RT;
  // True if no part that touches reaches into bone there.
  [[nodiscard]] bool is_free(const math::Pose& world_from_tool) BURR_RT {
    return six_.is_free(world_from_tool);
  }
  void place(const math::Pose& world_from_tool) BURR_RT;
  void place(const math::Vec3& p) BURR_RT override;  // as it is turned now
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] Touch step_pose(const math::Pose& hand) BURR_RT override;
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return pose_.p; }
  [[nodiscard]] const math::Pose& pose() const BURR_RT { return pose_; }
  [[nodiscard]] SixProxy* six() BURR_RT override { return &six_; }
  [[nodiscard]] Touch felt(const SixTouch& six, const math::Pose& hand) BURR_RT override;
  [[nodiscard]] const ToolContact* parts() const BURR_RT override { return &contact_; }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override {
    if (rubs_) six_.set_friction({mu_static, mu_kinetic});
  }
  [[nodiscard]] bool set_radius(double) BURR_RT override { return false; }
  void set_max_moves(int moves) BURR_RT { six_.set_max_moves(moves); }
  // The hand feels the torque: L of the springs that it really has (safety/coupling.h)  [m]
  // feels: whether it does; otherwise L is that of a spring that nobody feels.
  void couple(double lever, bool feels = true) BURR_RT {
    six_.set_lever(lever);
    lever_ = lever;
    turns_ = feels;
  }

 private:
  SixProxy six_;
  SlipLimit slip_;
  TurnLimit turn_limit_;
  double per_tick_;  // ProxySettings::slip  [m]
  double lever_;
  bool rubs_;           // ProxySettings::parts_rub
  bool turns_ = false;  // the torque is felt
  math::Pose pose_;
  bool follows_ = false;  // the stretch is limited
  ToolContact contact_;
};

// The sum of a tool's contact, and its parts. lever: L  [m]
[[nodiscard]] Touch touch_of(const SixTouch& six, const tool::Tool& tool, double lever,
                             ToolContact& contact) BURR_RT;
// Where the hand feels the torque: it changes no faster than the force may. slip: of the stretch, per
// tick  [m]
void limit_turn(const math::Quat& hand, double slip, TurnLimit& limit,
                ToolContact& contact) BURR_RT;

}  // namespace burr::haptics
