// device/mapping.h - maps a real hand into the world: aligns its axes with the view, scales its
// movement, and moves it elsewhere while it is lifted.
//
//     p = at + scale * turn * (hand - from)        force on the hand = turn^-1 * force at the tip
//
// A wall of stiffness k at the tip is felt as scale * k by the hand. So the specification that
// touch sees has its stiffness and damping divided by scale: no wall is stiffer than the device can
// show. Turning is not scaled. A move in the world does scale times the work of the hand's move; so
// that a turn does too, a torque of the world is felt divided by scale (DeviceSpec::scale; the tick
// divides), and the device's numbers of turning are multiplied by it. Turning the view turns the
// hand's axes as soon as force and torque are zero, and nothing is carried; it never moves the tip.
//
// Thread: set_axes() main; lift() any; the rest as Device. Frames: inside, the device's own as its
// driver states it, x right, y up, z to the user; outside, world (LPS).
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "burr/device/device.h"
#include "burr/rt/latest.h"

namespace burr::device {

struct MappingSettings {
  double scale = 1;                          // movement of the tip / movement of the hand; 0.1..10
  math::Quat axes = math::Quat::Identity();  // hand_from_device, as the device is set up (axes.h)
  int clutch_button = 1;                     // lifts the hand while pressed; -1: none
  bool dead_man = false;  // lifted unless the mill button or the foot pedal is pressed
  int mill_button = 0;    // full pedal while pressed; -1: none
};

class MappedHand final : public Device {
 public:
  // start: pose of the tip when the session begins, in free air; world_from_hand: axes of the view
  // at that time
  MappedHand(std::unique_ptr<Device> device, const math::Pose& start,
             const math::Quat& world_from_hand, const MappingSettings& settings = {});

  // Sets the hand's axes; they apply as soon as the force is zero.
  void set_axes(const math::Quat& world_from_hand) { turns_.publish(world_from_hand); }
  // Lifts the hand from outside, in addition to the button: by a pedal or a key.
  void lift(bool lifted) BURR_RT { lifted_.store(lifted, std::memory_order_relaxed); }
  // true: the hand carries something while its pedal or mill button is down. New axes then apply only after both are
  // released; otherwise what is carried would turn at once.
  void carry(bool carries) { carries_.store(carries, std::memory_order_relaxed); }
  // Sets the foot pedal, 0..1. The larger of it and the mill button's value counts.
  void press(double pedal) BURR_RT { pedal_.store(pedal, std::memory_order_relaxed); }

  // A second open() does nothing, so the device may be opened early to ask for its rate.
  Status open() override;
  // Changes the settings. Only while the device is open, before the session.
  Status set(const MappingSettings& settings);
  void close() override {
    device_->close();
    open_ = false;
  }
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override;
  void write_torque(const math::Vec3& torque) BURR_RT override {
    torque_ = torque;
    device_->write_torque(turn_.conjugate() * torque);
  }
  void scale_force(double scale) BURR_RT override { device_->scale_force(scale); }
  [[nodiscard]] rt::TickClock* clock(double rate_hz) override { return device_->clock(rate_hz); }
  void stop_pacing() override { device_->stop_pacing(); }
  [[nodiscard]] std::int64_t arrived_ns() const BURR_RT override { return device_->arrived_ns(); }
  [[nodiscard]] bool take_stats(LinkStats& newest) override { return device_->take_stats(newest); }
  [[nodiscard]] std::string trouble() const override { return device_->trouble(); }
  [[nodiscard]] bool finished() const BURR_RT override { return device_->finished(); }

 private:
  std::unique_ptr<Device> device_;
  MappingSettings settings_;
  DeviceSpec spec_;
  rt::Latest<math::Quat> turns_;
  std::atomic<bool> lifted_ = false, carries_ = false;
  std::atomic<double> pedal_ = 0;

  // used only on the servo
  math::Quat requested_axes_;                  // world_from_hand, as last requested
  math::Quat turn_, requested_;                // world_from_device
  math::Vec3 at_, from_ = math::Vec3::Zero();  // the tip and the hand at the same moment
  math::Vec3 tip_;
  math::Vec3 forced_ = math::Vec3::Zero(), twisted_ = math::Vec3::Zero();
  math::Vec3 torque_ = math::Vec3::Zero();  // of the next force
  math::Quat held_ = math::Quat::Identity();
  bool anchored_ = false;
  bool open_ = false;
};

}  // namespace burr::device
