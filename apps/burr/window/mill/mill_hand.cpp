#include "window/mill/mill_hand.h"

#include <cmath>
#include <utility>

#include "burr/render/pick.h"
#include "burr/workshop/suction_hand.h"
#include "burr/workshop/work_view.h"
#include "shared/window_session.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kPlaneStep = 0.5e-3;  // of the plane, per step of the wheel  [m]
constexpr double kProbe = 6e-3;        // of the thickness, beyond the burr [m]

constexpr double kAimPace = 0.5;     // stick moved all the way  [heights of the picture / s]
constexpr double kDeepPace = 20e-3;  // cap moved all the way, for the plane  [m/s]
constexpr double kTurnPace = 300;    // the same for the view  [pixels of the mouse / s]
constexpr double kZoomPace = 1.2;    // the same for zooming  [factors of e / s]
constexpr double kLongest = 0.1;     // a longer picture does not move the point farther  [s]

}  // namespace

PedalMap pedal_map(const Settings& settings) {
  const auto number = [](double value) { return static_cast<int>(std::lround(value)); };
  return {number(settings.pedal_mill),    number(settings.pedal_burr),
          number(settings.pedal_coolant), number(settings.pedal_clutch),
          number(settings.pedal_rest),    number(settings.pedal_tool)};
}

MillHand::MillHand(const MillSite& site, Pointer& pointer, const WornHeadset& headset,
                   MillView& view, MillTools& tools, const PieceCarrier& pieces)
    : desk_(site.desk),
      session_(site.session),
      scene_(site.scene),
      hands_(site.hands),
      row_(site.row),
      notes_(site.notes),
      over_(site.over),
      pointer_(pointer),
      headset_(headset),
      view_(view),
      tools_(tools),
      pieces_(pieces),
      aim_(site.session.bone().grid().voxel) {
  aim_.hold(&tools.grip());
}

void MillHand::take_settings() {
  if (std::exchange(usual_mm_, desk_.settings.press_mm) != desk_.settings.press_mm)
    press_.begin_at(1e-3 * desk_.settings.press_mm);
}

void MillHand::begin() {
  take_settings();
  desk_.cap.open();
  lift();
  hands_taken_ = Clock::now();
}

bool MillHand::pressing() const {
  return !lifts_.stopped && press_.on() && !measuring_.picks() && !over_.page() &&
         !pieces_.has_piece() && !pointer_.over_panel() && !pointer_.over_slices();
}

Vec3 MillHand::work() const {
  return row_.contact.touching ? row_.contact.proxy
                               : aim_.bone_below().value_or(scene_.camera.target);
}

void MillHand::push(double factor) {
  if (plane_.on()) return deepen(factor > 1 ? 1 : -1);
  press_.deepen(factor);
}

void MillHand::deepen(double steps) {
  if (plane_.on())
    plane_.push(kPlaneStep * steps, scene_.camera);
  else
    push(std::pow(1.1, steps));
}

void MillHand::toggle_plane() {
  if (hands_.real != nullptr || headset_.wand()) return;
  if (plane_.on())
    plane_.end();
  else
    plane_.begin(row_.hand.world_from_tool.p);
  notes_.note(word(plane_.on() ? Word::plane_on : Word::plane_off));
}

bool MillHand::aim_key(const SDL_Keysym& pressed, bool down) {
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

void MillHand::lift() {
  lifts_.by_key = false;
  aim_keys_ = {};
  press_.lift();
  desk_.pads.disarm();
  desk_.pedals.disarm();
  desk_.cap.disarm();
}

void MillHand::stop_or_go_on() {
  if (hands_.real == nullptr && hands_.suction == nullptr) return;
  lifts_.stopped = !lifts_.stopped;
  if (hands_.real != nullptr) lift_real_hand();  // at once, not with the next picture
  if (hands_.suction != nullptr) hands_.suction->lift(lifts_.stopped);
  notes_.note(word(lifts_.stopped ? Word::stopped : Word::taken_again));
}

void MillHand::next_measure() {
  measuring_.next();
  lift();
  notes_.note(measuring_.on() ? measuring_.words() : word(Word::measure_off));
}

void MillHand::stop_measure() {
  measuring_.stop();
  notes_.note(word(Word::measure_off));
}

void MillHand::pick_point() {
  if (const auto hit = render::pick(scene_, pointer_.mouse())) measuring_.pick(hit->p);
  notes_.note(measuring_.words());
}

void MillHand::point() {
  if (hands_.real != nullptr) return align_real_hand();
  if (headset_.wand()) {
    const auto aim = headset_.aim(scene_.camera, over_.page() || measuring_.picks());
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
void MillHand::point_in_plane(const render::Ray& ray) {
  const Vec3 out = row_.contact.touching ? row_.contact.normal : scene_.camera.backward();
  hands_.mouse->aim(aim_.held_at(plane_.meet(ray, scene_.camera), out,
                                 pressing() ? press_.spindle() : 0, scene_.camera,
                                 desk_.settings.left_handed));
}

// A haptic device has a position of its own. The view defines its right and up; keys and pedals add
// the rest.
void MillHand::align_real_hand() {
  device::MappedHand& hand = *hands_.real;
  if (!pieces_.carries()) hand.set_axes(view_of_hand(scene_.camera));
  const bool rests = over_.page() || measuring_.picks();
  hand.press(rests ? 0 : press_.spindle_of_device());
  lift_real_hand();
  aim_.touches(row_.contact.proxy,
               row_.contact.touching ? std::optional(row_.contact.normal) : std::nullopt);
}

void MillHand::lift_real_hand() {
  hands_.real->lift(lifts_.stopped || lifts_.by_key || lifts_.by_foot);
}

void MillHand::measure() {
  const Vec3 inward = row_.contact.touching ? Vec3(-row_.contact.normal) : Vec3(-aim_.normal());
  if (measuring_.what() == Measure::thickness)
    measuring_.probe(session_.bone(), scene_.burr.world_from_tool.p, inward,
                     scene_.burr.radius + kProbe);
}

void MillHand::take_pads() {
  const Clock::time_point now = Clock::now();
  const double dt =
      std::clamp(std::chrono::duration<double>(now - hands_taken_).count(), 0.0, kLongest);
  hands_taken_ = now;
  look_for_hands();
  const Settings& settings = desk_.settings;
  const PadSticks pad = desk_.pads.now(settings.pad_dead);
  const CapMotion cap = desk_.cap.now(settings.pad_dead);
  const double foot = desk_.pedals.now(pedal_map(settings));
  lifts_.by_foot = desk_.pedals.clutched(pedal_map(settings));
  pad_lifts_ = pad.lifts;
  if (pad.lifts || over_.page()) lift();
  press_.rest_pads();
  if (over_.page()) return;

  for (const int button : cap.buttons)
    notes_.note(tools_.drill().change_burr(button == 0 ? -1 : 1));
  move_by_pads(pad, cap, dt);

  if (pad.lifts) return;
  const double depth = std::max(pad.press, plane_.on() ? 0.0 : -std::min(cap.up, 0.0));
  press_.trigger(depth);
  if (depth > 0) pointer_.lead();
  press_.pedal(foot, pad.slow);
}

void MillHand::move_by_pads(const PadSticks& pad, const CapMotion& cap, double dt) {
  const Settings& settings = desk_.settings;
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
  view_.turn(kTurnPace * dt * sum(pad.turn_right, -cap.twist),
             kTurnPace * dt * sum(turn_up, cap.tilt), false);
}

// A device that was unplugged while it pressed stops pressing, also if it had switched on holding.
void MillHand::look_for_hands() {
  const int there = desk_.pads.count() + desk_.pedals.count();
  if (there < hands_there_) {
    lift();
    notes_.note(word(Word::hand_gone));
  } else if (there > hands_there_ && hands_there_ >= 0) {
    notes_.note(word(Word::hand_here));
  }
  hands_there_ = there;
}

void MillHand::tell(HudState& hud) const {
  hud.user_limit = user_limit();
  hud.press = pressing() ? press_.depth() : press_.full();
  hud.press_most = Press::kMost;
  hud.pressing = hands_.real != nullptr ? row_.hand.pedal > 0
                 : headset_.wand()      ? headset_.trigger()
                                        : pressing();
  if (plane_.on() && !headset_.wand()) {  // in the plane the hand itself is inside the bone
    hud.press = row_.contact.touching ? row_.contact.depth : 0;
    hud.pressing = row_.contact.touching;
  }
}

}  // namespace burr::app
