#include "window/window.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "burr/math/turn.h"
#include "burr/render/pick.h"
#include "burr/render/renderer.h"
#include "burr/rt/stats.h"
#include "command.h"

namespace burr::app {
namespace {

using math::Vec3;
using Clock = std::chrono::steady_clock;

constexpr double kHover = 3e-3;         // above the bone while not pressing             [m]
constexpr double kPress = 4e-3;         // how far below the surface the arm is aimed    [m]
constexpr double kPressLeast = 0.5e-3;  // ... at least, at most                         [m]
constexpr double kPressMost = 6e-3;
constexpr int kPatchesPerFrame = 256;  // sent to the GPU; more wait for the next frame

// What the mouse wants, from SDL's events.
class Mill {
 public:
  Mill(sim::Session& session, MouseHand& hand, surface::Worker& worker, render::Scene& scene,
       const WindowOptions& options)
      : session_(session), hand_(hand), worker_(worker), scene_(scene), options_(options) {}

  Status run();

 private:
  void take_events();
  void key(SDL_Keycode code);
  void move(const SDL_MouseMotionEvent& motion);
  void point();
  void look_at_session();
  void say();
  void leave_picture();

  sim::Session& session_;
  MouseHand& hand_;
  surface::Worker& worker_;
  render::Scene& scene_;
  WindowOptions options_;
  std::unique_ptr<render::Renderer> renderer_;
  render::Camera first_view_;

  bool open_ = true, help_ = true, pressing_ = false, picture_ = false;
  int mouse_x_ = 0, mouse_y_ = 0, width_ = 1, height_ = 1;
  double press_ = kPress;
  Vec3 normal_ = Vec3::Zero();  // of the surface under the mouse, calmed
  std::optional<Vec3> point_;   // there
  record::TickRow row_;
  rt::TickStats stats_;
  int pictures_ = 0;
  std::string note_;  // last thing done
  Clock::time_point said_{};
};

Status Mill::run() {
  auto renderer = render::Renderer::window("burr", 1280, 720);
  if (!renderer) return renderer.error();
  renderer_ = std::move(*renderer);
  first_view_ = scene_.camera;
  scene_.scale_bar = true;
  scene_.burr.visible = true;
  const tool::Burr& burr = session_.settings().servo.burr;
  scene_.burr.radius = burr.radius;
  scene_.burr.shaft_radius = burr.shaft_radius;
  scene_.burr.shaft_length = burr.shaft_length;

  session_.start();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    take_events();
    surface::Skin skin;
    for (int i = 0; i < kPatchesPerFrame && worker_.take(skin); ++i) {
      put_skin(scene_, skin);
      worker_.give_back(skin);
    }
    look_at_session();
    point();
    say();
    shown = renderer_->show(scene_);
    if (picture_) leave_picture();

    // where the driver does not wait for the screen: 60 pictures a second are enough; and fewer
    // where the machine does not keep up with the hand
    worker_.hold_back(session_.load() >= sim::Load::mesh);
    const auto pause =
        std::chrono::microseconds(session_.load() >= sim::Load::picture ? 100'000 : 16'667);
    frame = std::max(frame + pause, Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    if (wait.count() > 0) SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  session_.stop();
  renderer_.reset();
  worker_.hold_back(false);
  worker_.settle([this](const surface::Skin& skin) { put_skin(scene_, skin); });
  scene_.text.clear();
  return shown;
}

void Mill::take_events() {
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) switch (event.type) {
      case SDL_QUIT:
        open_ = false;
        break;
      case SDL_KEYDOWN:
        key(event.key.keysym.sym);
        break;
      case SDL_MOUSEMOTION:
        move(event.motion);
        break;
      case SDL_MOUSEBUTTONDOWN:
      case SDL_MOUSEBUTTONUP:
        if (event.button.button == SDL_BUTTON_LEFT) pressing_ = event.type == SDL_MOUSEBUTTONDOWN;
        break;
      case SDL_MOUSEWHEEL:
        render::zoom(scene_.camera, std::pow(1.15, event.wheel.y));
        break;
      case SDL_WINDOWEVENT:
        if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) pressing_ = false;
        break;
      default:
        break;
    }
}

void Mill::key(SDL_Keycode code) {
  const auto wish = [this](record::WishKind kind, double value, const char* note) {
    session_.wish({kind, value});
    note_ = note;
  };
  switch (code) {
    case SDLK_ESCAPE:
    case SDLK_q:
      open_ = false;
      break;
    case SDLK_h:
      help_ = !help_;
      break;
    case SDLK_f:
      scene_.camera = first_view_;
      break;
    case SDLK_u:
      wish(record::WishKind::undo, 0, "undone");
      break;
    case SDLK_y:
      wish(record::WishKind::redo, 0, "redone");
      break;
    case SDLK_r:
      wish(record::WishKind::reset, 0, "back to the start");
      break;
    case SDLK_1:
      wish(record::WishKind::tool_mode, 0, "cut");
      break;
    case SDLK_2:
      wish(record::WishKind::tool_mode, 1, "add");
      break;
    case SDLK_3:
      wish(record::WishKind::tool_mode, 2, "touch only");
      break;
    case SDLK_PLUS:
    case SDLK_EQUALS:
    case SDLK_KP_PLUS:
      press_ = std::min(press_ * 1.25, kPressMost);
      break;
    case SDLK_MINUS:
    case SDLK_KP_MINUS:
      press_ = std::max(press_ / 1.25, kPressLeast);
      break;
    case SDLK_p:
      picture_ = true;
      break;
    default:
      break;
  }
}

void Mill::move(const SDL_MouseMotionEvent& motion) {
  mouse_x_ = motion.x;
  mouse_y_ = motion.y;
  if ((motion.state & SDL_BUTTON_RMASK) != 0)
    render::orbit(scene_.camera, -0.006 * motion.xrel, 0.006 * motion.yrel);
  if ((motion.state & SDL_BUTTON_MMASK) != 0)
    render::pan(scene_.camera, -static_cast<double>(motion.xrel) / height_,
                static_cast<double>(motion.yrel) / height_);
}

// Aims the arm: above the bone under the mouse, or into it while the button is down.
void Mill::point() {
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &width_, &height_);
  const render::Ray ray =
      render::ray_through(scene_.camera, mouse_x_ + 0.5, mouse_y_ + 0.5, width_, height_);
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
  const bool press = pressing_ && hit.has_value();
  const double height = scene_.burr.radius + (press ? -press_ : kHover);

  // the handle leans out of the way, to the right as most hands do
  const Vec3 handle =
      (normal_ + 0.7 * scene_.camera.right() + 0.2 * scene_.camera.above()).normalized();
  MouseHand::Aim aim;
  aim.world_from_tool.p = surface + height * normal_;
  aim.world_from_tool.q = math::shortest_turn(Vec3::UnitZ(), handle);
  aim.pedal = press ? 1 : 0;
  hand_.aim(aim);
}

void Mill::look_at_session() {
  if (session_.view(row_)) {
    stats_.add(static_cast<std::int64_t>(1e3 * static_cast<double>(row_.took_us)));
    scene_.burr.world_from_tool = {row_.contact.proxy, row_.hand.world_from_tool.q};
    // turning is shown, not counted: 40 000 rpm are faster than any eye
    if (row_.spindle_rad_s > 0) scene_.burr.turn = std::remainder(scene_.burr.turn + 0.7, 6.2832);
    render::show_contact(scene_, row_.hand.world_from_tool.p, row_.contact.proxy,
                         row_.contact.force);
  }
  sim::FaultReport fault;
  if (session_.fault(fault)) note_ = "the force was let go: " + flag_words(fault.flags);
}

void Mill::say() {
  if (Clock::now() - said_ < std::chrono::milliseconds(200)) return;
  said_ = Clock::now();
  const std::string flags = flag_words(row_.contact.flags);
  renderer_->title(
      fmt::format("burr - removed {:.1f} mm^3 - force {:.2f} N - tick p99 {:.0f} us{}{}",
                  1e9 * row_.ledger.removed, row_.contact.force.norm(), stats_.quantile_us(0.99),
                  flags.empty() ? "" : " - ", flags));
  scene_.text.clear();
  scene_.text.push_back(fmt::format("removed {:.1f} mm^3   force {:.1f} N   press {:.1f} mm   {}",
                                    1e9 * row_.ledger.removed, row_.contact.force.norm(),
                                    1e3 * press_, note_));
  if (options_.warning)
    if (std::string warning = options_.warning(); !warning.empty())
      scene_.text.push_back(std::move(warning));
  if (help_) {
    scene_.text.emplace_back("left: mill   right: turn   middle: shift   wheel: zoom   + -: press");
    scene_.text.emplace_back(
        "U undo  Y redo  R reset  1 cut  2 add  3 touch  F first view  P picture  H help  Q quit");
  }
}

void Mill::leave_picture() {
  picture_ = false;
  const std::string name = fmt::format("burr_{:03d}.png", ++pictures_);
  const std::filesystem::path path = std::filesystem::path(options_.folder) / name;
  const Status left = render::write_png(renderer_->shown(), path);
  note_ = left ? "picture " + name : left.error().text;
}

}  // namespace

std::string flag_words(std::uint32_t flags) {
  const std::pair<std::uint32_t, const char*> words[] = {
      {haptics::kFlagNotFinite, "number trouble"},     {haptics::kFlagHandLost, "hand lost"},
      {haptics::kFlagWatchdog, "ticks lost"},          {haptics::kFlagJump, "hand leapt"},
      {haptics::kFlagForceLimited, "force limited"},   {haptics::kFlagThermal, "motors warm"},
      {haptics::kFlagCandidates, "too many contacts"}, {haptics::kFlagReserve, "no room to add"},
      {haptics::kFlagUndoFull, "undo full"},           {haptics::kFlagRestoring, "restoring"},
      {haptics::kFlagNotCut, "not all cut"},           {haptics::kFlagPutOff, "cutting in turns"},
  };
  std::string text;
  for (const auto& [flag, word] : words)
    if ((flags & flag) != 0) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

void put_skin(render::Scene& scene, const surface::Skin& skin) {
  if (skin.mesh == nullptr) return;
  render::set_patch(scene, skin.patch, *skin.mesh);
}

Status run_window(sim::Session& session, MouseHand& hand, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  return Mill(session, hand, worker, scene, options).run();
}

}  // namespace burr::app
