#include "window/ui/pointer_truth.h"

namespace burr::app {
namespace {

bool changes_focus(const SDL_Event& event) {
  if (event.type != SDL_WINDOWEVENT) return false;
  switch (event.window.event) {
    case SDL_WINDOWEVENT_FOCUS_GAINED:
    case SDL_WINDOWEVENT_FOCUS_LOST:
    case SDL_WINDOWEVENT_ENTER:
    case SDL_WINDOWEVENT_LEAVE:
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_HIDDEN:
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_MINIMIZED:
    case SDL_WINDOWEVENT_RESTORED:
      return true;
    default:
      return false;
  }
}

}  // namespace

bool PointerTruth::next(SDL_Event& event) {
  SDL_Event newest = {};
  while (events_.empty() && SDL_PollEvent(&newest) != 0) {
    if (changes_focus(newest)) asks_ = true;
    correct(newest);
  }
  if (events_.empty()) {
    if (asks_) look();
    if (swallowed_ != 0) look_for_presses();
  }
  if (events_.empty()) return false;
  event = events_.front();
  events_.pop_front();
  return true;
}

// Up is believed only if the pointer says so before and after SDL has taken what has come: an event that
// is still under way is not a lost one.
void PointerTruth::look() {
  asks_ = false;
  const Uint32 before = SDL_GetGlobalMouseState(nullptr, nullptr);
  SDL_PumpEvents();
  const Uint32 believed = SDL_GetMouseState(nullptr, nullptr);
  const Uint32 after = SDL_GetGlobalMouseState(nullptr, nullptr);
  const Uint32 lost = believed & ~before & ~after & ~swallowed_;
  for (Uint8 button = SDL_BUTTON_LEFT; button <= SDL_BUTTON_X2; ++button)
    if ((lost & SDL_BUTTON(button)) != 0) add(button, false);
  swallowed_ |= lost;
}

// SDL reports no press of a button that it believes is down.
void PointerTruth::look_for_presses() {
  const Uint32 down = SDL_GetGlobalMouseState(nullptr, nullptr) & swallowed_;
  if (down == 0 || SDL_GetMouseFocus() == nullptr) return;
  for (Uint8 button = SDL_BUTTON_LEFT; button <= SDL_BUTTON_X2; ++button)
    if ((down & SDL_BUTTON(button)) != 0) add(button, true);
  swallowed_ &= ~down;
}

void PointerTruth::add(Uint8 button, bool down) {
  SDL_Event event = {};
  event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
  event.button.timestamp = SDL_GetTicks();
  if (SDL_Window* window = SDL_GetMouseFocus()) event.button.windowID = SDL_GetWindowID(window);
  event.button.button = button;
  event.button.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.button.clicks = 1;
  SDL_GetMouseState(&event.button.x, &event.button.y);
  events_.push_back(event);
}

void PointerTruth::correct(const SDL_Event& event) {
  if (event.type == SDL_MOUSEBUTTONUP && (swallowed_ & SDL_BUTTON(event.button.button)) != 0) {
    // pressed and let go between two pictures
    swallowed_ &= ~SDL_BUTTON(event.button.button);
    add(event.button.button, true);
  }
  events_.push_back(event);
  if (event.type == SDL_MOUSEMOTION) events_.back().motion.state &= ~swallowed_;
}

}  // namespace burr::app
