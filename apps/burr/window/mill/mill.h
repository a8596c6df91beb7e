// apps/burr/window/mill/mill.h - the page one works on, as one object: what a picture needs of the user,
// the session and the bone. Its parts are window.cpp (picture after picture), mill_hand.cpp (what
// the user does), mill_pads.cpp (the same with other hands than the mouse), mill_headset.cpp
// (whoever wears one) and mill_told.cpp (what the user is told); nothing else includes this.
//
// Thread: main. Frame: world. Units: SI.
#pragma once

#include <SDL2/SDL.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/render/governor.h"
#include "burr/rt/stats.h"
#include "window/mill/export_page.h"
#include "window/mill/hand_plane.h"
#include "window/mill/hud.h"
#include "window/mill/measuring.h"
#include "window/mill/mirror_mode.h"
#include "window/mill/saved_views.h"
#include "window/mill/slices.h"
#include "window/mill/toolbar.h"
#include "window/mill/window.h"
#include "window/shell/status_line.h"

namespace burr::app {

inline constexpr double kHover = 3e-3;         // above the bone while not pressing           [m]
inline constexpr double kPressLeast = 0.5e-3;  // how far below the surface the arm is aimed  [m]
inline constexpr double kPressMost = 6e-3;

class LiveSurface;

class Mill {
 public:
  Mill(Desk& desk, sim::Session& session, const Hands& hands, surface::Worker& worker,
       render::Scene& scene, const WindowOptions& options)
      : desk_(desk),
        session_(session),
        hands_(hands),
        worker_(worker),
        scene_(scene),
        options_(options),
        first_view_(scene.camera),
        mirror_(session.bone().grid()) {}

  Result<Left> run();

 private:
  using Clock = std::chrono::steady_clock;

  // ---- mill_hand.cpp
  void take_events();
  void key(const SDL_Keysym& pressed);
  bool aim_key(const SDL_Keysym& pressed, bool down);
  void move(const SDL_MouseMotionEvent& motion);
  void button(const SDL_MouseButtonEvent& button);
  void wheel(const SDL_MouseWheelEvent& wheel);
  void turn_view(double right, double up, bool shift);
  void act(Action action);
  void change_burr(int by);
  void change_speed(double by);
  void push(double factor);
  void deepen(double steps);
  void toggle_plane();
  void lift();
  void point();
  void point_in_plane(const render::Ray& ray);
  void aim_at(const math::Vec3& tip, double pedal);
  void lay_real_hand();
  void let_go(bool gone);
  void lead_suction(LiveSurface& live);
  void measure();
  void show_labels(bool shown);
  void toggle_sound();
  void toggle_coolant();
  void toggle_kind();
  void mirror(const SDL_Keysym& pressed);
  void tell_mirror();
  void show_task();
  void saved_view(int slot, bool keep);
  void go_back();
  void keep();
  void pick_point();
  void aim_at_mouse() {
    aim_x_ = mouse_x_;
    aim_y_ = mouse_y_;
  }
  [[nodiscard]] bool over_slices() const;
  [[nodiscard]] bool page_open() const {
    return help_ || settings_page_ || (export_ && export_->shown());
  }
  [[nodiscard]] bool pressing() const {
    return !let_go_ && (pressing_ || held_ || depth_ > 0 || foot_ > 0) && !measuring_.picks() &&
           !page_open() && !over_panel() && !over_slices();
  }
  // while a pad leads, the mouse may lie where it was left
  [[nodiscard]] bool over_panel() const { return !leads_ && desk_.ui().over_panel(); }
  // how far below the surface the arm is aimed while it presses, and the spindle's share  [m], [1]
  [[nodiscard]] double depth() const {
    const double share = pressing_ || held_ || foot_ > 0 ? 1 : depth_;
    return kPressLeast + share * (press_ - kPressLeast);
  }
  // of the settings, and what the user keeps for this device  [N]
  [[nodiscard]] double user_limit() const {
    return std::min(desk_.settings.force_limit_n, hands_.max_force);
  }
  [[nodiscard]] double pedal() const {
    return (pressing_ || held_ || depth_ > 0 ? 1 : foot_) * (1 - slowed_);
  }

  // ---- mill_pads.cpp
  void take_hands();
  void look_for_hands();
  void lead();
  void mouse_leads();
  void move_aim(double right, double up, double dt);
  void pad_button(Uint8 button);
  void pedal_button(const SDL_Event& event);
  void next_burr();
  void draw_cursor() const;

  // ---- mill_headset.cpp
  void look_for_headset();
  void begin_headset(render::FrameGovernor& governor);
  void end_headset();
  void take_off_headset();
  void point_wand();

  // ---- mill_told.cpp
  void look_at_session();
  void keep_device_preferences();
  void keep_fault_of(const device::Device& hand, const tick::FaultReport& fault);
  void look_at_burr();
  void tell();
  void note(std::string text);
  void panels();
  void leave_picture();
  [[nodiscard]] HudState hud() const;

  Desk& desk_;
  sim::Session& session_;
  Hands hands_;
  surface::Worker& worker_;
  render::Scene& scene_;
  WindowOptions options_;
  render::Camera first_view_;

  bool open_ = true, picture_ = false;
  Left left_ = Left::window;
  bool panels_ = true, help_ = false, help_pads_ = false, settings_page_ = false,
       settings_pads_ = false;
  int picture_step_ = 0;
  std::optional<Slices> slices_;
  std::optional<SavedViews> saved_views_;
  std::optional<ExportPage> export_;
  bool leaves_ = false;  // though a file is still being written
  bool irrigated_ = false;
  bool task_ = true, task_read_ = false;  // what is to be done is shown; bone was removed since
  bool slices_shown_ = true, labels_ = true, pulls_window_ = false;
  bool headset_on_ = false, wand_ = false;    // it was there; the wand is the hand
  std::optional<render::Headset::Now> seen_;  // the frame begun
  std::array<render::Camera, 2> headset_cameras_;
  render::Wand wand_at_;
  Clock::time_point window_drawn_{};
  std::vector<render::Colour> colours_;  // of the tissues, while labels are shown
  // a haptic device: stopped; only laid elsewhere, by key and by foot
  bool let_go_ = false, lifted_ = false, foot_lifts_ = false;
  bool pressing_ = false, held_ = false;  // by the button; by the space bar
  int mouse_x_ = 0, mouse_y_ = 0, width_ = 1, height_ = 1;
  int aim_x_ = 0, aim_y_ = 0;  // where the mouse was last that was no slice
  double press_ = 4e-3;
  HandPlane plane_;
  std::array<bool, 4> aim_keys_ = {};  // left, right, down, up: held
  // of pad, cap and pedal
  double depth_ = 0, foot_ = 0, slowed_ = 0;  // share of the press, of the pedal; spindle held back
  bool leads_ = false, pad_lifts_ = false, mouse_moved_ = false;
  double pad_x_ = 0, pad_y_ = 0;  // its cursor
  int hands_there_ = -1;
  Clock::time_point sucked_;  // until then the suction was led
  Clock::time_point hands_taken_{};
  math::Vec3 normal_ = math::Vec3::Zero();  // of the surface under the mouse, calmed
  std::optional<math::Vec3> point_;         // there
  tick::ToolMode mode_ = tick::ToolMode::cut;
  Measuring measuring_;
  MirrorMode mirror_;
  double full_speed_ = 0;                 // requested [rad/s]
  std::optional<double> burr_requested_;  // radius, until it is so or refused [m]
  Clock::time_point burr_requested_at_{};
  tick::TickRow row_;
  rt::TickStats stats_;
  std::optional<std::pair<std::uint64_t, Clock::time_point>> first_tick_;
  std::uint64_t missed_ = 0;
  Clock::time_point missed_at_{}, lost_at_{};
  std::optional<HudState::Nearest> nearest_;
  StatusLine told_;
  std::string note_, warning_;  // as they are shown
  Clock::time_point said_{};
};

// As flag_words(), but what has a sign of its own is left out, and in the user's language.
[[nodiscard]] std::string told_flags(std::uint32_t flags);

}  // namespace burr::app
