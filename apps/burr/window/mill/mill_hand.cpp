// What the user does at the page: keys, buttons, and the mouse as a hand.
#include <SDL2/SDL.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "burr/math/turn.h"
#include "burr/render/pick.h"
#include "burr/tool/burr_tool.h"
#include "window/mill/mill.h"
#include "window/mill/see_through.h"
#include "window/shell/words.h"
#include "workshop/live_surface.h"
#include "workshop/suction_hand.h"
#include "workshop/work.h"

namespace burr::app {
namespace {

using math::Vec3;

// diameters that burrs come in [m]
constexpr double kSizes[] = {0.6e-3, 0.8e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3,
                             4e-3,   4.5e-3, 5e-3, 5.5e-3, 6e-3, 6.5e-3, 7e-3};
constexpr double kRpmStep = 5000, kRpmMost = 80'000;
constexpr double kDeeper = 0.5e-3;  // of the plane, by a step of the wheel  [m]
constexpr double kTurn = 0.006;     // of the view, by a pixel of the mouse  [rad]

}  // namespace

void Mill::take_events() {
  SDL_Event event;
  while (desk_.next(event)) switch (event.type) {
      case SDL_QUIT:
        open_ = false;
        break;
      case SDL_KEYDOWN:
        if (!desk_.ui().typing() && !aim_key(event.key.keysym, true)) key(event.key.keysym);
        break;
      case SDL_KEYUP:
        aim_key(event.key.keysym, false);
        if (event.key.keysym.sym == SDLK_c) lifted_ = false;
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
        break;
      default:
        break;
    }
}

// Keys that move the hand while they are held: Ctrl and an arrow, or the keypad's. Whether this one
// is of them.
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

void Mill::key(const SDL_Keysym& pressed) {
  const bool shift = (pressed.mod & KMOD_SHIFT) != 0;
  switch (pressed.sym) {
    case SDLK_BACKSPACE:
    case SDLK_PAUSE:
      if (hands_.real != nullptr || hands_.suction != nullptr) let_go(!let_go_);
      break;
    case SDLK_c:
      lifted_ = true;
      break;
    case SDLK_ESCAPE:
      go_back();
      break;
    case SDLK_q:
      act(Action::leave);
      break;
    case SDLK_F1:
    case SDLK_h:
      act(Action::help);
      break;
    case SDLK_F2:
      act(Action::settings);
      break;
    case SDLK_TAB:
      panels_ = !panels_;
      break;
    case SDLK_v:
      slices_shown_ = !slices_shown_;
      break;
    case SDLK_F5:
    case SDLK_F6:
    case SDLK_F7:
    case SDLK_F8:
      saved_view(1 + pressed.sym - SDLK_F5, shift);
      break;
    case SDLK_w:
      if (slices_) note(slices_->next_window());
      break;
    case SDLK_b:
    case SDLK_n:
      if (slices_) slices_->zoom(pressed.sym == SDLK_b ? 1 : -1);
      break;
    case SDLK_l:
      show_labels(!labels_);
      break;
    case SDLK_t:
      note(step_see_through(scene_, shift));
      break;
    case SDLK_o:
      show_task();
      break;
    case SDLK_k:
      toggle_kind();
      break;
    case SDLK_i:
      toggle_coolant();
      break;
    case SDLK_SPACE:
      held_ = !held_;
      break;
    case SDLK_f:
      scene_.camera = first_view_;
      break;
    case SDLK_LEFT:
    case SDLK_RIGHT:
      turn_view(pressed.sym == SDLK_LEFT ? -12 : 12, 0, shift);
      break;
    case SDLK_UP:
    case SDLK_DOWN:
      turn_view(0, pressed.sym == SDLK_UP ? 12 : -12, shift);
      break;
    case SDLK_u:
      act(Action::undo);
      break;
    case SDLK_y:
      act(Action::redo);
      break;
    case SDLK_r:
      act(Action::reset);
      break;
    case SDLK_d:
      act(Action::measure);
      break;
    case SDLK_x:
      mirror(pressed);
      break;
    case SDLK_1:
      act(Action::cut);
      break;
    case SDLK_2:
      act(Action::add);
      break;
    case SDLK_3:
      act(Action::touch);
      break;
    case SDLK_4:
      act(Action::back);
      break;
    case SDLK_5:
      act(Action::smooth);
      break;
    case SDLK_g:
      toggle_plane();
      break;
    case SDLK_KP_3:
      deepen(-1);
      break;
    case SDLK_KP_9:
      deepen(1);
      break;
    case SDLK_PAGEDOWN:
    case SDLK_PAGEUP: {
      const bool up = pressed.sym == SDLK_PAGEUP;
      if ((pressed.mod & KMOD_CTRL) != 0)
        deepen(up ? 1 : -1);
      else
        act(up ? Action::larger : Action::smaller);
      break;
    }
    case SDLK_LEFTBRACKET:
      act(Action::smaller);
      break;
    case SDLK_RIGHTBRACKET:
      act(Action::larger);
      break;
    case SDLK_COMMA:
      act(Action::slower);
      break;
    case SDLK_PERIOD:
      act(Action::faster);
      break;
    case SDLK_PLUS:
    case SDLK_EQUALS:
    case SDLK_KP_PLUS:
      push(1.25);
      break;
    case SDLK_MINUS:
    case SDLK_KP_MINUS:
      push(1 / 1.25);
      break;
    case SDLK_s:
      keep();
      break;
    case SDLK_e:
      act(Action::export_);
      break;
    case SDLK_p:
      picture_ = true;
      break;
    case SDLK_m:
      if (options_.loudspeaker != nullptr) toggle_sound();
      break;
    case SDLK_9:
    case SDLK_0:
      if (options_.loudspeaker != nullptr)
        note(say(Word::sound_loudness,
                 options_.loudspeaker->louder(pressed.sym == SDLK_0 ? 1 : -1)));
      break;
    default:
      break;
  }
}

void Mill::show_task() {
  task_ = options_.work_case && !task_;
  if (!options_.work_case) note(word(Word::task_none));
}

// Closes what is open, last of all the page.
void Mill::go_back() {
  if (page_open()) {
    help_ = settings_page_ = false;
    export_->show(false);
  } else if (measuring_.on()) {
    measuring_.stop();
    note(word(Word::measure_off));
  } else
    act(Action::leave);
}

void Mill::keep() {
  note(word(options_.keep && options_.keep() ? Word::session_kept : Word::session_not_kept));
}

void Mill::act(Action action) {
  const auto command = [this](tick::CommandKind kind, double value, Word says) {
    session_.command({kind, value});
    note(word(says));
  };
  const auto mode = [&](tick::ToolMode to, Word says) {
    mode_ = to;
    command(tick::CommandKind::tool_mode, static_cast<double>(to), says);
  };
  switch (action) {
    case Action::cut:
      return mode(tick::ToolMode::cut, Word::now_cut);
    case Action::add:
      return mode(tick::ToolMode::add, Word::now_add);
    case Action::touch:
      return mode(tick::ToolMode::touch, Word::now_touch);
    case Action::back:
      return mode(tick::ToolMode::restore, Word::now_back);
    case Action::smooth:
      return mode(tick::ToolMode::smooth, Word::now_smooth);
    case Action::undo:
      return command(tick::CommandKind::undo, 0, Word::undone);
    case Action::redo:
      return command(tick::CommandKind::redo, 0, Word::redone);
    case Action::reset:
      return command(tick::CommandKind::reset, 0, Word::back_to_start);
    case Action::measure:
      measuring_.next();
      lift();
      note(measuring_.on() ? measuring_.words() : word(Word::measure_off));
      break;
    case Action::mirror:
      mirror_.toggle();
      return tell_mirror();
    case Action::smaller:
      return change_burr(-1);
    case Action::larger:
      return change_burr(1);
    case Action::slower:
      return change_speed(-kRpmStep);
    case Action::faster:
      return change_speed(kRpmStep);
    case Action::export_:
      export_->show(!export_->shown());
      help_ = settings_page_ = false;
      break;
    case Action::settings:
      settings_page_ = !settings_page_;
      help_ = false;
      export_->show(false);
      break;
    case Action::help:
      help_ = !help_;
      help_pads_ = false;
      settings_page_ = false;
      export_->show(false);
      break;
    case Action::leave:
      if (!export_->progress().empty() && !std::exchange(leaves_, true))
        return note(word(Word::export_wait));
      left_ = Left::page;
      open_ = false;
      break;
  }
}

// The next size, and after the largest the smallest: a foot has one button for it.
void Mill::next_burr() {
  const double largest = *std::rbegin(kSizes);
  const bool over = 2 * burr_requested_.value_or(session_.burr_radius()) > largest - 1e-9;
  if (!over) return change_burr(1);
  burr_requested_ = 0;
  change_burr(1);
}

// The next size of kSizes that the voxels bear; the servo has the last word.
void Mill::change_burr(int by) {
  const double least =
      std::max(tool::kSmallestDiameter, 4 * session_.bone().grid().voxel);  // as tick/orders.cpp
  const double now = 2 * burr_requested_.value_or(session_.burr_radius());
  std::optional<double> next;
  for (const double size : kSizes) {
    if (size < least - 1e-9) continue;
    if (by > 0 && size > now + 1e-9 && !next) next = size;
    if (by < 0 && size < now - 1e-9) next = size;
  }
  if (!next)
    return note(say(Word::no_burr, std::ceil(1e4 * least) / 10, 1e3 * tool::kLargestDiameter));
  burr_requested_ = 0.5 * *next;
  burr_requested_at_ = Clock::now();
  session_.command({tick::CommandKind::burr_radius, *burr_requested_});
}

void Mill::change_speed(double by) {
  constexpr double kRpm = 2 * std::numbers::pi / 60;
  const double rpm =
      std::clamp(std::round(full_speed_ / kRpm / kRpmStep) * kRpmStep + by, kRpmStep, kRpmMost);
  full_speed_ = rpm * kRpm;
  session_.command({tick::CommandKind::spindle_speed, full_speed_});
  note(say(Word::speed_now, rpm));
}

// Of a hand that follows the bone, how far it presses in; of one in its plane, where that is.
void Mill::deepen(double steps) {
  if (plane_.on())
    plane_.push(kDeeper * steps, scene_.camera);
  else
    push(std::pow(1.1, steps));
}

// A haptic device and a wand point by themselves.
void Mill::toggle_plane() {
  if (hands_.real != nullptr || wand_) return;
  if (plane_.on())
    plane_.end();
  else
    plane_.begin(row_.hand.world_from_tool.p);
  note(word(plane_.on() ? Word::plane_on : Word::plane_off));
}

void Mill::push(double factor) {
  if (plane_.on()) return deepen(factor > 1 ? 1 : -1);
  press_ = std::clamp(press_ * factor, kPressLeast, kPressMost);
}

void Mill::lift() {
  lifted_ = false;
  aim_keys_ = {};
  pressing_ = held_ = false;
  depth_ = foot_ = 0;
  desk_.pads.disarm();
  desk_.pedals.disarm();
  desk_.cap.disarm();
}

void Mill::pick_point() {
  const auto hit = render::pick(
      scene_, render::ray_through(scene_.camera, mouse_x_ + 0.5, mouse_y_ + 0.5, width_, height_));
  if (hit) measuring_.pick(hit->p);
  note(measuring_.words());
}

void Mill::button(const SDL_MouseButtonEvent& button) {
  const Uint8 mills = desk_.settings.left_handed ? SDL_BUTTON_RIGHT : SDL_BUTTON_LEFT;
  if (button.button != mills && button.button != SDL_BUTTON_MIDDLE)
    pulls_window_ = button.type == SDL_MOUSEBUTTONDOWN && over_slices();
  if (button.button != mills) return;
  if (measuring_.picks()) {
    const bool down = button.type == SDL_MOUSEBUTTONDOWN;
    if (!down || page_open() || desk_.ui().over_panel() || over_slices()) return;
    return pick_point();
  }
  // what began on a panel is not for the bone
  pressing_ = button.type == SDL_MOUSEBUTTONDOWN && !desk_.ui().over_panel();
}

void Mill::wheel(const SDL_MouseWheelEvent& wheel) {
  if (page_open() || desk_.ui().over_panel()) return;
  const double by =
      wheel.preciseY != 0 ? static_cast<double>(wheel.preciseY) : static_cast<double>(wheel.y);
  const SDL_Keymod held = SDL_GetModState();
  const bool ctrl = (held & KMOD_CTRL) != 0;
  if ((held & KMOD_SHIFT) != 0 && !ctrl) {
    if (by != 0) change_burr(by > 0 ? 1 : -1);
  } else if (plane_.on() != ctrl) {
    deepen(by);
  } else {
    render::zoom(scene_.camera, std::pow(1.15, by * desk_.settings.zoom_pace));
  }
}

// by pixels of the mouse, or what an arrow counts as
void Mill::turn_view(double right, double up, bool shift) {
  if (shift)
    render::pan(scene_.camera, right / height_, up / height_);
  else
    render::orbit(scene_.camera, kTurn * desk_.settings.turn_pace * right,
                  kTurn * desk_.settings.turn_pace * up);
}

void Mill::move(const SDL_MouseMotionEvent& motion) {
  // over a panel the hand stays where it was
  if (page_open() || desk_.ui().over_panel()) return;
  if (leads_ && (depth_ > 0 || held_)) return;  // a mouse that is knocked moves no pressing burr
  mouse_leads();
  mouse_x_ = motion.x;
  mouse_y_ = motion.y;
  if (!over_slices()) aim_at_mouse();
  const Uint32 turns = desk_.settings.left_handed ? SDL_BUTTON_LMASK : SDL_BUTTON_RMASK;
  if ((motion.state & turns) != 0 && pulls_window_) {
    const double edge = scene_.insets.empty() ? 1 : scene_.insets.front().width;
    slices_->pull_window(motion.xrel / edge, -motion.yrel / edge);
  } else if ((motion.state & turns) != 0)
    turn_view(-motion.xrel, motion.yrel, false);
  if ((motion.state & SDL_BUTTON_MMASK) != 0) turn_view(-motion.xrel, motion.yrel, true);
}

// Aims the arm: above the bone under the mouse, or into it while the button is down.
void Mill::point() {
  if (hands_.real != nullptr) return lay_real_hand();
  if (wand_) return point_wand();
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &width_, &height_);
  const render::Ray ray =
      render::ray_through(scene_.camera, aim_x_ + 0.5, aim_y_ + 0.5, width_, height_);
  if (plane_.on()) return point_in_plane(ray);
  const auto hit = render::pick(scene_, ray);
  Vec3 surface;
  if (hit) {
    // calm the normal: a rough bone must not shake the hand
    normal_ = (0.8 * normal_ + 0.2 * hit->n).normalized();
    surface = hit->p;
    point_ = hit->p;
  } else {
    // beside the bone: over the background, as far away as the work was last
    const Vec3 near = point_.value_or(scene_.camera.target);
    const double depth = (near - ray.origin).dot(-scene_.camera.backward()) /
                         ray.direction.dot(-scene_.camera.backward());
    surface = ray.origin + depth * ray.direction;
    normal_ = (0.8 * normal_ + 0.2 * scene_.camera.backward()).normalized();
  }
  const bool press = pressing() && hit.has_value();
  const double height = scene_.burr.radius + (press ? -depth() : kHover);

  aim_at(surface + height * normal_, press ? pedal() : 0);
}

// The hand where the mouse is, as deep as the plane; the bone holds the burr, not the hand.
void Mill::point_in_plane(const render::Ray& ray) {
  const Vec3 out = row_.contact.touching ? row_.contact.normal : scene_.camera.backward();
  normal_ = (0.8 * normal_ + 0.2 * out).normalized();
  point_ = plane_.meet(ray, scene_.camera);
  aim_at(*point_, pressing() ? pedal() : 0);
}

// The handle leans out of the way, to the side of the hand that holds it.
void Mill::aim_at(const Vec3& tip, double pedal) {
  const double side = desk_.settings.left_handed ? -0.7 : 0.7;
  const Vec3 handle =
      (normal_ + side * scene_.camera.right() + 0.2 * scene_.camera.above()).normalized();
  MouseHand::Aim aim;
  aim.world_from_tool.p = tip;
  aim.world_from_tool.q = math::shortest_turn(Vec3::UnitZ(), handle);
  aim.pedal = pedal;
  hands_.mouse->aim(aim);
}

// A haptic device points by itself; the view says where its right and up are, keys and feet help.
void Mill::lay_real_hand() {
  device::MappedHand& hand = *hands_.real;
  hand.lay(view_of_hand(scene_.camera));
  const bool rests = page_open() || measuring_.picks();
  hand.press(rests ? 0 : (held_ ? 1 : foot_) * (1 - slowed_));
  hand.lift(let_go_ || lifted_ || foot_lifts_);
  point_ = row_.contact.proxy;
  if (row_.contact.touching) normal_ = row_.contact.normal;
}

// The user's emergency stop, of both hands, and taking them again.
void Mill::let_go(bool gone) {
  let_go_ = gone;  // now, not with the next picture
  if (hands_.real != nullptr) hands_.real->lift(let_go_ || lifted_ || foot_lifts_);
  if (hands_.suction != nullptr) hands_.suction->lift(let_go_);
  note(word(gone ? Word::stopped : Word::taken_again));
}

// The tube in the other hand: a rod that comes from its handle, and what it takes away.
void Mill::lead_suction(LiveSurface& live) {
  if (hands_.suction == nullptr) return;
  const Clock::time_point now = Clock::now();
  const double seconds =
      std::min(0.1, std::chrono::duration<double>(now - std::exchange(sucked_, now)).count());
  hands_.suction->lay(view_of_hand(scene_.camera));
  const SuctionHand::Seen seen = hands_.suction->now();
  std::erase_if(scene_.rods,
                [](const render::Rod& rod) { return rod.radius == SuctionHand::kRadius; });
  if (!seen.there) return;
  constexpr double kLong = 60e-3;  // of the tube that is drawn [m]
  const Vec3& mouth = seen.world_from_tool.p;
  scene_.rods.push_back({mouth,
                         mouth + seen.world_from_tool.q * Vec3(0, 0, kLong),
                         SuctionHand::kRadius,
                         {0.72F, 0.76F, 0.8F},
                         false,
                         false});
  if (seen.sucks && desk_.settings.effects) live.suck(mouth, SuctionHand::kRadius, seconds);
}

// The thickness goes with the burr: along its contact, or below where it hovers.
void Mill::measure() {
  const Vec3 inward = row_.contact.touching ? Vec3(-row_.contact.normal) : Vec3(-normal_);
  if (measuring_.what() == Measure::thickness)
    measuring_.probe(session_.bone(), scene_.burr.world_from_tool.p, inward,
                     scene_.burr.radius + 2 * kHover);
}

bool Mill::over_slices() const {
  const double x = static_cast<double>(mouse_x_) * desk_.renderer().width() / std::max(1, width_);
  const double y = static_cast<double>(mouse_y_) * desk_.renderer().height() / std::max(1, height_);
  return std::any_of(scene_.insets.begin(), scene_.insets.end(), [&](const render::Inset& inset) {
    return x >= inset.x && x < inset.x + inset.width && y >= inset.y && y < inset.y + inset.height;
  });
}

// Tissues in colours of their own, or all as bone.
void Mill::show_labels(bool shown) {
  labels_ = shown;
  scene_.tissue_colours = shown ? colours_ : render::as_bone(colours_);
}

// Keeps how one looks, or looks so again.
void Mill::saved_view(int slot, bool keep) {
  if (keep) {
    const Status kept =
        saved_views_->keep(slot, {scene_.camera, scene_.look.opacity, labels_, slices_shown_});
    return note(kept ? say(Word::view_kept, slot) : kept.error().text);
  }
  const auto view = saved_views_->at(slot);
  if (!view) return note(say(Word::view_none, slot, slot + 4));
  scene_.camera = view->camera;
  scene_.look.opacity = view->opacity;
  show_labels(view->labels);
  slices_shown_ = view->slices;
  note(say(Word::view_shown, slot));
}

void Mill::toggle_sound() {
  options_.loudspeaker->toggle();
  if (!options_.loudspeaker->trouble().empty()) return note(options_.loudspeaker->trouble());
  note(word(options_.loudspeaker->is_on() ? Word::sound_on : Word::sound_off));
}

void Mill::toggle_kind() {
  bool& diamond = scene_.burr.diamond;
  diamond = !diamond;
  session_.command({tick::CommandKind::burr_kind, diamond ? 1.0 : 0.0});
  note(word(diamond ? Word::now_diamond : Word::now_fluted));
}

void Mill::toggle_coolant() {
  irrigated_ = !irrigated_;
  session_.command({tick::CommandKind::irrigation, irrigated_ ? 1.0 : 0.0});
  note(word(irrigated_ ? Word::coolant_on : Word::coolant_off));
}

// On, off; with Shift through the tip of the burr, with Ctrl another way.
void Mill::mirror(const SDL_Keysym& pressed) {
  if ((pressed.mod & KMOD_SHIFT) != 0)
    mirror_.place_at(scene_.burr.world_from_tool.p);
  else if ((pressed.mod & KMOD_CTRL) != 0)
    mirror_.next_plane();
  else
    mirror_.toggle();
  tell_mirror();
}

void Mill::tell_mirror() {
  session_.command(tick::command_for(mirror_.now()));
  note(mirror_words(session_.bone().grid(), mirror_.now()));
}

}  // namespace burr::app
