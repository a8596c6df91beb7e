#include "window/replay_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "command.h"
#include "live_bone.h"
#include "still.h"
#include "window/export_page.h"
#include "window/help.h"
#include "window/hud.h"
#include "window/mirror_mode.h"
#include "window/see_through.h"
#include "window/timeline_panel.h"
#include "window/words.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPaces[] = {0.25, 0.5, 1, 2, 4, 8};
constexpr double kStep = 1, kSmallStep = 0.05;  // of an arrow; with Shift  [s]
constexpr double kTurn = 0.006;                 // of the view, by a pixel of the mouse  [rad]
constexpr auto kPatience = std::chrono::milliseconds(150);  // before "..." is shown

class Watch {
 public:
  Watch(Desk& desk, Recorded& recorded, const WatchOptions& options)
      : desk_(desk), recorded_(recorded), scene_(recorded.scene), options_(options) {}

  Result<Left> run();

 private:
  void take_events();
  void key(const SDL_Keysym& pressed);
  void move(const SDL_MouseMotionEvent& motion);
  void go(double t);
  void play(bool playing);
  void change_pace(int by);
  void turn_view(double right, double up, bool shift);
  void look_at(Playback& playback, LiveBone& live);
  void panels();
  void show_labels(bool shown);
  void note(std::string text) {
    note_ = std::move(text);
    noted_ = Clock::now();
  }
  [[nodiscard]] bool page_open() const { return help_ || (export_ && export_->shown()); }
  [[nodiscard]] double burr_radius() const;
  [[nodiscard]] sim::ToolMode mode() const;
  [[nodiscard]] edit::Mirror mirror() const;

  Desk& desk_;
  Recorded& recorded_;
  render::Scene& scene_;
  const WatchOptions& options_;

  render::Camera first_view_;
  std::vector<render::Colour> colours_;
  Playback::Shown shown_;
  Watched now_;
  bool open_ = true, picture_ = false, panels_ = true, help_ = false, scrubbing_ = false;
  bool labels_ = true, leaves_ = false;  // leaves though a film is still being made
  std::optional<ExportPage> export_;
  Left left_ = Left::window;
  std::string note_, warning_;
  Clock::time_point noted_{}, in_time_ = Clock::now();
};

Result<Left> Watch::run() {
  desk_.page = Page::replay;
  desk_.renderer().title("burr");
  export_.emplace(desk_, nullptr, scene_, options_.folder, [this] {
    recorded_.film.effects = desk_.settings.effects;
    return std::optional(recorded_.film);
  });
  first_view_ = scene_.camera;
  colours_ = scene_.tissue_colours;
  scene_.scale_bar = false;
  warning_ = recorded_.notices.empty() ? std::string() : recorded_.notices.front();
  now_.t = std::max(0.0, options_.from);
  now_.playing = options_.from < 0;
  LiveBone live(*recorded_.bone, *recorded_.worker, scene_, desk_.renderer().software());
  Playback playback(recorded_);
  playback.want(now_.t);

  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start, last = start;
  double asked = now_.t;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    const Clock::time_point began = Clock::now();
    take_events();
    // time goes on, unless the user holds it
    const double passed = std::chrono::duration<double>(began - last).count();
    last = began;
    if (now_.playing && !scrubbing_) now_.t += now_.pace * std::min(passed, 0.25);
    if (now_.t >= recorded_.timeline.seconds) {
      now_.t = recorded_.timeline.seconds;
      if (!scrubbing_) now_.playing = false;
    }
    // a machine that cannot follow shows fewer moments, not a longer session
    if (now_.t != asked) playback.want(asked = now_.t);
    look_at(playback, live);
    live.update();
    const Clock::time_point drawing = Clock::now();
    if (std::string told = export_->step(); !told.empty()) note(std::move(told));
    shown =
        desk_.show(scene_, panels_ || page_open() ? [this] { panels(); } : std::function<void()>());
    live.drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
               desk_.renderer().figures().redrawn);
    now_.note = !export_->trouble().empty() ? export_->trouble() : note_;
    if (options_.seen != nullptr) *options_.seen = now_;
    if (std::exchange(picture_, false)) {
      const Result<std::string> left = desk_.leave_picture(options_.folder);
      note(left ? say(Word::picture_left, *left) : left.error().text);
    }
    frame = std::max(frame + std::chrono::microseconds(16'667), Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    if (wait.count() > 0) SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  export_.reset();
  scene_.tissue_colours = colours_;
  scene_.look.opacity = 1;
  live.look_plain();
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return left_;
}

void Watch::look_at(Playback& playback, LiveBone& live) {
  if (playback.take(shown_)) {
    now_.shown = shown_.t;
    if (desk_.settings.effects) live.see(shown_.told);
    if (shown_.trouble.empty()) {
      put_tool(scene_, shown_.row, burr_radius(), true);
      const tool::Burr& burr = recorded_.settings.settings.servo.burr;
      scene_.burr.shaft_radius = burr.shaft_radius;
      scene_.burr.shaft_length = burr.shaft_length;
      if (now_.playing && shown_.row.spindle_rad_s > 0)
        scene_.burr.turn = std::remainder(scene_.burr.turn + 0.7, 6.2832);
      now_.force = shown_.row.contact.force.norm();
      now_.removed = shown_.row.ledger.removed;
    }
    warning_ = !shown_.trouble.empty()      ? shown_.trouble
               : !recorded_.notices.empty() ? recorded_.notices.front()
                                            : std::string();
  }
  show_mirror(scene_, recorded_.bone->grid(), mirror());
  // the picture is whole when bone, surface and GPU have it; while it plays a little lag is none
  const bool whole = !playback.behind() && recorded_.worker->waiting() == 0;
  if (whole) in_time_ = Clock::now();
  now_.behind = !whole && Clock::now() - in_time_ > kPatience;
  if (Clock::now() - noted_ > std::chrono::seconds(6)) note_.clear();
}

double Watch::burr_radius() const {
  // as wished: whether the servo had room for it stands nowhere in a recording
  const double first = recorded_.settings.settings.servo.burr.radius;
  const double wished =
      recorded_.timeline.wished(record::WishKind::burr_radius, shown_.t).value_or(first);
  return wished > 0 && wished <= 0.5 * tool::kLargestDiameter + 1e-12 ? wished : first;
}

sim::ToolMode Watch::mode() const {
  const double wished = recorded_.timeline.wished(record::WishKind::tool_mode, shown_.t)
                            .value_or(static_cast<double>(recorded_.settings.settings.servo.mode));
  return wished >= 0 && wished < sim::kToolModes
             ? static_cast<sim::ToolMode>(static_cast<int>(wished))
             : sim::ToolMode::cut;
}

edit::Mirror Watch::mirror() const {
  const math::Ijk& size = recorded_.bone->grid().size;
  edit::Mirror now;
  for (const record::TimelineEvent& event : recorded_.timeline.events) {
    if (event.t_s > shown_.t) break;
    now = sim::mirror_of(event.wish, size).value_or(now);
  }
  return now;
}

// ---- mouse and keys

void Watch::take_events() {
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
      case SDL_MOUSEWHEEL:
        if (!page_open() && !desk_.ui().over_panel())
          render::zoom(scene_.camera, std::pow(1.15, desk_.settings.zoom_pace * event.wheel.y));
        break;
      case SDL_MULTIGESTURE:
        render::zoom(scene_.camera, std::exp(4 * static_cast<double>(event.mgesture.dDist)));
        break;
      default:
        break;
    }
}

void Watch::key(const SDL_Keysym& pressed) {
  const bool shift = (pressed.mod & KMOD_SHIFT) != 0, ctrl = (pressed.mod & KMOD_CTRL) != 0;
  const record::Timeline& line = recorded_.timeline;
  switch (pressed.sym) {
    case SDLK_ESCAPE:
      if (page_open()) {
        help_ = false;
        export_->show(false);
        break;
      }
      [[fallthrough]];
    case SDLK_q:
      if (!export_->progress().empty() && !std::exchange(leaves_, true)) {
        note(word(Word::export_wait));
        break;
      }
      left_ = Left::page;
      open_ = false;
      break;
    case SDLK_SPACE:
      play(!now_.playing);
      break;
    case SDLK_LEFT:
      go(ctrl ? line.stroke_before(now_.t - 0.5).value_or(0)
              : now_.t - (shift ? kSmallStep : kStep));
      break;
    case SDLK_RIGHT:
      go(ctrl ? line.stroke_after(now_.t).value_or(line.seconds)
              : now_.t + (shift ? kSmallStep : kStep));
      break;
    case SDLK_UP:
    case SDLK_DOWN:
      turn_view(0, pressed.sym == SDLK_UP ? 12 : -12, shift);
      break;
    case SDLK_HOME:
      go(0);
      break;
    case SDLK_END:
      go(line.seconds);
      break;
    case SDLK_COMMA:
    case SDLK_MINUS:
    case SDLK_KP_MINUS:
      change_pace(-1);
      break;
    case SDLK_PERIOD:
    case SDLK_PLUS:
    case SDLK_EQUALS:
    case SDLK_KP_PLUS:
      change_pace(1);
      break;
    case SDLK_f:
      scene_.camera = first_view_;
      break;
    case SDLK_l:
      show_labels(!labels_);
      break;
    case SDLK_t:
      note(step_see_through(scene_, shift));
      break;
    case SDLK_TAB:
      panels_ = !panels_;
      break;
    case SDLK_F1:
    case SDLK_h:
      help_ = !help_;
      export_->show(false);
      break;
    case SDLK_e:
      export_->show(!export_->shown());
      help_ = false;
      break;
    case SDLK_p:
      picture_ = true;
      break;
    default:
      break;
  }
}

void Watch::go(double t) { now_.t = std::clamp(t, 0.0, recorded_.timeline.seconds); }

void Watch::play(bool playing) {
  // at the end it begins again
  if (playing && now_.t >= recorded_.timeline.seconds) now_.t = 0;
  now_.playing = playing;
}

void Watch::change_pace(int by) {
  const auto at = std::find(std::begin(kPaces), std::end(kPaces), now_.pace) - std::begin(kPaces);
  now_.pace = kPaces[std::clamp<std::ptrdiff_t>(at + by, 0, std::ssize(kPaces) - 1)];
}

void Watch::turn_view(double right, double up, bool shift) {
  int wide = 1, high = 1;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  if (shift)
    render::pan(scene_.camera, right / high, up / high);
  else
    render::orbit(scene_.camera, kTurn * desk_.settings.turn_pace * right,
                  kTurn * desk_.settings.turn_pace * up);
}

// Nothing is milled here, so both buttons turn.
void Watch::move(const SDL_MouseMotionEvent& motion) {
  if (page_open() || scrubbing_ || desk_.ui().over_panel()) return;
  if ((motion.state & (SDL_BUTTON_LMASK | SDL_BUTTON_RMASK)) != 0)
    turn_view(-motion.xrel, motion.yrel, false);
  if ((motion.state & SDL_BUTTON_MMASK) != 0) turn_view(-motion.xrel, motion.yrel, true);
}

void Watch::show_labels(bool shown) {
  labels_ = shown;
  scene_.tissue_colours = shown ? colours_ : render::as_bone(colours_);
}

// ---- what is drawn

void Watch::panels() {
  Ui& ui = desk_.ui();
  if (panels_) {
    TimelineState s;
    s.line = &recorded_.timeline;
    s.t = now_.t;
    s.playing = now_.playing;
    s.behind = now_.behind;
    s.pace = now_.pace;
    s.force = now_.force;
    s.removed = now_.removed;
    s.speed = shown_.row.spindle_rad_s;
    s.burr_diameter = 2 * burr_radius();
    s.mode = mode();
    if (const edit::Mirror now = mirror(); now.on())
      draw_mirror_sign(ui, mirror_words(recorded_.bone->grid(), now), 0);
    s.note = note_.empty() ? export_->progress() : note_;
    s.warning = warning_;
    const TimelineDone done = draw_timeline(ui, s);
    scrubbing_ = done.scrubbed.has_value();
    if (done.scrubbed) go(*done.scrubbed);
    if (done.play) play(!now_.playing);
    if (done.pace != 0) change_pace(done.pace);
  }
  if (help_) help_ = draw_replay_help(ui);
  if (export_->shown()) export_->draw();
}

}  // namespace

Result<Left> watch(Desk& desk, Recorded& recorded, const WatchOptions& options) {
  return Watch(desk, recorded, options).run();
}

}  // namespace burr::app
