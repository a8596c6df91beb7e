// haptics/six/shaft_touch.h - a burr whose neck and shaft touch the bone too.
//
//     the shaft touches nothing   the proxy of three unknowns, to the bit (proxy.h)
//     the shaft touches           the proxy of six unknowns (six_proxy.h): the tool moves aside, and
//                                 turns where it must, on a virtual spring of turning k_r = k_t L^2
//
// A device that only pushes gets the force; one that can turn the hand gets the torque as well, with
// springs of its own (couple()). The torque is in ToolContact; so is the head's own share of the
// contact, with which alone it may cut: the shaft never cuts. While the shaft touches, friction is
// that of six_friction.h, and the stretch of the spring changes no faster than ProxySettings::slip
// allows: so no step is felt when one proxy takes over from the other.
//
// A shaft that stands in bone when the burr is put down (a hand that came back, an undo) is not felt
// until it has been free once.
//
// Thread: servo. Frame: world. Memory: taken at construction.
#pragma once

#include "burr/haptics/proxy.h"
#include "burr/haptics/six/six_proxy.h"
#include "burr/haptics/six/slip_limit.h"
#include "burr/haptics/touch_method.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

class ShaftTouch final : public TouchMethod {
 public:
  // Of the virtual spring of turning: far stiffer than any wrist, so that the tool seen stays with
  // the hand; docs/develop/decisions.  [m]
  static constexpr double kLever = 60e-3;

  ShaftTouch(const volume::IsoVertices& surface, const ProxySettings& settings,
             const math::Vec3& hand);

  void place(const math::Vec3& p) BURR_RT override;
  [[nodiscard]] Touch step(const math::Vec3& hand) BURR_RT override;
  [[nodiscard]] Touch step_pose(const math::Pose& hand) BURR_RT override;
  // nullptr: the shaft has not been free yet.
  [[nodiscard]] SixProxy* six() BURR_RT override {
    six_.set_friction(friction_);  // for a tick with another tool; step_pose() sets its own
    return shaft_ ? &six_ : nullptr;
  }
  [[nodiscard]] Touch felt(const SixTouch& six, const math::Pose& hand) BURR_RT override;
  [[nodiscard]] const ToolContact& shaft() const BURR_RT { return contact_; }
  [[nodiscard]] const ToolContact* parts() const BURR_RT override { return &contact_; }
  [[nodiscard]] math::Pose pose() const BURR_RT { return six_.pose(); }
  [[nodiscard]] const math::Vec3& position() const BURR_RT override { return ball_.position(); }
  void set_friction(double mu_static, double mu_kinetic) BURR_RT override;
  [[nodiscard]] bool set_radius(double radius) BURR_RT override;
  void set_max_moves(int moves) BURR_RT;
  // The hand feels the torque: L of the springs that it really has (safety/coupling.h)  [m]
  void couple(double lever) BURR_RT {
    six_.set_lever(lever);
    lever_ = lever;
    turns_ = true;
  }

 private:
  [[nodiscard]] bool shaft_rests(const SixTouch& six) const BURR_RT;
  [[nodiscard]] Touch as_ball(const math::Pose& hand) BURR_RT;
  void limit_torque(const math::Quat& hand) BURR_RT;  // where it is felt
  [[nodiscard]] Touch as_tool(const SixTouch& six) BURR_RT;

  Proxy ball_;
  SixProxy six_;
  bool shaft_ = false;  // it has been free since the burr was put down
  bool rests_ = false;  // on bone, in the last tick
  ToolContact contact_;
  bool follows_ = false;  // the stretch is limited: the shaft rests, or the spring still follows
  SlipLimit slip_;
  TurnLimit turn_limit_;
  double per_tick_;        // ProxySettings::slip  [m]
  bool rubs_;              // ProxySettings::parts_rub
  Friction friction_;      // while the shaft touches
  double lever_ = kLever;  // L
  bool turns_ = false;     // the torque is felt
};

}  // namespace burr::haptics
