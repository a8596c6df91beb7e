#include "window/mill/mill_input.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "burr/render/pick.h"
#include "shared/word_names.h"
#include "window/mill/mill_keys.h"

namespace burr::app {
namespace {

constexpr Uint32 kSameClick = 50;      // after the window came to the front [ms]
constexpr Uint32 kFirstRepeat = 1000;  // a key that is held is repeated before that [ms]

// True: the window came to the front so short a time before that this is the same click.
bool same_click(const std::optional<std::uint32_t>& to_front, Uint32 now) {
  return to_front && now - *to_front < kSameClick;
}

// False: this press of Space acts now. A key that was already down when the window came to the front
// is reported as pressed as well, and must not act. Only its repeats show it. So in the first second
// a press does not act at once: it acts when the key is released, if no repeat came before.
bool held_before(std::optional<std::uint32_t>& to_front, const SDL_KeyboardEvent& space) {
  const bool soon = to_front && space.timestamp - *to_front < kFirstRepeat;
  if (space.repeat != 0 || !soon) to_front.reset();
  return space.repeat != 0 || soon;
}

}  // namespace

void MillInput::take_events() {
  SDL_Event event;
  while (desk_.next(event)) take(event);
}

void MillInput::take(const SDL_Event& event) {
  switch (event.type) {
    case SDL_QUIT:
      actions_.quit();
      break;
    case SDL_KEYDOWN:
      key_down(event.key);
      break;
    case SDL_KEYUP:
      key_up(event.key);
      break;
    case SDL_MOUSEMOTION:
      move(event.motion);
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      button(event.button);
      break;
    case SDL_MOUSEWHEEL:
      wheel(event.wheel);
      break;
    case SDL_CONTROLLERBUTTONDOWN:
      pad_button(event.cbutton.button);
      break;
    case SDL_JOYBUTTONDOWN:
      pedal_button(event);
      break;
    case SDL_MULTIGESTURE:  // two fingers on a touch screen
      render::zoom(scene_.camera, std::exp(4 * static_cast<double>(event.mgesture.dDist)));
      break;
    case SDL_WINDOWEVENT:
      window(event.window);
      break;
    default:
      break;
  }
}

void MillInput::key_down(const SDL_KeyboardEvent& key) {
  if (key.keysym.sym == SDLK_SPACE && held_before(to_front_, key)) return;
  if (desk_.ui().typing() || parts_.pieces.key(key.keysym) || parts_.hand.aim_key(key.keysym, true))
    return;
  // the dialog takes letters and arrows itself
  if (over_.pages->exporting().choosing() && key.keysym.sym != SDLK_ESCAPE) return;
  press_key(actions_, key.keysym, desk_.settings.left_handed);
}

void MillInput::key_up(const SDL_KeyboardEvent& key) {
  parts_.hand.aim_key(key.keysym, false);
  if (key.keysym.sym == SDLK_c) parts_.hand.lift_by_key(false);
  if (key.keysym.sym == SDLK_SPACE && std::exchange(to_front_, {}) && !desk_.ui().typing())
    parts_.hand.toggle_hold();
}

void MillInput::window(const SDL_WindowEvent& event) {
  if (event.event == SDL_WINDOWEVENT_FOCUS_LOST || event.event == SDL_WINDOWEVENT_MINIMIZED)
    parts_.hand.lift();
  if (event.event == SDL_WINDOWEVENT_FOCUS_GAINED) {
    parts_.hand.lift();  // a button that went down before needs a fresh press
    to_front_ = event.timestamp;
  }
}

void MillInput::move(const SDL_MouseMotionEvent& motion) {
  // over a panel the hand stays where it was
  if (over_.page() || desk_.ui().over_panel()) return;
  // an accidental movement of the mouse must not move a burr that a pad presses
  if (parts_.pointer.pad_leads() && parts_.hand.pressed_by_pad()) return;
  parts_.pointer.moved_to(motion.x, motion.y);
  if (parts_.pieces.has_piece()) parts_.pieces.drag(motion);
  const Uint32 turns = desk_.settings.left_handed ? SDL_BUTTON_LMASK : SDL_BUTTON_RMASK;
  if ((motion.state & turns) != 0 && pulls_window_) {
    const double edge = scene_.insets.empty() ? 1 : scene_.insets.front().width;
    parts_.view.slices().pull_window(motion.xrel / edge, -motion.yrel / edge);
  } else if ((motion.state & turns) != 0)
    parts_.view.turn(-motion.xrel, motion.yrel, false);
  if ((motion.state & SDL_BUTTON_MMASK) != 0) parts_.view.turn(-motion.xrel, motion.yrel, true);
}

void MillInput::button(const SDL_MouseButtonEvent& button) {
  const Uint8 mills = desk_.settings.left_handed ? SDL_BUTTON_RIGHT : SDL_BUTTON_LEFT;
  if (button.button != mills && button.button != SDL_BUTTON_MIDDLE)
    pulls_window_ = button.type == SDL_MOUSEBUTTONDOWN && parts_.pointer.over_slices();
  if (button.button != mills) return;
  if (parts_.hand.measuring().picks()) {
    const bool down = button.type == SDL_MOUSEBUTTONDOWN;
    if (!down || over_.page() || desk_.ui().over_panel() || parts_.pointer.over_slices()) return;
    return parts_.hand.pick_point();
  }
  // The click that brought the window to the front does not mill, nor a press that began on a
  // panel. Every later press counts.
  parts_.hand.button(button.type == SDL_MOUSEBUTTONDOWN &&
                     !same_click(to_front_, button.timestamp) && !desk_.ui().over_panel());
}

void MillInput::wheel(const SDL_MouseWheelEvent& wheel) {
  if (over_.page() || desk_.ui().over_panel()) return;
  const double by =
      wheel.preciseY != 0 ? static_cast<double>(wheel.preciseY) : static_cast<double>(wheel.y);
  const SDL_Keymod held = SDL_GetModState();
  const bool ctrl = (held & KMOD_CTRL) != 0;
  if ((held & KMOD_ALT) != 0) {
    if (by != 0 && (held & KMOD_SHIFT) != 0) return parts_.tools.lean(by > 0 ? 1 : -1);
    if (by != 0) return parts_.tools.roll(by > 0 ? 1 : -1);
  }
  if ((held & KMOD_SHIFT) != 0 && !ctrl) {
    if (by != 0) notes_.note(parts_.tools.drill().change_burr(by > 0 ? 1 : -1));
  } else if (parts_.hand.in_plane() != ctrl) {
    parts_.hand.deepen(by);
  } else {
    parts_.view.magnify(by * desk_.settings.zoom_pace);
  }
}

void MillInput::pad_button(Uint8 button) {
  constexpr Action kTools[] = {Action::cut, Action::add, Action::touch, Action::back,
                               Action::smooth};
  constexpr tick::ToolMode kModes[] = {tick::ToolMode::cut, tick::ToolMode::add,
                                       tick::ToolMode::touch, tick::ToolMode::restore,
                                       tick::ToolMode::smooth};
  MillHand& hand = parts_.hand;
  Drill& drill = parts_.tools.drill();
  const auto tool = [&](int by) {
    const int now = static_cast<int>(std::find(std::begin(kModes), std::end(kModes), drill.mode()) -
                                     std::begin(kModes));
    actions_.act(kTools[(now + by + 5) % 5]);
  };
  if (button == SDL_CONTROLLER_BUTTON_BACK) return actions_.go_back();
  if (over_.page()) {
    if (button == SDL_CONTROLLER_BUTTON_A) return actions_.answer();
    if (button == SDL_CONTROLLER_BUTTON_START || button == SDL_CONTROLLER_BUTTON_B)
      actions_.go_back();
    return;
  }
  switch (button) {
    case SDL_CONTROLLER_BUTTON_START:
      return over_.pages->toggle_help(true);
    case SDL_CONTROLLER_BUTTON_A:
      if (hand.measuring().picks()) parts_.pointer.lead(), hand.pick_point();
      return;
    case SDL_CONTROLLER_BUTTON_X:
      return hand.pad_lifts() ? notes_.note(drill.toggle_coolant()) : actions_.act(Action::undo);
    case SDL_CONTROLLER_BUTTON_Y:
      return actions_.act(hand.pad_lifts() ? Action::measure : Action::redo);
    case SDL_CONTROLLER_BUTTON_LEFTSHOULDER:
      return hand.pad_lifts() ? parts_.tools.next(-1) : actions_.act(Action::smaller);
    case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER:
      return hand.pad_lifts() ? parts_.tools.next(1) : actions_.act(Action::larger);
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
      return hand.push(MillHand::kDeeper);
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
      return hand.push(1 / MillHand::kDeeper);
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
      return tool(-1);
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
      return tool(1);
    case SDL_CONTROLLER_BUTTON_LEFTSTICK:
      parts_.pointer.lead();
      return hand.toggle_hold();
    case SDL_CONTROLLER_BUTTON_RIGHTSTICK:
      return actions_.keep();
    default:
      return;
  }
}

void MillInput::pedal_button(const SDL_Event& event) {
  if (over_.page()) return;
  switch (desk_.pedals.step(event, pedal_map(desk_.settings))) {
    case Pedals::Step::burr:
      return notes_.note(parts_.tools.drill().next_burr());
    case Pedals::Step::tool:
      return parts_.tools.next(1);
    case Pedals::Step::coolant:
      return notes_.note(parts_.tools.drill().toggle_coolant());
    case Pedals::Step::none:
      return;
  }
}

}  // namespace burr::app
