// apps/burr/window/mill/mill_hand.h - the user's hand on the page for milling: where mouse, wand, pads
// and SpaceMouse aim the arm, how deep and fast they press, and when a haptic device is lifted or
// stopped; and measuring, because then the hand picks points and does not mill.
//
//     hand.button(true);      // mill_input.cpp: what the mouse did
//     hand.take_pads();       // in each picture: gamepad, SpaceMouse, pedals, keys that are held
//     hand.point();           // the servo gets the aim
//
// Thread: main; the aim goes to the servo through the mouse's hand. Frame: world. Units: SI.
#pragma once

#include <SDL2/SDL.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

#include "burr/mouse/mouse_aim.h"
#include "window/hands/pedals.h"
#include "window/mill/hand_plane.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_tools.h"
#include "window/mill/mill_view.h"
#include "window/mill/piece_carrier.h"
#include "window/mill/pointer.h"
#include "window/mill/press.h"
#include "window/mill/worn_headset.h"
#include "window/parts/hud.h"
#include "window/parts/measuring.h"

namespace burr::app {

class MillHand {
 public:
  static constexpr double kDeeper = 1.25;  // a key changes the depth of the press by this factor

  MillHand(const MillSite& site, Pointer& pointer, const WornHeadset& headset, MillView& view,
           MillTools& tools, const PieceCarrier& pieces);

  void begin();          // before the session starts
  void take_settings();  // the depth of the press, if the user has changed it there
  // The step of the case wants this depth; the user may change it.
  void propose_press(double depth) { press_.begin_at(depth); }

  // ---- what the user does
  void button(bool down) { press_.button(down); }
  void toggle_hold() { press_.toggle_hold(); }
  void push(double factor);
  // Changes the depth: of the press, if the hand follows the bone; of the plane, if it is in its plane.
  void deepen(double steps);
  // Not for a haptic device or a wand, because they have a position of their own.
  void toggle_plane();
  [[nodiscard]] bool in_plane() const { return plane_.on(); }
  // A key that moves the hand while it is held: Ctrl and an arrow, or the keypad's. False: it is none.
  bool aim_key(const SDL_Keysym& pressed, bool down);
  void lift();  // stops pressing, whatever pressed
  void lift_by_key(bool down) { lifts_.by_key = down; }
  // The user's emergency stop of both hands; called again, it ends the stop.
  void stop_or_go_on();
  [[nodiscard]] bool stopped() const { return lifts_.stopped; }
  void next_measure();
  void stop_measure();
  void pick_point();

  // ---- in each picture
  void take_pads();  // a stick that is pushed moves the point, the view, the press
  void point();      // aims the arm: above the bone under the mouse, or into it while it is pressed
  void measure();    // the thickness at the burr: along the contact normal, or below the burr
  void show_plane() { plane_.show(scene_); }

  // ---- what is so now
  [[nodiscard]] bool pressing() const;
  [[nodiscard]] bool pressed_by_pad() const { return press_.by_pad(); }
  [[nodiscard]] bool pad_lifts() const { return pad_lifts_; }
  [[nodiscard]] const Measuring& measuring() const { return measuring_; }
  // The lower of the settings' limit and the user's limit for this device  [N]
  [[nodiscard]] double user_limit() const {
    return std::min(desk_.settings.force_limit_n, hands_.max_force);
  }
  // What the hand works on: where it touches, or the bone below it.
  [[nodiscard]] math::Vec3 work() const;
  // The bone below a hand that follows it and hovers.
  [[nodiscard]] std::optional<math::Vec3> below() const {
    return hands_.real == nullptr ? aim_.bone_below() : std::nullopt;
  }
  void tell(HudState& hud) const;  // press and force limit

 private:
  using Clock = std::chrono::steady_clock;

  void point_in_plane(const render::Ray& ray);
  void align_real_hand();
  void lift_real_hand();
  void look_for_hands();
  void move_by_pads(const PadSticks& pad, const CapMotion& cap, double dt);

  Desk& desk_;
  sim::Session& session_;
  render::Scene& scene_;
  const mouse::Hands& hands_;
  const tick::TickRow& row_;
  MillNotes& notes_;
  MillOver& over_;
  Pointer& pointer_;
  const WornHeadset& headset_;
  MillView& view_;
  MillTools& tools_;
  const PieceCarrier& pieces_;
  Press press_;
  double usual_mm_ = 0;  // the press of the settings that was taken last
  HandPlane plane_;
  struct Lifts {  // haptic device: stopped by the user; lifted by key or foot, to be moved
    bool stopped = false, by_key = false, by_foot = false;
  } lifts_;
  std::array<bool, 4> aim_keys_ = {};  // these keys are held: left, right, down, up
  bool pad_lifts_ = false;
  int hands_there_ = -1;
  Clock::time_point hands_taken_{};
  mouse::MouseAim aim_;
  Measuring measuring_;
};

// The user's choice of pedals.
[[nodiscard]] PedalMap pedal_map(const Settings& settings);

}  // namespace burr::app
