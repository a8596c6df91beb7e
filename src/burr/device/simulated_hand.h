// device/simulated_hand.h - a hand without a person: a mass on a spring and a damper, pulled along
// a path and pushed by the bone.
//
//     target(t) o--/\/\/--[ mass ]<-- force from the bone
//
// Measured values for a stylus held in the fingers: 0.03-0.1 kg, 2-5 N s/m, 100-300 N/m
// (docs/understand/safety_stability.md, "Devices and hands"); the default is a firm grip. stiffness
// = infinity is a rigid hand: it follows the path, whatever pushes it.
// Thread: state(), write_force() servo; scale_force() any. Frame: world. Units: SI.
#pragma once

#include <atomic>

#include "burr/device/arm_motion.h"
#include "burr/device/device.h"
#include "burr/device/hand_path.h"

namespace burr::device {

class SimulatedHand final : public Device {
 public:
  SimulatedHand(HandPath path, const ArmSettings& arm, DeviceSpec spec = {});

  Status open() override;
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override;
  void scale_force(double scale) BURR_RT override {
    scale_.store(scale, std::memory_order_relaxed);
  }
  [[nodiscard]] bool finished() const BURR_RT override { return time_ > path_.duration(); }

 private:
  HandPath path_;
  ArmSettings arm_;
  DeviceSpec spec_;
  std::size_t hint_ = 0;
  double time_ = 0;
  bool started_ = false;
  ArmMotion hand_;
  math::Vec3 force_ = math::Vec3::Zero(), target_ = math::Vec3::Zero();
  std::atomic<double> scale_ = 1.0;
};

}  // namespace burr::device
