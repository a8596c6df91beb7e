// apps/burr/window/mill/worn_headset.h - a headset at the page: both eyes' pictures, and a wand as the hand.
//
// Thread: main. Frame: world. Units: SI.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "burr/render/camera.h"
#include "burr/render/governor.h"
#include "burr/render/headset.h"
#include "burr/render/scene.h"
#include "window/hands/mouse_hand.h"
#include "window/shell/desk.h"

namespace burr::app {

class WornHeadset {
 public:
  explicit WornHeadset(Desk& desk) : desk_(desk) {}

  // Begins a frame: puts a headset on or takes it off as the settings want. Returns what is to be
  // told of that, "" for nothing.
  [[nodiscard]] std::string begin(render::FrameGovernor& governor, const render::Camera& camera);
  void end(const render::Scene& scene);
  void take_off();

  [[nodiscard]] bool shows() const { return seen_.has_value(); }
  // of both eyes; nullptr: nobody looks
  [[nodiscard]] const render::Camera* cameras() const {
    return shows() ? cameras_.data() : nullptr;
  }
  [[nodiscard]] bool wand() const { return wand_; }  // it is the hand
  [[nodiscard]] bool trigger() const { return wand_at_.tracked && wand_at_.trigger > 0; }
  // The wand's end is the burr's head, its back the handle; none while nothing is seen. What is not
  // known of it goes to the servo as it is.
  [[nodiscard]] std::optional<MouseHand::Aim> aim(const render::Camera& camera, bool rests) const;

 private:
  std::string look_for_it();

  Desk& desk_;
  bool on_ = false, wand_ = false;
  std::optional<render::Headset::Now> seen_;  // the frame begun
  std::array<render::Camera, 2> cameras_;
  render::Wand wand_at_;
};

}  // namespace burr::app
