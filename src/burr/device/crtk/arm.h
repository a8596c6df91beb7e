// device/crtk/arm.h - burr as a robot's arm that speaks CRTK: others drive it, watch it and record
// it, on DDS with the names of ROS 2.
//
//     auto arm = Arm::open({.name = "/burr"});
//     arm->tell(told);                                            // as often as one likes
//     Session::make(bone, std::make_unique<DrivenHand>(*arm, start), ...)  // others drive it
//
// out: measured_cp (the burr where the bone lets it be), setpoint_cp (where it was told to be),
// measured_cv, body/measured_cf and spatial/measured_cf (the bone's push on the burr),
// operating_state (ENABLED, PAUSED, DISABLED, or FAULT: enabled, but let go of until it was in free
// air). in: servo_cp, move_cp, state_command (enable disable pause resume home unhome), and spindle
// (a Joy whose first axis is the pedal, 0..1).
// It has no joints, so servo_jp and measured_js are not there. Goals with a stamp of 0, without a
// unit turn, or a metre away are left aside and counted.
//
// Frame: of all, the bone's world (LPS) [m]; the handle is the tool's +z. Source: CRTK Robot API.
// Thread: open() and its end main; tell() one thread; take() one thread, wait-free. The listener is
// a thread of its own.
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
  int domain = -1;                         // of DDS; below 0: ROS_DOMAIN_ID, else 0
  math::Vec3 middle = math::Vec3::Zero();  // goals farther than a metre from it are left aside
};

enum class ArmState { enabled, paused, disabled };

// What others want of the arm.
struct ArmGoal {
  enum class Kind { stay, servo, move, home };
  Kind kind = Kind::stay;
  math::Pose goal;           // of servo and move
  std::uint64_t number = 0;  // another one for every new motion
  double spindle = 0;        // 0..1
  ArmState state = ArmState::enabled;
};

// What the arm says of itself.
struct ArmReport {
  math::Pose measured, setpoint;
  math::Vec3 velocity = math::Vec3::Zero();  // [m/s]
  math::Vec3 force = math::Vec3::Zero();     // of the bone on the burr, at its centre [N]
  bool busy = false;                         // moves by itself
  bool let_go = false;                       // touches nothing until it was in free air
};

class Arm {
 public:
  // Error: no such name, the bus cannot be opened, or another arm of that name is there.
  [[nodiscard]] static Result<std::unique_ptr<Arm>> open(const ArmSettings& settings);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  void tell(const ArmReport& told);
  // False: nothing new.
  [[nodiscard]] bool take(ArmGoal& newest) BURR_RT;
  [[nodiscard]] int domain() const;
  // Goals that could not be followed, so far; any thread.
  [[nodiscard]] std::uint64_t left_aside() const;

 private:
  struct Talk;
  explicit Arm(std::unique_ptr<Talk> talk);
  std::unique_ptr<Talk> talk_;
};

// A hand that does what others ask of an arm: servo_cp at no more than kServoSpeed, move_cp and
// home along a straight line that begins and ends at rest. Disabled it is lifted off the bone: it
// neither touches nor cuts.
class DrivenHand final : public Device {
 public:
  static constexpr double kServoSpeed = 0.5, kMoveSpeed = 0.05, kMoveAcceleration = 0.5;
  static constexpr double kTurnSpeed = 6;  // [rad/s]

  // start: where it begins and what its home is
  DrivenHand(Arm& arm, const math::Pose& start);

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3&) BURR_RT override {}  // told by Arm::tell()
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] bool busy() const BURR_RT { return busy_.load(std::memory_order_relaxed); }

 private:
  void step(double dt) BURR_RT;

  Arm& arm_;
  DeviceSpec spec_;
  math::Pose home_, at_, goal_;
  ArmGoal told_;
  math::Vec3 velocity_ = math::Vec3::Zero();
  double speed_ = 0;  // along a move
  std::atomic<bool> busy_ = false;
};

}  // namespace burr::device::crtk
