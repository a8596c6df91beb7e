// Input other than the mouse: gamepad, pedals, SpaceMouse. They move the same point over the
// picture and press at it; their other buttons do the same as keys.
#include <SDL2/SDL.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {
namespace {

constexpr double kAimPace = 0.5;     // stick moved all the way  [heights of the picture / s]
constexpr double kDeepPace = 20e-3;  // cap moved all the way, for the plane  [m/s]
constexpr double kTurnPace = 300;    // the same for the view  [pixels of the mouse / s]
constexpr double kZoomPace = 1.2;    // the same for zooming  [factors of e / s]
constexpr double kLongest = 0.1;     // a longer picture does not move the point farther  [s]

PedalMap map_of(const Settings& settings) {
  const auto number = [](double value) { return static_cast<int>(std::lround(value)); };
  return {number(settings.pedal_mill),    number(settings.pedal_burr),
          number(settings.pedal_coolant), number(settings.pedal_clutch),
          number(settings.pedal_rest),    number(settings.pedal_tool)};
}

}  // namespace

void Mill::take_hands() {
  const Clock::time_point now = Clock::now();
  const double dt =
      std::clamp(std::chrono::duration<double>(now - hands_taken_).count(), 0.0, kLongest);
  hands_taken_ = now;
  look_for_hands();
  take_pads(dt);
}

void Mill::take_pads(double dt) {
  const Settings& settings = desk_.settings;
  const PadSticks pad = desk_.pads.now(settings.pad_dead);
  const CapMotion cap = desk_.cap.now(settings.pad_dead);
  const double foot = desk_.pedals.now(map_of(settings));
  lifts_.by_foot = desk_.pedals.clutched(map_of(settings));
  pad_lifts_ = pad.lifts;
  if (pad.lifts || page_open()) lift();
  press_.rest_pads();
  if (page_open()) return;

  for (const int button : cap.buttons) note(drill_.change_burr(button == 0 ? -1 : 1));
  const auto sum = [](double a, double b) { return std::clamp(a + b, -1.0, 1.0); };
  // over the bone, away means up, and down means press; in the plane the cap moves in three axes
  const bool in_plane = plane_.on();
  if (in_plane) plane_.push(kDeepPace * dt * settings.pad_pace * cap.away, scene_.camera);
  const auto held = [this](std::size_t back, std::size_t on) {
    return (aim_keys_[on] ? 1.0 : 0.0) - (aim_keys_[back] ? 1.0 : 0.0);
  };
  const double by = kAimPace * dt * settings.pad_pace;
  pointer_.move(by * sum(sum(pad.aim_right, cap.right), held(0, 1)),
                by * sum(sum(pad.aim_up, in_plane ? cap.up : cap.away), held(2, 3)));
  const double turn_up = pad.lifts ? 0 : pad.turn_up;
  if (pad.lifts)
    render::zoom(scene_.camera, std::exp(kZoomPace * settings.zoom_pace * pad.turn_up * dt));
  // the cap turns the bone, the stick turns the view
  turn_view(kTurnPace * dt * sum(pad.turn_right, -cap.twist),
            kTurnPace * dt * sum(turn_up, cap.tilt), false);

  if (pad.lifts) return;
  const double depth = std::max(pad.press, in_plane ? 0.0 : -std::min(cap.up, 0.0));
  press_.trigger(depth);
  if (depth > 0) pointer_.lead();
  press_.pedal(foot, pad.slow);
}

// A device that was unplugged while it pressed stops pressing, also if it had switched on holding.
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

void Mill::pad_button(Uint8 button) {
  constexpr Action kTools[] = {Action::cut, Action::add, Action::touch, Action::back,
                               Action::smooth};
  constexpr tick::ToolMode kModes[] = {tick::ToolMode::cut, tick::ToolMode::add,
                                       tick::ToolMode::touch, tick::ToolMode::restore,
                                       tick::ToolMode::smooth};
  const auto tool = [&](int by) {
    const int now = static_cast<int>(
        std::find(std::begin(kModes), std::end(kModes), drill_.mode()) - std::begin(kModes));
    act(kTools[(now + by + 5) % 5]);
  };
  if (button == SDL_CONTROLLER_BUTTON_BACK) return go_back();
  if (page_open()) {
    if (button == SDL_CONTROLLER_BUTTON_START || button == SDL_CONTROLLER_BUTTON_B) go_back();
    return;
  }
  switch (button) {
    case SDL_CONTROLLER_BUTTON_START:
      return pages_->toggle_help(true);
    case SDL_CONTROLLER_BUTTON_A:
      if (measuring_.picks()) pointer_.lead(), pick_point();
      return;
    case SDL_CONTROLLER_BUTTON_X:
      return pad_lifts_ ? note(drill_.toggle_coolant()) : act(Action::undo);
    case SDL_CONTROLLER_BUTTON_Y:
      return act(pad_lifts_ ? Action::measure : Action::redo);
    case SDL_CONTROLLER_BUTTON_LEFTSHOULDER:
      return pad_lifts_ ? next_tool(-1) : act(Action::smaller);
    case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER:
      return pad_lifts_ ? next_tool(1) : act(Action::larger);
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
      return push(kDeeper);
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
      return push(1 / kDeeper);
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
      return tool(-1);
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
      return tool(1);
    case SDL_CONTROLLER_BUTTON_LEFTSTICK:
      pointer_.lead();
      return press_.toggle_hold();
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
      return note(drill_.next_burr());
    case Pedals::Step::tool:
      return next_tool(1);
    case Pedals::Step::coolant:
      return note(drill_.toggle_coolant());
    case Pedals::Step::none:
      return;
  }
}

}  // namespace burr::app
