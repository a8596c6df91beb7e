// device/linked.h - base class of a device with a Link: the side that faces the tick, the same for
// every device that has a wire or the thread of a maker's library.
//
// Thread: as Device.
#pragma once

#include <memory>

#include "burr/device/device.h"
#include "burr/device/link.h"

namespace burr::device {

class LinkedDevice : public Device {
 public:
  [[nodiscard]] const DeviceSpec& spec() const final { return spec_; }
  [[nodiscard]] HandState state(double) BURR_RT final { return link_.state(); }
  void write_torque(const math::Vec3& torque) BURR_RT final { link_.write_torque(torque); }
  void write_force(const math::Vec3& force) BURR_RT final { link_.write_force(force); }
  void scale_force(double scale) BURR_RT final { link_.scale_force(scale); }
  [[nodiscard]] rt::TickClock* clock(double rate_hz) final {
    clock_ = std::make_unique<LinkClock>(link_, rate_hz);
    return clock_.get();
  }
  void stop_pacing() final { link_.never_wait(); }
  [[nodiscard]] std::int64_t arrived_ns() const BURR_RT final { return link_.arrived_ns(); }
  [[nodiscard]] bool take_stats(LinkStats& newest) final { return link_.take_stats(newest); }

 protected:
  explicit LinkedDevice(const LinkSettings& settings, Link::Now now = &rt::monotonic_ns)
      : link_(settings, now) {}

  Link link_;
  DeviceSpec spec_;  // valid while the device is open

 private:
  std::unique_ptr<LinkClock> clock_;
};

}  // namespace burr::device
