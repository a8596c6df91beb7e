// workshop/suction_hand.h - a second haptic device for the other hand (tick/second_hand.h). It moves a
// suction tube, which touches the bone, removes water, dust and blood near its mouth
// (render/wound.h), and never changes bone; or a tool of the rack, which cuts.
//
//     auto hand = SuctionHand::add(*session, "touch:Left", start, view, {});
//     each frame:   hand->set_axes(view);  const SuctionHand::Seen seen = hand->now();
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

  // start: where its tip starts; world_from_view: the axes of the view. tool: none, a suction tube.
  // Its mill button stops the suction while it is pressed, or drives the tool; its clutch button
  // lifts either. Call it before the session starts; the session owns the device. Error: see
  // open_hand() and Session::add_second_hand().
  [[nodiscard]] static Result<std::unique_ptr<SuctionHand>> add(
      sim::Session& session, const std::string& device, const math::Pose& start,
      const math::Quat& world_from_view, std::optional<tool::ShapedTool> tool);

  // The newest row of its hand.
  [[nodiscard]] const tick::TickRow& now();
  // nullptr: a suction tube.
  [[nodiscard]] const tool::Tool* tool() const;
  void set_axes(const math::Quat& world_from_view) { hand_.set_axes(world_from_view); }
  // It carries a piece of bone by its button: device/mapping.h.
  void carry(bool carries) { hand_.carry(carries); }
  // Called by the emergency stop.
  void lift(bool lifted) { hand_.lift(lifted); }
  [[nodiscard]] const device::Device& hand() const { return hand_; }

 private:
  SuctionHand(sim::Session& session, device::MappedHand& hand) : session_(session), hand_(hand) {}

  sim::Session& session_;
  device::MappedHand& hand_;
  tick::TickRow row_;
};

}  // namespace burr::workshop
