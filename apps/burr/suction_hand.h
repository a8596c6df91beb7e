// apps/burr/suction_hand.h - a second haptic device in the other hand: it leads a suction tube,
// which takes water, dust and blood off the bone it comes near (render/wound.h). It is seen and not
// felt: this device is never pushed, and nothing of it is recorded.
//
//     auto hand = SuctionHand::open("touch:Left", start, view);
//     each frame:   hand->lay(view);  const SuctionHand::Seen seen = hand->now();
//
// Thread: main; it reads the device on one of its own.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/rt/latest.h"
#include "burr/rt/thread.h"
#include "hand_device.h"

namespace burr::app {

class SuctionHand {
 public:
  static constexpr double kRadius = 1.5e-3;  // of the tube [m]

  // Where its tip begins, and the axes of the view; its button that mills stops the suction while
  // it is down, its clutch lifts. Error: as lay_hand().
  [[nodiscard]] static Result<std::unique_ptr<SuctionHand>> open(const std::string& device,
                                                                 const math::Pose& start,
                                                                 const math::Quat& world_from_view);
  ~SuctionHand();
  SuctionHand(const SuctionHand&) = delete;
  SuctionHand& operator=(const SuctionHand&) = delete;

  struct Seen {
    math::Pose world_from_tool;
    bool there = false;  // the device knows where it is
    bool sucks = false;
  };
  [[nodiscard]] Seen now();
  void lay(const math::Quat& world_from_view) { hand_->lay(world_from_view); }
  [[nodiscard]] std::string trouble() const { return hand_->trouble(); }
  [[nodiscard]] const device::DeviceSpec& spec() const { return hand_->spec(); }

 private:
  explicit SuctionHand(std::unique_ptr<device::MappedHand> hand);

  std::unique_ptr<device::MappedHand> hand_;
  rt::Latest<Seen> told_;
  Seen seen_;
  std::atomic<bool> stop_ = false;
  std::unique_ptr<rt::Thread> thread_;
};

}  // namespace burr::app
