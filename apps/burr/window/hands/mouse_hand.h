// apps/burr/window/hands/mouse_hand.h - the hand at the window: an arm that follows where the mouse
// points, or what a headset's wearer holds.
//
//     main --aim(target)--> Latest --> servo: state() moves a mass on a spring and a damper
//
// The arm is that of device/simulated_hand.h; its aim glides no faster than a hand does, so that a
// mouse that leaps over the picture does not throw the burr. What is not a place, or lost, is
// handed on as such: the safety layer (haptics/safety/limit.h) judges it, not the hand. Thread: aim()
// main; state() and write_force() servo. Frame: world. Units: SI.
#pragma once

#include <atomic>

#include "burr/device/device.h"
#include "burr/device/mapping.h"
#include "burr/device/simulated_hand.h"
#include "burr/rt/latest.h"
#include "burr/workshop/device_book.h"

namespace burr::app {

class MouseHand final : public device::Device {
 public:
  // how fast the aim may glide: of a mouse, a brisk hand; what is held is where it is  [m/s]
  static constexpr double kMousePace = 0.25, kWandPace = 1.5;
  // Where the arm is drawn to.
  struct Aim {
    math::Pose world_from_tool;
    double pedal = 0;  // 0..1
    double pace = kMousePace;
    bool valid = true;  // false: nobody knows where the hand is
  };

  // start: where the hand is when the session begins; in the air
  explicit MouseHand(const math::Pose& start);

  void aim(const Aim& aim) { aims_.publish(aim); }

  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override;
  void write_force(const math::Vec3& force) BURR_RT override;
  void hold(double scale) BURR_RT override { scale_.store(scale, std::memory_order_relaxed); }

 private:
  rt::Latest<Aim> aims_;
  device::ArmSettings arm_;
  device::DeviceSpec spec_;
  // the servo's own
  Aim aim_;
  math::Vec3 gliding_ = math::Vec3::Zero();  // the aim, at a hand's pace
  math::Quat q_ = math::Quat::Identity();
  math::Vec3 p_ = math::Vec3::Zero(), velocity_ = math::Vec3::Zero(), force_ = math::Vec3::Zero();
  std::atomic<double> scale_ = 1.0;
};

}  // namespace burr::app
namespace burr::workshop {
class SuctionHand;
}
namespace burr::app {

// The hand at the page, one of two, and what the other one may hold.
struct Hands {
  MouseHand* mouse = nullptr;
  device::MappedHand* real = nullptr;        // a haptic device
  double max_force = 1e3;                    // its user's own limit and its own [N]
  workshop::SuctionHand* suction = nullptr;  // in the other hand
  std::string id = {};  // of the device, in the book of what users request of it
  workshop::DevicePreferences preferences = {};  // what the book has for it
};

}  // namespace burr::app
