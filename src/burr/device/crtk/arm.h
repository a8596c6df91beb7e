// device/crtk/arm.h - burr as a robot arm with the CRTK interface: other programs drive it, watch
// it and record it, over DDS with the topic names of ROS 2.
//
//     auto arm = Arm::open({.name = "/burr"});
//     arm->publish(report);                                       // at any rate
//     Session::make(bone, std::make_unique<DrivenHand>(*arm, start), ...)  // others drive it
//
// Publishes: measured_cp (pose of the burr, kept outside the bone), setpoint_cp (pose that was
// commanded), measured_cv, body/measured_cf and spatial/measured_cf (force of the bone on the
// burr), operating_state (ENABLED, PAUSED, DISABLED, or FAULT: enabled, but without contact until
// the burr has been in free air). Subscribes: servo_cp, move_cp, state_command (enable disable
// pause resume home unhome), and spindle (a Joy whose first axis is the pedal, 0..1). The arm has
// no joints, so there is no servo_jp and no measured_js. A goal is ignored and counted if its stamp
// is 0, if its quaternion is not of unit length, or if it lies more than a metre from
// ArmSettings::middle.
//
// Frame: the bone's world (LPS) [m] for everything; the handle is the tool's +z. Source: CRTK Robot
// API.
// Thread: open() and the destructor on main; publish() on one thread; take() on one thread,
// wait-free. The listener has a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/device/device.h"

namespace burr::device::crtk {

struct ArmSettings {
  std::string name = "/burr";
  int domain = -1;                         // DDS domain; below 0: ROS_DOMAIN_ID, else 0
  bool network = false;                    // programs on other computers may drive and watch it
  math::Vec3 middle = math::Vec3::Zero();  // goals more than a metre from here are ignored
};

enum class ArmState { enabled, paused, disabled };

// The newest goal that another program has sent to the arm.
struct ArmGoal {
  enum class Kind { stay, servo, move, home };
  Kind kind = Kind::stay;
  math::Pose goal;           // for servo and move
  std::uint64_t number = 0;  // a new number for every new motion
  double spindle = 0;        // 0..1
  ArmState state = ArmState::enabled;
};

// The state of the arm, to be published.
struct ArmReport {
  math::Pose measured, setpoint;
  math::Vec3 velocity = math::Vec3::Zero();  // [m/s]
  math::Vec3 force = math::Vec3::Zero();     // of the bone on the burr, at its centre [N]
  bool busy = false;                         // a move is under way
  bool released = false;                     // no contact until it has been in free air
};

class Arm {
 public:
  // Error: the name is not valid, the bus cannot be opened, or an arm of that name exists already.
  [[nodiscard]] static Result<std::unique_ptr<Arm>> open(const ArmSettings& settings);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  void publish(const ArmReport& report);
  // False: there is nothing new.
  [[nodiscard]] bool take(ArmGoal& newest) BURR_RT;
  [[nodiscard]] int domain() const;
  // True: other computers can reach it, because settings or environment ask for it (reach.h).
  [[nodiscard]] bool on_network() const;
  // Number of goals ignored so far. Thread: any.
  [[nodiscard]] std::uint64_t ignored_goals() const;

 private:
  struct Connection;
  explicit Arm(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

// A hand that follows the goals of an arm: servo_cp at no more than kServoSpeed [m/s]; move_cp and
// home along a straight line that begins and ends at rest. While the arm is disabled, the hand is
// lifted off the bone: it neither touches nor cuts.
class DrivenHand final : public Device {
 public:
  static constexpr double kServoSpeed = 0.5, kMoveSpeed = 0.05, kMoveAcceleration = 0.5;
  static constexpr double kTurnSpeed = 6;  // [rad/s]

  // start: its first pose, which is also its home
  DrivenHand(Arm& arm, const math::Pose& start);

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3&) BURR_RT override {}  // published by Arm::publish() instead
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] bool busy() const BURR_RT { return busy_.load(std::memory_order_relaxed); }

 private:
  void step(double dt) BURR_RT;

  Arm& arm_;
  DeviceSpec spec_;
  math::Pose home_, at_, goal_;
  ArmGoal command_;
  math::Vec3 velocity_ = math::Vec3::Zero();
  double speed_ = 0;  // along a move [m/s]
  std::atomic<bool> busy_ = false;
};

}  // namespace burr::device::crtk
