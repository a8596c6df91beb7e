// What hands other than the mouse's do at the page: gamepad, pedals, SpaceMouse. They move the
// same point over the picture and press at it; what they ask for goes where keys go.
#include <SDL2/SDL.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "window/mill/mill.h"
#include "window/shell/words.h"

namespace burr::app {
namespace {

constexpr double kAimPace = 0.5;     // of a stick all the way  [heights of the picture / s]
constexpr double kDeepPace = 20e-3;  // of a cap all the way, of the plane  [m/s]
constexpr double kTurnPace = 300;    // the same for the view  [pixels of the mouse / s]
constexpr double kZoomPace = 1.2;    // e-fold in a second
constexpr double kLongest = 0.1;     // a picture that took longer moves no farther  [s]

PedalMap map_of(const Settings& settings) {
  const auto number = [](double value) { return static_cast<int>(std::lround(value)); };
  return {number(settings.pedal_mill), number(settings.pedal_burr), number(settings.pedal_coolant),
          number(settings.pedal_clutch), number(settings.pedal_rest)};
}

}  // namespace

void Mill::take_hands() {
  const Clock::time_point now = Clock::now();
  const double dt =
      std::clamp(std::chrono::duration<double>(now - hands_taken_).count(), 0.0, kLongest);
  hands_taken_ = now;
  look_for_hands();

  const Settings& settings = desk_.settings;
  const PadSticks pad = desk_.pads.now(settings.pad_dead);
  const CapMotion cap = desk_.cap.now(settings.pad_dead);
  const double foot = desk_.pedals.now(map_of(settings));
  foot_lifts_ = desk_.pedals.clutched(map_of(settings));
  pad_lifts_ = pad.lifts;
  if (pad.lifts || page_open()) lift();
  depth_ = foot_ = 0;
  if (page_open()) return;

  for (const int button : cap.buttons) change_burr(button == 0 ? -1 : 1);
  const auto sum = [](double a, double b) { return std::clamp(a + b, -1.0, 1.0); };
  // over the bone a cap's away is up, and down is in; before a plane it is a hand of three axes
  const bool in_plane = plane_.on();
  if (in_plane) plane_.push(kDeepPace * dt * settings.pad_pace * cap.away, scene_.camera);
  const auto held = [this](std::size_t back, std::size_t on) {
    return (aim_keys_[on] ? 1.0 : 0.0) - (aim_keys_[back] ? 1.0 : 0.0);
  };
  move_aim(sum(sum(pad.aim_right, cap.right), held(0, 1)),
           sum(sum(pad.aim_up, in_plane ? cap.up : cap.away), held(2, 3)), dt * settings.pad_pace);
  const double turn_up = pad.lifts ? 0 : pad.turn_up;
  if (pad.lifts)
    render::zoom(scene_.camera, std::exp(kZoomPace * settings.zoom_pace * pad.turn_up * dt));
  // the bone turns with the cap, the eye with the stick
  turn_view(kTurnPace * dt * sum(pad.turn_right, -cap.twist),
            kTurnPace * dt * sum(turn_up, cap.tilt), false);

  if (pad.lifts) return;
  depth_ = std::max(pad.press, in_plane ? 0.0 : -std::min(cap.up, 0.0));
  if (depth_ > 0) lead();
  foot_ = foot;
  slowed_ = pad.slow;
}

// One that was pulled out while it pressed presses no more; nor does what was held on by it.
void Mill::look_for_hands() {
  const int there = desk_.pads.count() + desk_.pedals.count();
  if (there < hands_there_) {
    lift();
    note(word(Word::hand_gone));
  } else if (there > hands_there_ && hands_there_ >= 0) {
    note(word(Word::hand_here));
  }
  hands_there_ = there;
}

// From the mouse to the cursor of the pad; where the mouse was, unless it was nowhere.
void Mill::lead() {
  if (leads_) return;
  leads_ = true;
  const bool nowhere =
      !mouse_moved_ || aim_x_ < 0 || aim_y_ < 0 || aim_x_ >= width_ || aim_y_ >= height_ ||
      desk_.ui().over_panel(static_cast<float>(aim_x_), static_cast<float>(aim_y_));
  pad_x_ = nowhere ? 0.5 * width_ : aim_x_;
  pad_y_ = nowhere ? 0.5 * height_ : aim_y_;
  mouse_x_ = static_cast<int>(pad_x_);
  mouse_y_ = static_cast<int>(pad_y_);
  aim_at_mouse();
  SDL_ShowCursor(SDL_DISABLE);
}

void Mill::mouse_leads() {
  mouse_moved_ = true;
  if (std::exchange(leads_, false)) SDL_ShowCursor(SDL_ENABLE);
}

// One way at a time, so that it slides along panels instead of sticking to them.
void Mill::move_aim(double right, double up, double dt) {
  if (right == 0 && up == 0) return;
  lead();
  const double by = kAimPace * height_ * dt;
  const auto go = [this](double x, double y) {
    x = std::clamp(x, 0.0, width_ - 1.0);
    y = std::clamp(y, 0.0, height_ - 1.0);
    if (desk_.ui().over_panel(static_cast<float>(x), static_cast<float>(y))) return;
    const int was_x = mouse_x_, was_y = mouse_y_;
    mouse_x_ = static_cast<int>(x);
    mouse_y_ = static_cast<int>(y);
    if (over_slices()) {
      mouse_x_ = was_x;
      mouse_y_ = was_y;
      return;
    }
    pad_x_ = x;
    pad_y_ = y;
  };
  go(pad_x_ + by * right, pad_y_);
  go(pad_x_, pad_y_ - by * up);
  aim_at_mouse();
}

void Mill::pad_button(Uint8 button) {
  constexpr Action kTools[] = {Action::cut, Action::add, Action::touch, Action::back,
                               Action::smooth};
  constexpr tick::ToolMode kModes[] = {tick::ToolMode::cut, tick::ToolMode::add,
                                       tick::ToolMode::touch, tick::ToolMode::restore,
                                       tick::ToolMode::smooth};
  const auto tool = [&](int by) {
    const int now = static_cast<int>(std::find(std::begin(kModes), std::end(kModes), mode_) -
                                     std::begin(kModes));
    act(kTools[(now + by + 5) % 5]);
  };
  if (button == SDL_CONTROLLER_BUTTON_BACK) return go_back();
  if (page_open()) {
    if (button == SDL_CONTROLLER_BUTTON_START || button == SDL_CONTROLLER_BUTTON_B) go_back();
    return;
  }
  switch (button) {
    case SDL_CONTROLLER_BUTTON_START:
      act(Action::help);
      help_pads_ = true;
      return;
    case SDL_CONTROLLER_BUTTON_A:
      if (measuring_.picks()) lead(), pick_point();
      return;
    case SDL_CONTROLLER_BUTTON_X:
      return pad_lifts_ ? toggle_coolant() : act(Action::undo);
    case SDL_CONTROLLER_BUTTON_Y:
      return act(pad_lifts_ ? Action::measure : Action::redo);
    case SDL_CONTROLLER_BUTTON_LEFTSHOULDER:
      return change_burr(-1);
    case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER:
      return change_burr(1);
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
      return push(1.25);
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
      return push(1 / 1.25);
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
      return tool(-1);
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
      return tool(1);
    case SDL_CONTROLLER_BUTTON_LEFTSTICK:
      lead();
      held_ = !held_;
      return;
    case SDL_CONTROLLER_BUTTON_RIGHTSTICK:
      return keep();
    default:
      return;
  }
}

void Mill::pedal_button(const SDL_Event& event) {
  if (page_open()) return;
  switch (desk_.pedals.step(event, map_of(desk_.settings))) {
    case Pedals::Step::burr:
      return next_burr();
    case Pedals::Step::coolant:
      return toggle_coolant();
    case Pedals::Step::none:
      return;
  }
}

// Where the pad points, in light and dark, so that it is seen on bone and beside it; a dot in it
// while it presses.
void Mill::draw_cursor() const {
  if (!leads_ || page_open()) return;
  const float u = desk_.ui().unit();
  const float from_window =
      static_cast<float>(desk_.renderer().width()) / static_cast<float>(std::max(1, width_));
  const ImVec2 at = {static_cast<float>(pad_x_) * from_window,
                     static_cast<float>(pad_y_) * from_window};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  constexpr ImU32 kDark = ink::rgb(0, 0, 0, 200), kLight = ink::rgb(255, 255, 255);
  for (const auto& [ink, wide] : {std::pair{kDark, 4 * u}, std::pair{kLight, 1.75F * u}}) {
    list.AddCircle(at, 11 * u, ink, 32, wide);
    for (const auto& [x, y] : {std::pair{1.F, 0.F}, {-1.F, 0.F}, {0.F, 1.F}, {0.F, -1.F}})
      list.AddLine({at.x + 8 * u * x, at.y + 8 * u * y}, {at.x + 15 * u * x, at.y + 15 * u * y},
                   ink, wide);
  }
  if (!pressing()) return;
  list.AddCircleFilled(at, 4.5F * u, kDark);
  list.AddCircleFilled(at, 3 * u, kLight);
}

}  // namespace burr::app
