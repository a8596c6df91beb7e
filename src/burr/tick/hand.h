// tick/hand.h - one hand of a session, either one: its device, touch, force law, guard and limit.
//
//     used = hand.read(lost, flags)          the reading of this tick; may it be used?
//     used:   hand.filter_velocity();        velocity
//             if (hand.engage()) hand.feel();      or feel_held_tool(), while the servo holds the
//     tool else:   hand.skip_touch();
//     force = hand.limit_energy(hand.wanted(), ...)  optional: the energy guard
//     sent  = hand.send(force, flags)        bounded, to the device
//     hand.report(contact, flags)
//
// The hand is engaged from the first tick in which its tool is in free air, until it is lifted, or
// lost, or released. Before that it feels nothing. A hand that hovers feels nothing either.
//
// Thread: servo; reports of faults() one reader, any. Frame: world. Units: SI. Memory: taken at
// construction.
#pragma once

#include <cstdint>

#include "burr/device/device.h"
#include "burr/haptics/contact.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/safety/energy_guard.h"
#include "burr/haptics/safety/limit.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/haptics/touch_method.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tick/fault_report.h"

namespace burr::tick {

struct HandSettings {
  double rate_hz = 1000;
  double velocity_filter_hz = 100;  // of the hand's velocity, first order
  haptics::LimitSettings limit;
  bool guarded = false;        // by the energy guard
  double guard_slack = 60e-6;  // that the guard lets pass, energy_guard.h               [J]
  bool turned = true;          // by the torque of a contact, where the device has torque
};

class Hand {
 public:
  // constraint: the proxy of this hand's tool. It alone can tell whether a place is free, and the
  // hand touches with it until use(). force: read in every tick.
  Hand(device::Device& device, haptics::Proxy& constraint, const haptics::ForceSettings& force,
       const HandSettings& settings);

  // Touches with this method from now on.
  // tool: the same method, where it is that of a tool of any shape.
  void use(haptics::TouchMethod& method, haptics::ToolTouch* tool = nullptr) BURR_RT {
    method_ = &method;
    tool_ = tool;
  }

  // ---- the steps of a tick
  // False: the reading cannot be used, the force fades. lost: as Servo::tick().
  [[nodiscard]] bool read(bool lost, std::uint32_t& flags) BURR_RT;
  void filter_velocity() BURR_RT { velocity_ += blend_ * (state_.velocity - velocity_); }
  // False: not engaged, and the tool is not in free air.
  [[nodiscard]] bool engage() BURR_RT;
  void feel() BURR_RT;
  // Instead of feel(): what was found together with another tool (haptics/six/two_tools.h).
  void feel(const haptics::SixTouch& six) BURR_RT {
    touch_ = method_->felt(six, state_.world_from_tool);
    parts_ = method_->parts();
  }
  // For it, after engage(); nullptr: this hand's tool has no such proxy, or hovers.
  [[nodiscard]] haptics::SixProxy* six() BURR_RT { return hovers() ? nullptr : method_->six(); }
  // Where it is wanted (touch_method.h).
  [[nodiscard]] math::Pose goal() const BURR_RT { return method_->goal(state_.world_from_tool); }
  [[nodiscard]] double stiffness() const BURR_RT { return force_.stiffness; }
  // Instead of engage(), with a method whose tool goes to the hand by itself (held_piece.h).
  void hold() BURR_RT { engaged_ = true; }
  // Instead of feel(): the hand is there and holds nothing.
  void hold_nothing() BURR_RT {
    if (engaged_) lift();
    touch_ = {};
    parts_ = nullptr;
    touch_.proxy = state_.world_from_tool.p;
  }
  // Instead of feel(): the hand feels a spring to the tool, which others hold.
  void feel_held_tool() BURR_RT;
  // Instead of all these: no usable reading.
  void skip_touch() BURR_RT;
  // The force of touch, unbounded.
  [[nodiscard]] math::Vec3 wanted() const BURR_RT {
    return haptics::force_law(touch_, velocity_, force_);
  }
  // What of it may be sent without giving the hand more energy than it gave.
  [[nodiscard]] math::Vec3 limit_energy(const math::Vec3& wanted, bool begins_anew,
                                        std::uint32_t& flags) BURR_RT;
  // Bounded (haptics/safety/limit.h) and to the device; what the device got.
  struct Sent {
    math::Vec3 force = math::Vec3::Zero(), torque = math::Vec3::Zero();
  };
  Sent send(const math::Vec3& force, std::uint32_t& flags) BURR_RT;
  // What acts beside touch: of the cut and the motor.
  struct Beside {
    math::Vec3 force = math::Vec3::Zero();   // of the cut and the vibration      [N]
    math::Vec3 moment = math::Vec3::Zero();  // of the cut about the tip          [N m]
    math::Vec3 twist = math::Vec3::Zero();   // of the motor about the shaft      [N m]
  };
  // The torque of touch goes along where the device can turn the hand.
  Sent send(const math::Vec3& force, const Beside& beside, std::uint32_t& flags) BURR_RT;
  // The part of the sent force that comes from touch; also passed to the energy guard.
  math::Vec3 touch_part(const Sent& sent, const Beside& beside) BURR_RT;
  // What touch found, for the row; adds its flags.
  void report(const Sent& sent, haptics::Contact& contact) const BURR_RT;

  // ---- a hand that hovers (device/hand_state.h)
  [[nodiscard]] bool hovers() const BURR_RT { return (state_.buttons & device::kHovers) != 0; }
  // Before engage(): the tool goes to where the hand is, if it is free there.
  void set_down() BURR_RT;

  // ---- between the steps
  // The hand was lifted on purpose, or bone may come back where the tool is: the force fades.
  void lift() BURR_RT {
    limit_.lift();
    engaged_ = false;
  }
  // The same, as a fault.
  void release(std::uint32_t flag, std::uint32_t& flags) BURR_RT {
    limit_.fault(flag, flags);
    engaged_ = false;
  }
  // Touch begins again in free air; the force goes on.
  void disengage() BURR_RT { engaged_ = false; }
  // Puts the tool there, whether it is free or not.
  void place(const math::Vec3& p) BURR_RT { method_->place(p); }
  void begin_at(const math::Pose& world_from_tool) BURR_RT {
    if (tool_ != nullptr)
      tool_->place(world_from_tool);
    else
      place(world_from_tool.p);
    engaged_ = true;
  }
  void set_user_force(double newton) BURR_RT;

  // ---- as of the last step
  [[nodiscard]] const device::HandState& state() const BURR_RT { return state_; }
  [[nodiscard]] const haptics::Touch& touch() const BURR_RT { return touch_; }
  [[nodiscard]] const math::Vec3& tool() const BURR_RT { return method_->position(); }
  [[nodiscard]] math::Vec3 axis() const BURR_RT {  // of the tool, unit, towards the hand
    return state_.world_from_tool.q * math::Vec3::UnitZ();
  }
  // How it is turned: as the hand, unless contact turned it away.
  [[nodiscard]] math::Quat tool_turn() const BURR_RT {
    return tool_ != nullptr ? tool_->pose().q : state_.world_from_tool.q;
  }
  // What the parts of the tool carry; nullptr: a ball alone touches.
  [[nodiscard]] const haptics::ToolContact* parts() const BURR_RT { return parts_; }
  [[nodiscard]] const math::Vec3& velocity() const BURR_RT { return velocity_; }  // filtered [m/s]
  [[nodiscard]] bool tool_is_free() BURR_RT {
    return tool_ != nullptr ? tool_->is_free(tool_->pose())
                            : constraint_.is_free(method_->position());
  }
  [[nodiscard]] bool engaged() const BURR_RT { return engaged_; }
  // Neither feels nor cuts, and will not until it was in free air once.
  [[nodiscard]] bool released() const BURR_RT { return !engaged_ || !limit_.engaged(); }
  [[nodiscard]] const device::DeviceSpec& spec() const BURR_RT { return device_.spec(); }
  // The torque of a contact is sent to it.
  [[nodiscard]] bool turned() const BURR_RT { return turned_; }
  [[nodiscard]] FaultKeeper& faults() BURR_RT { return faults_; }

 private:
  [[nodiscard]] bool free_at(const math::Pose& world_from_tool) BURR_RT {
    return tool_ != nullptr ? tool_->is_free(world_from_tool)
                            : constraint_.is_free(world_from_tool.p);
  }

  // Of the contact about the tip, as in the world  [N m]
  [[nodiscard]] math::Vec3 contact_torque() const BURR_RT {
    return parts_ == nullptr ? math::Vec3(math::Vec3::Zero())
                             : math::Vec3(force_.stiffness * parts_->torque);
  }
  [[nodiscard]] double most_torque(double user_force) const BURR_RT;

  device::Device& device_;
  haptics::Proxy& constraint_;
  const haptics::ForceSettings& force_;
  haptics::TouchMethod* method_;
  haptics::ToolTouch* tool_ = nullptr;           // method_, or nullptr
  const haptics::ToolContact* parts_ = nullptr;  // of this tick
  double dt_;
  double blend_;  // of the velocity filter, in one tick
  bool guarded_, turned_;
  haptics::EnergyGuard guard_;
  haptics::ForceLimit limit_;
  device::HandState state_;
  math::Vec3 velocity_ = math::Vec3::Zero();  // filtered
  haptics::Touch touch_;
  bool engaged_ = false;  // the proxy is somewhere free and follows the hand
  FaultKeeper faults_;
};

}  // namespace burr::tick
