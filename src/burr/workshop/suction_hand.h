// workshop/suction_hand.h - a second haptic device in the other hand: it leads a suction tube,
// which rests on the bone (tick/second_hand.h) and takes water, dust and blood off what it comes
// near (render/wound.h). It never changes bone, and nothing of it is recorded.
//
//     auto hand = SuctionHand::join(*session, "touch:Left", start, view);
//     each frame:   hand->lay(view);  const SuctionHand::Seen seen = hand->now();
//
// Thread: main.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/sim/session.h"
#include "burr/workshop/hand_device.h"

namespace burr::workshop {

class SuctionHand {
 public:
  static constexpr double kRadius = 1.5e-3;  // of the tube [m]

  // Where its tip begins, and the axes of the view; its button that mills stops the suction while
  // it is down, its clutch lifts. Before the session starts, which keeps the device. Error: as
  // lay_hand().
  [[nodiscard]] static Result<std::unique_ptr<SuctionHand>> join(sim::Session& session,
                                                                 const std::string& device,
                                                                 const math::Pose& start,
                                                                 const math::Quat& world_from_view);

  struct Seen {
    math::Pose world_from_tool;  // where the bone lets it be
    math::Vec3 force = math::Vec3::Zero();
    bool there = false;  // the device knows where it is
    bool sucks = false;
  };
  [[nodiscard]] Seen now();
  void lay(const math::Quat& world_from_view) { hand_.lay(world_from_view); }
  // By the user's emergency stop.
  void lift(bool lifted) { hand_.lift(lifted); }
  [[nodiscard]] const device::Device& hand() const { return hand_; }

 private:
  SuctionHand(sim::Session& session, device::MappedHand& hand) : session_(session), hand_(hand) {}

  sim::Session& session_;
  device::MappedHand& hand_;
  tick::TickRow row_;
};

}  // namespace burr::workshop
