#include "window/hands/gamepad.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burr::app {
namespace {

constexpr double kWhole = 32767;
constexpr double kLetGo = 0.1;  // of a trigger's way; below it the trigger counts as released

// squared, so that small movements stay fine
double eased(double share) { return share * share; }

}  // namespace

double beyond_dead(double axis, double dead) {
  const double share = std::clamp(axis / kWhole, -1.0, 1.0);
  const double beyond = (std::abs(share) - dead) / (1 - dead);
  return beyond > 0 ? std::copysign(eased(beyond), share) : 0;  // false for NaN, too
}

void calm_stick(double& right, double& up, double dead) {
  right = std::clamp(right / kWhole, -1.0, 1.0);
  up = std::clamp(up / kWhole, -1.0, 1.0);
  const double far = std::hypot(right, up);
  const double beyond = std::min(1.0, (far - dead) / (1 - dead));
  const double scale = beyond > 0 ? eased(beyond) / far : 0;
  right *= scale;
  up *= scale;
}

Gamepads::Gamepads() : started_(SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0) { scan(); }

Gamepads::~Gamepads() {
  for (SDL_GameController* pad : pads_) SDL_GameControllerClose(pad);
  if (started_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

void Gamepads::scan() {
  if (!started_) return;
  std::vector<SDL_GameController*> found;
  for (int n = 0; n < SDL_NumJoysticks(); ++n)
    if (SDL_IsGameController(n) == SDL_TRUE)
      if (SDL_GameController* pad = SDL_GameControllerOpen(n)) found.push_back(pad);
  if (found != pads_) disarm();
  // these were opened a second time above and are closed once here: SDL counts how often
  for (SDL_GameController* pad : pads_) SDL_GameControllerClose(pad);
  pads_ = std::move(found);
  SDL_GameControllerUpdate();  // until this call SDL reports every button as released
}

PadSticks Gamepads::now(double dead) {
  PadSticks all;
  double trigger = 0;
  for (SDL_GameController* pad : pads_) {
    if (SDL_GameControllerGetAttached(pad) == SDL_FALSE) continue;
    const auto axis = [pad](SDL_GameControllerAxis which) {
      return static_cast<double>(SDL_GameControllerGetAxis(pad, which));
    };
    const auto down = [pad](SDL_GameControllerButton which) {
      return SDL_GameControllerGetButton(pad, which) != 0;
    };
    double right = axis(SDL_CONTROLLER_AXIS_LEFTX), up = -axis(SDL_CONTROLLER_AXIS_LEFTY);
    calm_stick(right, up, dead);
    all.aim_right += right;
    all.aim_up += up;
    right = axis(SDL_CONTROLLER_AXIS_RIGHTX);
    up = -axis(SDL_CONTROLLER_AXIS_RIGHTY);
    calm_stick(right, up, dead);
    all.turn_right += right;
    all.turn_up += up;
    trigger = std::max(trigger, axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT) / kWhole);
    if (down(SDL_CONTROLLER_BUTTON_A)) trigger = 1;
    all.slow = std::max(all.slow, axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT) / kWhole);
    all.lifts = all.lifts || down(SDL_CONTROLLER_BUTTON_B);
  }
  for (double* way : {&all.aim_right, &all.aim_up, &all.turn_right, &all.turn_up})
    *way = std::clamp(*way, -1.0, 1.0);
  if (all.lifts)
    disarm();
  else if (trigger < kLetGo)
    armed_ = true;
  if (armed_) all.press = std::clamp((trigger - kLetGo) / (1 - kLetGo), 0.0, 1.0);
  all.slow = std::clamp((all.slow - kLetGo) / (1 - kLetGo), 0.0, 1.0);
  return all;
}

bool is_plug_event(const SDL_Event& event) {
  return event.type == SDL_JOYDEVICEADDED || event.type == SDL_JOYDEVICEREMOVED ||
         event.type == SDL_CONTROLLERDEVICEADDED || event.type == SDL_CONTROLLERDEVICEREMOVED;
}

bool as_key(SDL_Event& event) {
  if (event.type != SDL_CONTROLLERBUTTONDOWN && event.type != SDL_CONTROLLERBUTTONUP) return false;
  SDL_Keycode key = SDLK_UNKNOWN;
  switch (event.cbutton.button) {
    case SDL_CONTROLLER_BUTTON_A:
      key = SDLK_SPACE;
      break;
    case SDL_CONTROLLER_BUTTON_START:
      key = SDLK_RETURN;
      break;
    case SDL_CONTROLLER_BUTTON_B:
    case SDL_CONTROLLER_BUTTON_BACK:
      key = SDLK_ESCAPE;
      break;
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
      key = SDLK_UP;
      break;
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
      key = SDLK_DOWN;
      break;
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
      key = SDLK_LEFT;
      break;
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
      key = SDLK_RIGHT;
      break;
    default:
      return false;
  }
  const bool down = event.type == SDL_CONTROLLERBUTTONDOWN;
  event = {};
  event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
  event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.key.keysym.sym = key;
  event.key.keysym.scancode = SDL_GetScancodeFromKey(key);
  return true;
}

}  // namespace burr::app
