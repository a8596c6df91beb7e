// device/pushed_hand.h - a hand that a program moves between the ticks: no bus, no script, no clock.
//
//     hand.place({p, q}, 0, 0);          // it is there in the next tick, at rest
//     hand.move({p2, q2}, 1, 0, 20);     // it is there after 20 ticks, evenly and straight
//     session.step(20, progress);
//
// With a stiff arm the hand is where it was told to be. With a softer one its goal moves so, and the
// hand is a mass on a spring and a damper that the bone pushes away (arm_motion.h).
// Thread: one: that of the ticks. Frame: world. Units: SI.
#pragma once

#include <cstdint>

#include "burr/device/arm_motion.h"
#include "burr/device/device.h"

namespace burr::device {

class PushedHand final : public Device {
 public:
  // arm: stiffness = infinity is a rigid hand.
  explicit PushedHand(const ArmSettings& arm, DeviceSpec spec = {});

  // It is there in the next tick and stands still, wherever it was. What it was told before is
  // forgotten.
  void place(const math::Pose& there, double pedal, std::uint32_t buttons) BURR_RT;
  // It is there after so many ticks; 0 counts as 1. The first move is a place().
  void move(const math::Pose& there, double pedal, std::uint32_t buttons,
            std::uint64_t ticks) BURR_RT;
  // Where it was told to be last.
  [[nodiscard]] const math::Pose& goal() const BURR_RT { return goal_; }
  // As the last tick read it.
  [[nodiscard]] const HandState& now() const BURR_RT { return now_; }

  // Forgets everything: the hand begins where it is told to be first, or at the origin.
  Status open() override;
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override { force_ = force; }

 private:
  ArmSettings arm_;
  DeviceSpec spec_;
  math::Pose goal_, target_;  // at the end of the move; in the last tick
  std::uint64_t left_ = 0;    // ticks until the goal
  bool placed_ = false, jumps_ = true;
  ArmMotion hand_;
  math::Vec3 force_ = math::Vec3::Zero();
  HandState now_;
};

}  // namespace burr::device
