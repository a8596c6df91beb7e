// device/replayed_hand.h - a hand that does again what a recording says; whoever replays sets each
// reading.
//
// Thread: one. The force it is given goes nowhere.
#pragma once

#include "burr/device/device.h"

namespace burr::device {

class ReplayedHand final : public Device {
 public:
  // spec: of the device that was recorded; its limits are part of what happened
  explicit ReplayedHand(DeviceSpec spec) : spec_(std::move(spec)) {}

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double) BURR_RT override { return now_; }
  void write_force(const math::Vec3&) BURR_RT override {}

  // the reading the next tick gets
  void set(const HandState& hand) BURR_RT { now_ = hand; }

 private:
  DeviceSpec spec_;
  HandState now_;
};

}  // namespace burr::device
