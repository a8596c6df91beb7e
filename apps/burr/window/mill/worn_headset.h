// apps/burr/window/mill/worn_headset.h - a headset on the page for milling: pictures for both eyes,
// and a wand as the hand.
//
// Thread: main. Frame: world. Units: SI.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "burr/mouse/mouse_hand.h"
#include "burr/render/camera.h"
#include "burr/render/governor.h"
#include "burr/render/headset.h"
#include "burr/render/scene.h"
#include "burr/tick/rows.h"
#include "window/ui/desk.h"

namespace burr::app {

class WornHeadset {
 public:
  explicit WornHeadset(Desk& desk) : desk_(desk) {}

  // Begins a frame. Starts or stops the headset as requested. Returns a message about that, "" for
  // none.
  [[nodiscard]] std::string begin(render::FrameGovernor& governor, const render::Camera& camera);
  void end(const render::Scene& scene);
  // The controller vibrates with the force of this tick while it is the hand and bone is removed. Once a picture.
  // rests: a page is open, or the work is stopped.
  void feel(const tick::TickRow& row, bool rests);
  void take_off();

  [[nodiscard]] bool shows() const { return seen_.has_value(); }
  // cameras of both eyes; nullptr: the headset is not worn
  [[nodiscard]] const render::Camera* cameras() const {
    return shows() ? cameras_.data() : nullptr;
  }
  [[nodiscard]] bool wand() const { return wand_; }  // the wand is the hand
  [[nodiscard]] bool trigger() const { return wand_at_.tracked && wand_at_.trigger > 0; }
  // The aim of the hand: the end of the wand is the head of the burr, its back is the handle. none:
  // nothing was seen in this frame. A wand that is not tracked gives an invalid aim, which the
  // servo judges.
  [[nodiscard]] std::optional<mouse::MouseHand::Aim> aim(const render::Camera& camera,
                                                         bool rests) const;

 private:
  std::string look_for_it();

  Desk& desk_;
  bool on_ = false, wand_ = false;
  std::optional<render::Headset::Now> seen_;  // of the frame begun
  std::array<render::Camera, 2> cameras_;
  render::Wand wand_at_;
  double removed_ = 0;  // of the newest tick that was felt [m^3]
  std::optional<std::chrono::steady_clock::time_point> cut_at_;  // bone was last removed
};

}  // namespace burr::app
