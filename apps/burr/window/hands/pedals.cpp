#include "window/hands/pedals.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burr::app {
namespace {

constexpr double kLetGo = 0.1;  // of its way; below it the pedal counts as released
constexpr int kMostAxes = 3;    // a heel plate and two toes

bool may_be_pedal(SDL_Joystick* stick) {
  const SDL_JoystickType type = SDL_JoystickGetType(stick);
  return SDL_JoystickNumAxes(stick) <= kMostAxes &&
         (type == SDL_JOYSTICK_TYPE_UNKNOWN || type == SDL_JOYSTICK_TYPE_THROTTLE);
}

double down_of(SDL_Joystick* stick, const PedalMap& map) {
  double down = SDL_JoystickGetButton(stick, map.mill) != 0 ? 1 : 0;
  if (SDL_JoystickNumAxes(stick) > 0) {
    const double at = std::clamp(SDL_JoystickGetAxis(stick, 0) / 32767.0, -1.0, 1.0);
    down = std::max(down, std::abs(at - map.rest) / (map.rest == 0 ? 1 : 2));
  }
  return down;
}

}  // namespace

Pedals::Pedals() : started_(SDL_InitSubSystem(SDL_INIT_JOYSTICK) == 0) { scan(); }

Pedals::~Pedals() {
  for (SDL_Joystick* pedal : pedals_) SDL_JoystickClose(pedal);
  if (started_) SDL_QuitSubSystem(SDL_INIT_JOYSTICK);
}

void Pedals::scan() {
  if (!started_) return;
  std::vector<SDL_Joystick*> found;
  for (int n = 0; n < SDL_NumJoysticks(); ++n) {
    if (SDL_IsGameController(n) == SDL_TRUE) continue;
    SDL_Joystick* stick = SDL_JoystickOpen(n);
    if (stick == nullptr) continue;
    if (may_be_pedal(stick))
      found.push_back(stick);
    else
      SDL_JoystickClose(stick);
  }
  if (found != pedals_) disarm();
  for (SDL_Joystick* pedal : pedals_) SDL_JoystickClose(pedal);  // each was opened a second time
  pedals_ = std::move(found);
  SDL_JoystickUpdate();  // until this call SDL reports everything as released
}

double Pedals::now(const PedalMap& map) {
  double down = 0;
  for (SDL_Joystick* pedal : pedals_)
    if (SDL_JoystickGetAttached(pedal) == SDL_TRUE) down = std::max(down, down_of(pedal, map));
  if (down < kLetGo) armed_ = true;
  return armed_ ? std::clamp((down - kLetGo) / (1 - kLetGo), 0.0, 1.0) : 0;
}

bool Pedals::clutched(const PedalMap& map) const {
  return std::any_of(pedals_.begin(), pedals_.end(), [&map](SDL_Joystick* pedal) {
    return SDL_JoystickGetAttached(pedal) == SDL_TRUE &&
           SDL_JoystickGetButton(pedal, map.clutch) != 0;
  });
}

Pedals::Step Pedals::step(const SDL_Event& event, const PedalMap& map) const {
  if (event.type != SDL_JOYBUTTONDOWN) return Step::none;
  const bool ours = std::any_of(pedals_.begin(), pedals_.end(), [&](SDL_Joystick* pedal) {
    return SDL_JoystickInstanceID(pedal) == event.jbutton.which;
  });
  if (!ours || event.jbutton.button == map.mill) return Step::none;
  if (event.jbutton.button == map.burr) return Step::burr;
  if (event.jbutton.button == map.tool) return Step::tool;
  return event.jbutton.button == map.coolant ? Step::coolant : Step::none;
}

}  // namespace burr::app
