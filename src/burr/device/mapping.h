// device/mapping.h - a real hand laid over the bone: its axes along those of the view, its way
// larger or smaller than the tip's, laid elsewhere while it is lifted.
//
//     p = at + scale * turn * (hand - from)        force on the hand = turn^-1 * force at the tip
//
// A wall of k at the tip is felt as scale * k by the hand, so the specification that touch sees has
// its stiffness and damping divided by scale: no wall is stiffer than the device can show.
// Turning the view turns the hand's axes once nothing is pushed, and never moves the tip.
//
// Thread: lay() main; lift() any; the rest as Device. Frames: the device's own as its driver states
// it, x right, y up, z to the user; world (LPS) outside.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "burr/device/device.h"
#include "burr/rt/latest.h"

namespace burr::device {

struct MappingSettings {
  double scale = 1;                          // way of the tip over way of the hand; 0.1..10
  math::Quat axes = math::Quat::Identity();  // hand_from_device, as it stands (axes.h)
  int clutch_button = 1;                     // lifts the hand while it is down; -1: none
  bool dead_man = false;  // lifted unless the mill button is down, or the foot presses
  int mill_button = 0;    // full pedal while it is down; -1: none
};

class MappedHand final : public Device {
 public:
  // start: where the tip is when the session begins, in the air; world_from_hand: the axes of the
  // view then
  MappedHand(std::unique_ptr<Device> device, const math::Pose& start,
             const math::Quat& world_from_hand, const MappingSettings& settings = {});

  // The hand's axes from now on, as soon as nothing is pushed.
  void lay(const math::Quat& world_from_hand) { turns_.publish(world_from_hand); }
  // Lifted from outside, beside the button: by a pedal, or a key.
  void lift(bool lifted) BURR_RT { lifted_.store(lifted, std::memory_order_relaxed); }
  // Of the pedal under a foot, 0..1; the larger of it and the mill button's counts.
  void press(double pedal) BURR_RT { pedal_.store(pedal, std::memory_order_relaxed); }

  // Once it is open, again does nothing: its rate may be asked for before the session is made.
  Status open() override;
  // While it is open and before the session: other settings.
  Status set(const MappingSettings& settings);
  void close() override {
    device_->close();
    open_ = false;
  }
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override;
  void write_torque(const math::Vec3& torque) BURR_RT override {
    device_->write_torque(turn_.conjugate() * torque);
  }
  void hold(double scale) BURR_RT override { device_->hold(scale); }
  [[nodiscard]] rt::TickClock* clock(double rate_hz) override { return device_->clock(rate_hz); }
  void follow() override { device_->follow(); }
  [[nodiscard]] std::int64_t arrived_ns() const BURR_RT override { return device_->arrived_ns(); }
  [[nodiscard]] bool account(LinkAccount& newest) override { return device_->account(newest); }
  [[nodiscard]] std::string trouble() const override { return device_->trouble(); }
  [[nodiscard]] bool finished() const BURR_RT override { return device_->finished(); }

 private:
  std::unique_ptr<Device> device_;
  MappingSettings settings_;
  DeviceSpec spec_;
  rt::Latest<math::Quat> turns_;
  std::atomic<bool> lifted_ = false;
  std::atomic<double> pedal_ = 0;

  // the servo's own
  math::Quat laid_;                            // world_from_hand, as last requested
  math::Quat turn_, requested_;                // world_from_device
  math::Vec3 at_, from_ = math::Vec3::Zero();  // the tip, when the hand was there
  math::Vec3 tip_;
  math::Vec3 forced_ = math::Vec3::Zero();
  math::Quat held_ = math::Quat::Identity();
  bool anchored_ = false;
  bool open_ = false;
};

}  // namespace burr::device
