// device/replayed_hand.h - a hand that repeats the readings of a recording; the caller sets each
// reading.
//
// Thread: one. The force it is given is ignored.
#pragma once

#include "burr/device/device.h"

namespace burr::device {

class ReplayedHand final : public Device {
 public:
  // spec: of the device that was recorded; its limits had an effect on the recorded session
  explicit ReplayedHand(DeviceSpec spec) : spec_(std::move(spec)) {}

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double) BURR_RT override { return now_; }
  void write_force(const math::Vec3&) BURR_RT override {}

  // the reading for the next tick
  void set(const HandState& hand) BURR_RT { now_ = hand; }

 private:
  DeviceSpec spec_;
  HandState now_;
};

}  // namespace burr::device
