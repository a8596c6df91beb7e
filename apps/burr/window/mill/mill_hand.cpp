// The user's actions on the page: keys, buttons, and the mouse as a hand.
#include <SDL2/SDL.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "burr/render/pick.h"
#include "burr/tick/second_hand.h"
#include "burr/workshop/work_view.h"
#include "shared/window_session.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kPlaneStep = 0.5e-3;  // of the plane, per step of the wheel  [m]
constexpr double kProbe = 6e-3;        // of the thickness, beyond the burr [m]
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

void Mill::take_events() {
  SDL_Event event;
  while (desk_.next(event)) switch (event.type) {
      case SDL_QUIT:
        open_ = false;
        break;
      case SDL_KEYDOWN:
        if (event.key.keysym.sym == SDLK_SPACE && held_before(to_front_, event.key)) break;
        if (!desk_.ui().typing() && !piece_key(event.key.keysym) &&
            !aim_key(event.key.keysym, true))
          key(event.key.keysym);
        break;
      case SDL_KEYUP:
        aim_key(event.key.keysym, false);
        if (event.key.keysym.sym == SDLK_c) lifts_.by_key = false;
        if (event.key.keysym.sym == SDLK_SPACE && std::exchange(to_front_, {}) &&
            !desk_.ui().typing())
          press_.toggle_hold();
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
        if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST ||
            event.window.event == SDL_WINDOWEVENT_MINIMIZED)
          lift();
        if (event.window.event == SDL_WINDOWEVENT_FOCUS_GAINED) {
          lift();  // a button that went down before needs a fresh press
          to_front_ = event.window.timestamp;
        }
        break;
      default:
        break;
    }
}

// Handles the keys that move the hand while they are held: Ctrl and an arrow, or the keypad's.
// False: this key is none of them.
bool Mill::aim_key(const SDL_Keysym& pressed, bool down) {
  constexpr SDL_Keycode kArrows[] = {SDLK_LEFT, SDLK_RIGHT, SDLK_DOWN, SDLK_UP};
  constexpr SDL_Keycode kPad[] = {SDLK_KP_4, SDLK_KP_6, SDLK_KP_2, SDLK_KP_8};
  const bool ctrl = (pressed.mod & KMOD_CTRL) != 0;
  for (std::size_t n = 0; n < aim_keys_.size(); ++n) {
    const bool arrow = pressed.sym == kArrows[n];
    if (!arrow && pressed.sym != kPad[n]) continue;
    if (down && ((arrow && !ctrl) || hands_.real != nullptr)) return false;
    aim_keys_[n] = down;
    return true;
  }
  return false;
}

void Mill::show_task() {
  if (!options_.work_case) return note(word(Word::task_none));
  // the task, the steps, nothing
  leaf_ = leaf_ == Leaf::task && steps_offered()        ? Leaf::steps
          : leaf_ == Leaf::task || leaf_ == Leaf::steps ? Leaf::none
                                                        : Leaf::task;
}

// Closes what is open on the page; if nothing is, the page itself.
void Mill::go_back() {
  if (page_open()) {
    pages_->close();
  } else if (menu_) {
    menu_.reset();
  } else if (measuring_.on()) {
    measuring_.stop();
    note(word(Word::measure_off));
  } else {
    leave();
  }
}

void Mill::keep() {
  note(word(options_.keep && options_.keep() ? Word::session_kept : Word::session_not_kept));
}

void Mill::act(Action action) {
  if (!allows(action)) return say_refused();
  const auto command = [this](tick::CommandKind kind, Word says) {
    session_.command({kind, 0});
    note(word(says));
  };
  switch (action) {
    case Action::cut:
      return note(drill_.set_mode(tick::ToolMode::cut));
    case Action::add:
      return note(drill_.set_mode(tick::ToolMode::add));
    case Action::touch:
      return note(drill_.set_mode(tick::ToolMode::touch));
    case Action::back:
      return note(drill_.set_mode(tick::ToolMode::restore));
    case Action::smooth:
      return note(drill_.set_mode(tick::ToolMode::smooth));
    case Action::undo:
      return command(tick::CommandKind::undo, Word::undone);
    case Action::redo:
      return command(tick::CommandKind::redo, Word::redone);
    case Action::reset:
      return command(tick::CommandKind::reset, Word::back_to_start);
    case Action::measure:
      return next_measure();
    case Action::mirror:
      mirror_.toggle();
      return note_mirror();
    case Action::smaller:
      return note(drill_.change_burr(-1));
    case Action::larger:
      return note(drill_.change_burr(1));
    case Action::slower:
      return note(drill_.slower());
    case Action::faster:
      return note(drill_.faster());
    case Action::export_:
      return pages_->toggle_export();
    case Action::settings:
      return pages_->toggle_settings();
    case Action::help:
      return pages_->toggle_help(false);
    case Action::leave:
      return leave();
    case Action::kind:
      return note(drill_.toggle_kind());
    case Action::coolant:
      return note(drill_.toggle_coolant());
    case Action::suction:
      return toggle_suction();
    case Action::slices:
      slices_shown_ = !slices_shown_;
      return;
    case Action::views:
      return toggle_menu(Menu::views);
    case Action::menu:
      return toggle_menu(Menu::all);
    case Action::rack:
      return toggle_menu(Menu::rack);
    case Action::structures:
      return show_structures();
    case Action::task:
      return show_task();
    case Action::picture:
      picture_ = true;
      return;
    case Action::sound:
      return toggle_sound();
    case Action::see_through:
      return step_opacity(false);
    case Action::keep:
      return keep();
    case Action::beside:  // of the page that plays a recording
    case Action::compare:
    case Action::earlier:
    case Action::later:
    case Action::step_back:
    case Action::step_on:
    case Action::stroke_back:
    case Action::stroke_on:
    case Action::first_view:
    case Action::labels:
    case Action::hide:
    case Action::play:
    case Action::film_from:
    case Action::film_until:
      return;
  }
}

// Leaves the page. If a file is still being written, only the second call does.
void Mill::leave() {
  if (!pages_->exporting().progress().empty() && !std::exchange(leaves_, true))
    return note(word(Word::export_wait));
  closed_ = Closed::page;
  open_ = false;
}

void Mill::toggle_menu(Menu menu) {
  const bool covered = page_open();  // by help or settings: the menu is wanted, not they
  pages_->close();
  if (menu_ == menu && !covered)
    menu_.reset();
  else
    menu_ = menu;
}

// Fresh bone, dust and water of both hands' tools.
void Mill::see_cuts(workshop::LiveSurface& live) {
  const tick::ServoSettings& servo = session_.settings().servo;
  const bool cuts = hands_.suction != nullptr && hands_.suction->tool() != nullptr;
  const tick::TickRow* second = cuts ? &hands_.suction->now() : nullptr;
  live.see(workshop::wound_tick(row_, servo.rate_hz, servo.tools, second));
  if (!cuts) return;
  const tool::ShapedTool& tool = *session_.second_hand()->settings().tool;
  live.see_beside(workshop::wound_tick(*second, servo.rate_hz, {&tool, 1}));
}

// The tube beside the burr. It takes away water, dust and blood from the picture, and splinters from the bone
// (mill_pieces.cpp).
void Mill::toggle_suction() {
  suction_ = !suction_;
  sucked_ = Clock::now();
  note(word(suction_ ? Word::suction_on : Word::suction_off));
}

void Mill::suck(workshop::LiveSurface& live) {
  constexpr double kMost = 0.1;  // of one picture [s]
  const double seconds =
      std::chrono::duration<double>(Clock::now() - std::exchange(sucked_, Clock::now())).count();
  if (suction_ && desk_.settings.effects)
    live.suck(scene_.burr.world_from_tool.p,
              (grip_.burr() ? scene_.burr.radius : grip_.reach()) + kSuctionBeside,
              std::min(seconds, kMost));
}

void Mill::hide_panels() {
  panels_ = !panels_;
  if (!panels_) note(word(Word::panels_hidden));
}

void Mill::next_measure() {
  measuring_.next();
  lift();
  note(measuring_.on() ? measuring_.words() : word(Word::measure_off));
}

// Changes the depth: of the press, if the hand follows the bone; of the plane, if it is in its
// plane.
void Mill::deepen(double steps) {
  if (plane_.on())
    plane_.push(kPlaneStep * steps, scene_.camera);
  else
    push(std::pow(1.1, steps));
}

// Not for a haptic device or a wand, because they have a position of their own.
void Mill::toggle_plane() {
  if (hands_.real != nullptr || headset_.wand()) return;
  if (plane_.on())
    plane_.end();
  else
    plane_.begin(row_.hand.world_from_tool.p);
  note(word(plane_.on() ? Word::plane_on : Word::plane_off));
}

void Mill::push(double factor) {
  if (plane_.on()) return deepen(factor > 1 ? 1 : -1);
  press_.deepen(factor);
}

void Mill::lift() {
  lifts_.by_key = false;
  aim_keys_ = {};
  press_.lift();
  desk_.pads.disarm();
  desk_.pedals.disarm();
  desk_.cap.disarm();
}

void Mill::pick_point() {
  if (const auto hit = render::pick(scene_, pointer_.mouse())) measuring_.pick(hit->p);
  note(measuring_.words());
}

void Mill::button(const SDL_MouseButtonEvent& button) {
  const Uint8 mills = desk_.settings.left_handed ? SDL_BUTTON_RIGHT : SDL_BUTTON_LEFT;
  if (button.button != mills && button.button != SDL_BUTTON_MIDDLE)
    pulls_window_ = button.type == SDL_MOUSEBUTTONDOWN && pointer_.over_slices();
  if (button.button != mills) return;
  if (measuring_.picks()) {
    const bool down = button.type == SDL_MOUSEBUTTONDOWN;
    if (!down || page_open() || desk_.ui().over_panel() || pointer_.over_slices()) return;
    return pick_point();
  }
  // The click that brought the window to the front does not mill, nor a press that began on a
  // panel. Every later press counts.
  press_.button(button.type == SDL_MOUSEBUTTONDOWN && !same_click(to_front_, button.timestamp) &&
                !desk_.ui().over_panel());
}

void Mill::wheel(const SDL_MouseWheelEvent& wheel) {
  if (page_open() || desk_.ui().over_panel()) return;
  const double by =
      wheel.preciseY != 0 ? static_cast<double>(wheel.preciseY) : static_cast<double>(wheel.y);
  const SDL_Keymod held = SDL_GetModState();
  const bool ctrl = (held & KMOD_CTRL) != 0;
  if ((held & KMOD_ALT) != 0) {
    if (by != 0 && (held & KMOD_SHIFT) != 0) return lean_tool(by > 0 ? 1 : -1);
    if (by != 0) return roll_tool(by > 0 ? 1 : -1);
  }
  if ((held & KMOD_SHIFT) != 0 && !ctrl) {
    if (by != 0) note(drill_.change_burr(by > 0 ? 1 : -1));
  } else if (plane_.on() != ctrl) {
    deepen(by);
  } else {
    magnify(by * desk_.settings.zoom_pace);
  }
}

void Mill::move(const SDL_MouseMotionEvent& motion) {
  // over a panel the hand stays where it was
  if (page_open() || desk_.ui().over_panel()) return;
  // an accidental movement of the mouse must not move a burr that a pad presses
  if (pointer_.pad_leads() && press_.by_pad()) return;
  pointer_.moved_to(motion.x, motion.y);
  if (has_piece()) drag_piece(motion);
  const Uint32 turns = desk_.settings.left_handed ? SDL_BUTTON_LMASK : SDL_BUTTON_RMASK;
  if ((motion.state & turns) != 0 && pulls_window_) {
    const double edge = scene_.insets.empty() ? 1 : scene_.insets.front().width;
    slices_->pull_window(motion.xrel / edge, -motion.yrel / edge);
  } else if ((motion.state & turns) != 0)
    turn_view(-motion.xrel, motion.yrel, false);
  if ((motion.state & SDL_BUTTON_MMASK) != 0) turn_view(-motion.xrel, motion.yrel, true);
}

// Aims the arm: above the bone under the mouse, or into the bone while the button is down.
void Mill::point() {
  if (hands_.real != nullptr) return align_real_hand();
  if (headset_.wand()) {
    const auto aim = headset_.aim(scene_.camera, page_open() || measuring_.picks());
    if (aim) hands_.mouse->aim(*aim);
    return;
  }
  pointer_.measure_window();
  const render::Ray ray = pointer_.aim();
  if (plane_.on()) return point_in_plane(ray);
  std::optional<mouse::MouseAim::Push> push;
  if (pressing()) push = {press_.depth(), press_.spindle()};
  hands_.mouse->aim(aim_.at(scene_, ray, push, desk_.settings.left_handed));
}

// Aims at the point of the plane under the mouse. The hand may be inside the bone; the bone stops
// the burr.
void Mill::point_in_plane(const render::Ray& ray) {
  const Vec3 out = row_.contact.touching ? row_.contact.normal : scene_.camera.backward();
  hands_.mouse->aim(aim_.held_at(plane_.meet(ray, scene_.camera), out,
                                 pressing() ? press_.spindle() : 0, scene_.camera,
                                 desk_.settings.left_handed));
}

// A haptic device has a position of its own. The view defines its right and up; keys and pedals add
// the rest.
void Mill::align_real_hand() {
  device::MappedHand& hand = *hands_.real;
  if (!carries_piece()) hand.set_axes(view_of_hand(scene_.camera));
  const bool rests = page_open() || measuring_.picks();
  hand.press(rests ? 0 : press_.spindle_of_device());
  lift_real_hand();
  aim_.touches(row_.contact.proxy,
               row_.contact.touching ? std::optional(row_.contact.normal) : std::nullopt);
}

void Mill::lift_real_hand() {
  hands_.real->lift(lifts_.stopped || lifts_.by_key || lifts_.by_foot);
}

// The user's emergency stop of both hands; called again, it ends the stop.
void Mill::stop_or_go_on() {
  if (hands_.real == nullptr && hands_.suction == nullptr) return;
  lifts_.stopped = !lifts_.stopped;
  if (hands_.real != nullptr) lift_real_hand();  // at once, not with the next picture
  if (hands_.suction != nullptr) hands_.suction->lift(lifts_.stopped);
  note(word(lifts_.stopped ? Word::stopped : Word::taken_again));
}

// Measures the thickness at the burr: along the contact normal, or below the burr where it hovers.
void Mill::measure() {
  const Vec3 inward = row_.contact.touching ? Vec3(-row_.contact.normal) : Vec3(-aim_.normal());
  if (measuring_.what() == Measure::thickness)
    measuring_.probe(session_.bone(), scene_.burr.world_from_tool.p, inward,
                     scene_.burr.radius + kProbe);
}

void Mill::toggle_sound() {
  if (options_.loudspeaker == nullptr) return;
  options_.loudspeaker->toggle();
  if (!options_.loudspeaker->trouble().empty()) return note(options_.loudspeaker->trouble());
  note(word(options_.loudspeaker->is_on() ? Word::sound_on : Word::sound_off));
}

void Mill::change_loudness(int by) {
  if (options_.loudspeaker != nullptr)
    note(say(Word::sound_loudness, options_.loudspeaker->louder(by)));
}

void Mill::mirror_at_tip() {
  if (!allows(Action::mirror)) return say_refused();
  mirror_.place_at(scene_.burr.world_from_tool.p);
  note_mirror();
}

void Mill::mirror_next_plane() {
  if (!allows(Action::mirror)) return say_refused();
  mirror_.next_plane();
  note_mirror();
}

void Mill::note_mirror() {
  session_.command(tick::command_for(mirror_.now()));
  note(mirror_words(session_.bone().grid(), mirror_.now()));
}

}  // namespace burr::app
