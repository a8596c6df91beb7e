// tests/window/stick.h - a joystick that SDL plays, for gamepads and pedals at the window.
#pragma once

#include <gtest/gtest.h>

#include <SDL2/SDL.h>

namespace burr::app {

// Plugged in while it lives.
class Stick {
 public:
  Stick(SDL_JoystickType type, int axes, int buttons) {
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);
    // no window has the keyboard where there is no screen
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    const int index = SDL_JoystickAttachVirtual(type, axes, buttons, 0);
    EXPECT_GE(index, 0) << SDL_GetError();
    stick_ = SDL_JoystickOpen(index);
    EXPECT_NE(stick_, nullptr) << SDL_GetError();
    id_ = SDL_JoystickInstanceID(stick_);
  }
  Stick(const Stick&) = delete;
  Stick& operator=(const Stick&) = delete;
  ~Stick() {
    pull_out();
    if (stick_ != nullptr) SDL_JoystickClose(stick_);
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  }
  void axis(int which, int value) const {
    EXPECT_EQ(SDL_JoystickSetVirtualAxis(stick_, which, static_cast<Sint16>(value)), 0);
  }
  void button(int which, bool down) const {
    EXPECT_EQ(SDL_JoystickSetVirtualButton(stick_, which, down ? 1 : 0), 0);
  }
  void pull_out() {
    for (int n = 0; n < SDL_NumJoysticks(); ++n)
      if (SDL_JoystickGetDeviceInstanceID(n) == id_) SDL_JoystickDetachVirtual(n);
  }

 private:
  SDL_Joystick* stick_ = nullptr;
  SDL_JoystickID id_ = -1;
};

}  // namespace burr::app
