// mouse/mouse_hand.h - the simulated hand of the window: an arm that follows the
// mouse, or the wand that the wearer of a headset holds.
//
//     main --aim(target)--> Latest --> servo: state() moves a mass on a spring and a damper,
//                                      or sets it down at the target while it hovers
//
// The arm is that of device/simulated_hand.h. Its target moves no faster than a hand, so that a
// mouse that jumps across the picture does not throw the burr. A pose that is not finite, or that
// is marked as lost, is passed on as it is: the safety layer (haptics/safety/limit.h) judges it,
// not this class. Thread: aim() main; state() and write_force() servo. Frame: world. Units: SI.
#pragma once

#include <atomic>

#include "burr/device/device.h"
#include "burr/device/mapping.h"
#include "burr/device/simulated_hand.h"
#include "burr/rt/latest.h"
#include "burr/workshop/device_book.h"

namespace burr::mouse {

class MouseHand final : public device::Device {
 public:
  // highest speed of the target: for a mouse, that of a brisk hand; a wand is followed as fast as
  // it moves  [m/s]
  static constexpr double kMousePace = 0.25, kWandPace = 1.5;
  // The target of the arm.
  struct Aim {
    math::Pose world_from_tool;
    double pedal = 0;  // 0..1
    double pace = kMousePace;
    bool valid = true;  // false: the position of the hand is not known
    // The hand is set down there at once and feels nothing (device/hand_state.h, kHovers).
    bool hovers = false;
  };

  // start: position of the hand when the session begins; it must be in the air
  explicit MouseHand(const math::Pose& start);

  void aim(const Aim& aim) { aims_.publish(aim); }

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override;
  void scale_force(double scale) BURR_RT override {
    scale_.store(scale, std::memory_order_relaxed);
  }

 private:
  rt::Latest<Aim> aims_;
  device::ArmSettings arm_;
  device::DeviceSpec spec_;
  // used by the servo thread only
  Aim aim_;
  math::Vec3 gliding_ = math::Vec3::Zero();  // the target, moving at the pace of a hand
  math::Quat q_ = math::Quat::Identity();
  math::Vec3 p_ = math::Vec3::Zero(), velocity_ = math::Vec3::Zero(), force_ = math::Vec3::Zero();
  std::atomic<double> scale_ = 1.0;
};

}  // namespace burr::mouse
namespace burr::workshop {
class SuctionHand;
}
namespace burr::mouse {

// The hand that the page uses: exactly one of `mouse` and `real` is set. `suction`: the second
// hand.
struct Hands {
  MouseHand* mouse = nullptr;
  device::MappedHand* real = nullptr;        // a haptic device
  double max_force = 1e3;                    // the lower of the user's limit for it and its own [N]
  workshop::SuctionHand* suction = nullptr;  // nullptr: none
  std::string id = {};                       // the device's key in the book of preferences
  workshop::DevicePreferences preferences = {};  // its preferences in that book
};

}  // namespace burr::mouse
