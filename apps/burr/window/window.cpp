#include "window/window.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "burr/math/turn.h"
#include "burr/render/pick.h"
#include "burr/rt/stats.h"
#include "burr/tool/burr_tool.h"
#include "command.h"
#include "live_bone.h"
#include "still.h"
#include "window/export_page.h"
#include "window/help.h"
#include "window/hud.h"
#include "window/measuring.h"
#include "window/see_through.h"
#include "window/settings_page.h"
#include "window/slices.h"
#include "window/toolbar.h"
#include "window/words.h"

namespace burr::app {
namespace {

using math::Vec3;
using Clock = std::chrono::steady_clock;

constexpr double kHover = 3e-3;         // above the bone while not pressing             [m]
constexpr double kPressLeast = 0.5e-3;  // how far below the surface the arm is aimed    [m]
constexpr double kPressMost = 6e-3;
// diameters that burrs come in [m]
constexpr double kSizes[] = {0.6e-3, 0.8e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3,
                             4e-3,   4.5e-3, 5e-3, 5.5e-3, 6e-3, 6.5e-3, 7e-3};
constexpr double kRpmStep = 5000, kRpmMost = 80'000;
constexpr double kTurn = 0.006;  // of the view, by a pixel of the mouse  [rad]

constexpr std::pair<std::uint32_t, Word> kFlagWords[] = {
    {haptics::kFlagNotFinite, Word::flag_not_finite},
    {haptics::kFlagHandLost, Word::flag_hand_lost},
    {haptics::kFlagWatchdog, Word::flag_watchdog},
    {haptics::kFlagJump, Word::flag_jump},
    {haptics::kFlagForceLimited, Word::flag_force_limited},
    {haptics::kFlagThermal, Word::flag_thermal},
    {haptics::kFlagCandidates, Word::flag_candidates},
    {haptics::kFlagReserve, Word::flag_reserve},
    {haptics::kFlagUndoFull, Word::flag_undo_full},
    {haptics::kFlagRestoring, Word::flag_restoring},
    {haptics::kFlagNotCut, Word::flag_not_cut},
    {haptics::kFlagPutOff, Word::flag_put_off},
};

// What a surgeon should see at once, in the user's language. That ticks are put off is told by
// their own sign, that a limit holds by the force's bar.
std::string told_flags(std::uint32_t flags) {
  std::string text;
  flags &= ~(haptics::kFlagPutOff | haptics::kFlagForceLimited);
  for (const auto& [flag, says] : kFlagWords)
    if ((flags & flag) != 0) text += (text.empty() ? "" : ", ") + std::string(word(says));
  return text;
}

// What the mouse wants, from SDL's events.
class Mill {
 public:
  Mill(Desk& desk, sim::Session& session, MouseHand& hand, surface::Worker& worker,
       render::Scene& scene, const WindowOptions& options)
      : desk_(desk),
        session_(session),
        hand_(hand),
        worker_(worker),
        scene_(scene),
        options_(options),
        first_view_(scene.camera) {}

  Result<Left> run();

 private:
  void take_events();
  void key(const SDL_Keysym& pressed);
  void move(const SDL_MouseMotionEvent& motion);
  void button(const SDL_MouseButtonEvent& button);
  void wheel(const SDL_MouseWheelEvent& wheel);
  void turn_view(double right, double up, bool shift);
  void act(Action action);
  void change_burr(int by);
  void change_speed(double by);
  void push(double factor);
  void lift();
  void point();
  void look_at_session();
  void show_labels(bool shown);
  void toggle_sound();
  void toggle_coolant();
  void look_at_burr();
  void measure();
  void tell();
  void note(std::string text);
  void panels();
  [[nodiscard]] HudState hud() const;
  [[nodiscard]] bool pressing() const {
    return (pressing_ || held_) && !measuring_.picks() && !page_open() &&
           !desk_.ui().over_panel() && !over_slices();
  }
  [[nodiscard]] bool over_slices() const;
  void aim_at_mouse() {
    aim_x_ = mouse_x_;
    aim_y_ = mouse_y_;
  }
  [[nodiscard]] bool page_open() const {
    return help_ || settings_page_ || (export_ && export_->shown());
  }
  void leave_picture();

  Desk& desk_;
  sim::Session& session_;
  MouseHand& hand_;
  surface::Worker& worker_;
  render::Scene& scene_;
  WindowOptions options_;
  render::Camera first_view_;

  bool open_ = true, picture_ = false;
  Left left_ = Left::window;
  bool panels_ = true, help_ = false, settings_page_ = false;
  int picture_step_ = 0;
  std::optional<Slices> slices_;
  std::optional<ExportPage> export_;
  bool leaves_ = false;  // though a file is still being written
  bool irrigated_ = false;
  bool slices_shown_ = true, labels_ = true, pulls_window_ = false;
  std::vector<render::Colour> colours_;   // of the tissues, while labels are shown
  bool pressing_ = false, held_ = false;  // by the button; by the space bar
  int mouse_x_ = 0, mouse_y_ = 0, width_ = 1, height_ = 1;
  int aim_x_ = 0, aim_y_ = 0;  // where the mouse was last that was no slice
  double press_ = 4e-3;
  Vec3 normal_ = Vec3::Zero();  // of the surface under the mouse, calmed
  std::optional<Vec3> point_;   // there
  sim::ToolMode mode_ = sim::ToolMode::cut;
  Measuring measuring_;
  double full_speed_ = 0;              // wished [rad/s]
  std::optional<double> burr_wished_;  // radius, until it is so or refused [m]
  Clock::time_point burr_wished_at_{};
  record::TickRow row_;
  rt::TickStats stats_;
  std::optional<std::pair<std::uint64_t, Clock::time_point>> first_tick_;
  std::uint64_t missed_ = 0;
  Clock::time_point missed_at_{}, lost_at_{};
  std::optional<HudState::Nearest> nearest_;
  std::string note_, warning_;  // last thing done; what must be known
  Clock::time_point noted_{}, said_{};
};

Result<Left> Mill::run() {
  desk_.page = Page::milling;
  scene_.scale_bar = false;  // the panels have one
  scene_.burr.visible = true;
  const tool::Burr& burr = session_.settings().servo.burr;
  scene_.burr.radius = burr.radius;
  scene_.burr.shaft_radius = burr.shaft_radius;
  scene_.burr.shaft_length = burr.shaft_length;
  mode_ = session_.settings().servo.mode;
  irrigated_ = session_.settings().servo.irrigated;
  full_speed_ = session_.settings().servo.spindle_rad_s;
  panels_ = desk_.settings.panels;
  help_ = desk_.settings.help;
  press_ = std::clamp(1e-3 * desk_.settings.press_mm, kPressLeast, kPressMost);
  if (desk_.settings.force_limit_n != session_.settings().servo.limit.user_force)
    session_.wish({record::WishKind::user_force, desk_.settings.force_limit_n});
  for (const std::string& trouble : std::exchange(desk_.troubles, {})) note(trouble);

  LiveBone live(session_, worker_, scene_, desk_.renderer().software());
  slices_.emplace(session_.bone(), options_.greys);
  export_.emplace(desk_, session_, scene_, options_.folder);
  colours_ = scene_.tissue_colours;
  SDL_GetMouseState(&mouse_x_, &mouse_y_);  // before it moves
  aim_at_mouse();
  session_.start();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    take_events();
    look_at_session();
    if (!desk_.settings.effects)
      live.look_plain();
    else if (first_tick_)
      live.see(wound_tick(row_, session_.settings().servo.rate_hz, scene_.burr.radius, irrigated_));
    point();
    measure();
    if (std::string told = export_->step(); !told.empty()) note(std::move(told));
    tell();
    slices_->update(scene_, slices_shown_ && panels_, labels_, desk_.renderer().width(),
                    desk_.renderer().height(), static_cast<int>(hud_height(desk_.ui())));
    live.update();
    const Clock::time_point drawing = Clock::now();
    shown = desk_.show(scene_, panels_ || page_open() || measuring_.on() ? [this] { panels(); }
                                                                         : std::function<void()>());
    live.drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
               desk_.renderer().figures().redrawn);
    picture_step_ = live.governor().step();
    if (picture_) leave_picture();

    // where the driver does not wait for the screen: 60 pictures a second are enough; and fewer
    // where the machine does not keep up with the hand
    const auto pause =
        std::chrono::microseconds(session_.load() >= sim::Load::picture ? 100'000 : 16'667);
    frame = std::max(frame + pause, Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    if (wait.count() > 0) SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  export_.reset();
  session_.stop();
  scene_.insets.clear();
  scene_.tissue_colours = colours_;
  scene_.look.opacity = 1;
  live.look_plain();
  worker_.hold_back(false);
  worker_.settle([this](const surface::Skin& skin) { put_skin(scene_, skin); });
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return left_;
}

// ---- mouse and keys

void Mill::take_events() {
  SDL_Event event;
  while (desk_.next(event)) switch (event.type) {
      case SDL_QUIT:
        open_ = false;
        break;
      case SDL_KEYDOWN:
        if (!desk_.ui().typing()) key(event.key.keysym);
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

void Mill::key(const SDL_Keysym& pressed) {
  const bool shift = (pressed.mod & KMOD_SHIFT) != 0;
  switch (pressed.sym) {
    case SDLK_ESCAPE:
      if (page_open()) {
        help_ = settings_page_ = false;
        export_->show(false);
      } else if (measuring_.on()) {
        measuring_.stop();
        note(word(Word::measure_off));
      } else
        act(Action::leave);
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
    case SDLK_LEFTBRACKET:
    case SDLK_PAGEDOWN:
      act(Action::smaller);
      break;
    case SDLK_RIGHTBRACKET:
    case SDLK_PAGEUP:
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
      note(word(options_.keep && options_.keep() ? Word::session_kept : Word::session_not_kept));
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

void Mill::act(Action action) {
  const auto wish = [this](record::WishKind kind, double value, Word says) {
    session_.wish({kind, value});
    note(word(says));
  };
  const auto mode = [&](sim::ToolMode to, Word says) {
    mode_ = to;
    wish(record::WishKind::tool_mode, static_cast<double>(to), says);
  };
  switch (action) {
    case Action::cut:
      return mode(sim::ToolMode::cut, Word::now_cut);
    case Action::add:
      return mode(sim::ToolMode::add, Word::now_add);
    case Action::touch:
      return mode(sim::ToolMode::touch, Word::now_touch);
    case Action::back:
      return mode(sim::ToolMode::restore, Word::now_back);
    case Action::smooth:
      return mode(sim::ToolMode::smooth, Word::now_smooth);
    case Action::undo:
      return wish(record::WishKind::undo, 0, Word::undone);
    case Action::redo:
      return wish(record::WishKind::redo, 0, Word::redone);
    case Action::reset:
      return wish(record::WishKind::reset, 0, Word::back_to_start);
    case Action::measure:
      measuring_.next();
      lift();
      note(measuring_.on() ? measuring_.words() : word(Word::measure_off));
      break;
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

// The next size of kSizes that the voxels bear; the servo has the last word.
void Mill::change_burr(int by) {
  const double least =
      std::max(tool::kSmallestDiameter, 4 * session_.bone().grid().voxel);  // as sim/servo.cpp
  const double now = 2 * burr_wished_.value_or(session_.burr_radius());
  std::optional<double> next;
  for (const double size : kSizes) {
    if (size < least - 1e-9) continue;
    if (by > 0 && size > now + 1e-9 && !next) next = size;
    if (by < 0 && size < now - 1e-9) next = size;
  }
  if (!next)
    return note(say(Word::no_burr, std::ceil(1e4 * least) / 10, 1e3 * tool::kLargestDiameter));
  burr_wished_ = 0.5 * *next;
  burr_wished_at_ = Clock::now();
  session_.wish({record::WishKind::burr_radius, *burr_wished_});
}

void Mill::change_speed(double by) {
  constexpr double kRpm = 2 * std::numbers::pi / 60;
  const double rpm =
      std::clamp(std::round(full_speed_ / kRpm / kRpmStep) * kRpmStep + by, kRpmStep, kRpmMost);
  full_speed_ = rpm * kRpm;
  session_.wish({record::WishKind::spindle_speed, full_speed_});
  note(say(Word::speed_now, rpm));
}

void Mill::push(double factor) { press_ = std::clamp(press_ * factor, kPressLeast, kPressMost); }

void Mill::lift() { pressing_ = held_ = false; }

void Mill::button(const SDL_MouseButtonEvent& button) {
  const Uint8 mills = desk_.settings.left_handed ? SDL_BUTTON_RIGHT : SDL_BUTTON_LEFT;
  if (button.button != mills && button.button != SDL_BUTTON_MIDDLE)
    pulls_window_ = button.type == SDL_MOUSEBUTTONDOWN && over_slices();
  if (button.button != mills) return;
  if (measuring_.picks()) {
    const bool down = button.type == SDL_MOUSEBUTTONDOWN;
    if (!down || page_open() || desk_.ui().over_panel() || over_slices()) return;
    const auto hit = render::pick(scene_, render::ray_through(scene_.camera, mouse_x_ + 0.5,
                                                              mouse_y_ + 0.5, width_, height_));
    if (hit) measuring_.pick(hit->p);
    return note(measuring_.words());
  }
  // what began on a panel is not for the bone
  pressing_ = button.type == SDL_MOUSEBUTTONDOWN && !desk_.ui().over_panel();
}

void Mill::wheel(const SDL_MouseWheelEvent& wheel) {
  if (page_open() || desk_.ui().over_panel()) return;
  const double by =
      wheel.preciseY != 0 ? static_cast<double>(wheel.preciseY) : static_cast<double>(wheel.y);
  const SDL_Keymod held = SDL_GetModState();
  if ((held & KMOD_CTRL) != 0)
    push(std::pow(1.1, by));
  else if ((held & KMOD_SHIFT) != 0 && by != 0)
    change_burr(by > 0 ? 1 : -1);
  else
    render::zoom(scene_.camera, std::pow(1.15, by * desk_.settings.zoom_pace));
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
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &width_, &height_);
  const render::Ray ray =
      render::ray_through(scene_.camera, aim_x_ + 0.5, aim_y_ + 0.5, width_, height_);
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
  const double height = scene_.burr.radius + (press ? -press_ : kHover);

  // the handle leans out of the way, to the side of the hand that holds it
  const double side = desk_.settings.left_handed ? -0.7 : 0.7;
  const Vec3 handle =
      (normal_ + side * scene_.camera.right() + 0.2 * scene_.camera.above()).normalized();
  MouseHand::Aim aim;
  aim.world_from_tool.p = surface + height * normal_;
  aim.world_from_tool.q = math::shortest_turn(Vec3::UnitZ(), handle);
  aim.pedal = press ? 1 : 0;
  hand_.aim(aim);
}

// The thickness goes with the burr: along its contact, or below where it hovers.
void Mill::measure() {
  const Vec3 inward = row_.contact.touching ? Vec3(-row_.contact.normal) : Vec3(-normal_);
  if (measuring_.what() == Measure::thickness)
    measuring_.probe(session_.bone(), scene_.burr.world_from_tool.p, inward,
                     scene_.burr.radius + 2 * kHover);
}

// ---- what is told

void Mill::look_at_session() {
  if (session_.view(row_)) {
    const Clock::time_point now = Clock::now();
    stats_.add(static_cast<std::int64_t>(1e3 * static_cast<double>(row_.took_us)));
    scene_.burr.world_from_tool = {row_.contact.proxy, row_.hand.world_from_tool.q};
    // turning is shown, not counted: 40 000 rpm are faster than any eye
    if (row_.spindle_rad_s > 0) scene_.burr.turn = std::remainder(scene_.burr.turn + 0.7, 6.2832);
    render::show_contact(scene_, row_.hand.world_from_tool.p, row_.contact.proxy,
                         row_.contact.force);
    if (options_.loudspeaker != nullptr) options_.loudspeaker->hear(row_);
    if ((row_.contact.flags & haptics::kFlagWatchdog) != 0) lost_at_ = now;

    // ticks that are not there by now; two may be under way
    if (!first_tick_) first_tick_ = {row_.tick, now};
    const double due = std::chrono::duration<double>(now - first_tick_->second).count() *
                       session_.settings().servo.rate_hz;
    const double done = static_cast<double>(row_.tick - first_tick_->first);
    const auto missed = static_cast<std::uint64_t>(std::max(0.0, due - done - 2));
    if (missed > missed_ + 3) missed_at_ = now;
    missed_ = std::max(missed_, missed);
  }
  look_at_burr();
  nearest_.reset();
  if (options_.nearby != nullptr)
    if (auto near = options_.nearby->nearest(scene_.burr.world_from_tool.p))
      nearest_ = {std::move(near->name), near->distance - scene_.burr.radius};
  sim::FaultReport fault;
  if (session_.fault(fault)) note(say(Word::let_go, told_flags(fault.flags)));
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

void Mill::toggle_sound() {
  options_.loudspeaker->toggle();
  if (!options_.loudspeaker->trouble().empty()) return note(options_.loudspeaker->trouble());
  note(word(options_.loudspeaker->is_on() ? Word::sound_on : Word::sound_off));
}

void Mill::toggle_coolant() {
  irrigated_ = !irrigated_;
  const record::Wish wish = {record::WishKind::irrigation, irrigated_ ? 1.0 : 0.0};
  session_.wish(wish);
  if (options_.loudspeaker != nullptr) options_.loudspeaker->obey(wish);
  note(word(irrigated_ ? Word::coolant_on : Word::coolant_off));
}

// The burr that is wished for, or the sentence why not.
void Mill::look_at_burr() {
  const double radius = session_.burr_radius();
  if (radius != scene_.burr.radius && options_.loudspeaker != nullptr)
    options_.loudspeaker->obey({record::WishKind::burr_radius, radius});
  scene_.burr.radius = radius;
  if (!burr_wished_) return;
  const bool so = std::abs(scene_.burr.radius - *burr_wished_) < 1e-9;
  if (!so && Clock::now() - burr_wished_at_ < std::chrono::milliseconds(300)) return;
  note(so ? say(Word::burr_now, 2e3 * scene_.burr.radius) : std::string(word(Word::no_room)));
  burr_wished_.reset();
}

void Mill::note(std::string text) {
  note_ = std::move(text);
  noted_ = Clock::now();
}

void Mill::tell() {
  if (Clock::now() - said_ < std::chrono::milliseconds(200)) return;
  said_ = Clock::now();
  const std::string flags = flag_words(row_.contact.flags);
  desk_.renderer().title(
      fmt::format("burr - removed {:.1f} mm^3 - force {:.2f} N - tick p99 {:.0f} us{}{}",
                  1e9 * row_.ledger.removed, row_.contact.force.norm(), stats_.quantile_us(0.99),
                  flags.empty() ? "" : " - ", flags));
  warning_ = options_.warning ? options_.warning() : std::string();
  if (warning_.empty()) warning_ = told_flags(row_.contact.flags);
  if (Clock::now() - noted_ > std::chrono::seconds(6)) note_.clear();
  if (note_.empty()) note_ = export_->progress();
  if (note_.empty()) note_ = measuring_.words();
  desk_.said = !export_->trouble().empty() ? export_->trouble()
               : warning_.empty()          ? note_
                                           : warning_;
}

HudState Mill::hud() const {
  const sim::SessionSettings& settings = session_.settings();
  HudState s;
  s.force = row_.contact.force.norm();
  s.user_limit = desk_.settings.force_limit_n;
  s.device_limit = session_.hand().spec().peak_force;
  s.press = press_;
  s.press_most = kPressMost;
  s.pressing = pressing();
  s.speed = row_.spindle_rad_s;
  s.full_speed = full_speed_;
  if (settings.servo.motor.torque > 0)
    s.load = std::clamp(row_.cutting_nm / settings.servo.motor.torque, 0.0, 1.0);
  s.burr_diameter = 2 * scene_.burr.radius;
  s.mode = mode_;
  s.removed = row_.ledger.removed;
  s.seconds = static_cast<double>(row_.tick) / settings.servo.rate_hz;
  s.nearest = nearest_;
  s.spares = options_.nearby != nullptr && !options_.nearby->empty();
  const Clock::time_point now = Clock::now();
  if (now - lost_at_ < std::chrono::seconds(5))
    s.ticks = TickHealth::lost;
  else if (session_.load() != sim::Load::none || now - missed_at_ < std::chrono::seconds(3))
    s.ticks = TickHealth::busy;
  const rt::TickSummary summary = stats_.summary();
  s.p99_us = summary.p99_us;
  s.max_us = summary.max_us;
  s.missed = missed_;
  s.picture_step = picture_step_;
  if (!scene_.insets.empty())
    s.column = static_cast<float>(desk_.renderer().width() - scene_.insets.front().x);
  s.pixel = scene_.camera.view_height() / std::max(1, desk_.renderer().height());
  s.note = note_;
  s.warning = warning_;
  return s;
}

void Mill::panels() {
  Ui& ui = desk_.ui();
  measuring_.draw(ui, scene_.camera);
  if (panels_) {
    draw_hud(ui, hud());
    slices_->write_names(scene_, ui);
    if (const auto pressed = draw_toolbar(ui, mode_, measuring_.on())) act(*pressed);
  }
  if (help_) help_ = draw_help(ui, desk_.settings.left_handed);
  if (export_->shown()) export_->draw();
  if (!settings_page_) return;
  const double limit = desk_.settings.force_limit_n;
  const std::filesystem::path& config = desk_.places().config;
  const SettingsPage page = draw_settings(
      ui, desk_.settings, config.empty() ? std::string() : (config / "settings.toml").string());
  if (desk_.settings.force_limit_n != limit)
    session_.wish({record::WishKind::user_force, desk_.settings.force_limit_n});
  if (page.changed) {
    desk_.settings_changed();
    press_ = std::clamp(1e-3 * desk_.settings.press_mm, kPressLeast, kPressMost);
    for (const std::string& trouble : std::exchange(desk_.troubles, {})) note(trouble);
  }
  if (page.done) settings_page_ = false;
}

void Mill::leave_picture() {
  picture_ = false;
  const Result<std::string> left = desk_.leave_picture(options_.folder);
  note(left ? say(Word::picture_left, *left) : left.error().text);
}

}  // namespace

std::string flag_words(std::uint32_t flags) {
  std::string text;
  for (const auto& [flag, says] : kFlagWords)
    if ((flags & flag) != 0)
      text += (text.empty() ? "" : ", ") + std::string(word(says, Language::english));
  return text;
}

Result<Left> mill(Desk& desk, sim::Session& session, MouseHand& hand, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  return Mill(desk, session, hand, worker, scene, options).run();
}

Status run_window(sim::Session& session, MouseHand& hand, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  auto desk = Desk::open({});
  if (!desk) return desk.error();
  const Result<Left> left = mill(**desk, session, hand, worker, scene, options);
  if (!left) return left.error();
  return fine();
}

}  // namespace burr::app
