#include "window/desk.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace burr::app {
namespace {

std::filesystem::path folder(const char* variable, const char* in_home) {
  const char* given = std::getenv(variable);
  // the specification: relative paths there are to be ignored
  if (given != nullptr && *given == '/') return std::filesystem::path(given) / "burr";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home != '/') return {};
  return std::filesystem::path(home) / in_home / "burr";
}

}  // namespace

DeskPlaces users_places() {
  return {folder("XDG_CONFIG_HOME", ".config"), folder("XDG_STATE_HOME", ".local/state"),
          folder("XDG_CACHE_HOME", ".cache")};
}

Result<std::unique_ptr<Desk>> Desk::open(const DeskPlaces& places) {
  auto renderer = render::Renderer::window("burr", 1280, 720);
  if (!renderer) return renderer.error();
  std::unique_ptr<Desk> desk(new Desk);
  desk->places_ = places;
  desk->renderer_ = std::move(*renderer);
  if (!places.config.empty()) {
    SettingsRead read = read_settings(places.config / "settings.toml");
    desk->settings = read.settings;
    desk->keep_old_ = !read.troubles.empty();
    desk->troubles = std::move(read.troubles);
  }
  speak(desk->settings.language);
  desk->ui_ = Ui::make();
  return desk;
}

void Desk::settings_changed() {
  speak(settings.language);
  if (places_.config.empty()) return;
  const Status kept = write_settings(settings, places_.config / "settings.toml", keep_old_);
  if (kept)
    keep_old_ = false;
  else
    troubles = {kept.error().text};
}

bool Desk::next(SDL_Event& event) {
  if (SDL_PollEvent(&event) == 0) return false;
  if (plugs(event)) {
    pads.scan();
    pedals.scan();
  }
  if (page != Page::milling) as_key(event);
  ui_->event(event);
  if (event.type == SDL_WINDOWEVENT) switch (event.window.event) {
      case SDL_WINDOWEVENT_MINIMIZED:
      case SDL_WINDOWEVENT_HIDDEN:
        minimised_ = true;
        break;
      case SDL_WINDOWEVENT_RESTORED:
      case SDL_WINDOWEVENT_MAXIMIZED:
      case SDL_WINDOWEVENT_SHOWN:
      case SDL_WINDOWEVENT_EXPOSED:
        minimised_ = false;
        break;
      default:
        break;
    }
  return true;
}

Status Desk::renew() {
  int wide = 1280, high = 720;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  // video stays while there is no window, and with it the events on their way
  const bool held = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
  ui_.reset();
  renderer_.reset();
  auto renderer = render::Renderer::window("burr", wide, high);
  if (held) SDL_QuitSubSystem(SDL_INIT_VIDEO);
  if (!renderer) return renderer.error();
  renderer_ = std::move(*renderer);
  ui_ = Ui::make();
  minimised_ = false;
  ++renewed_;
  return fine();
}

Status Desk::show(const render::Scene& scene, const std::function<void()>& panels, bool keys) {
  int wide = renderer_->width(), high = renderer_->height();
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  Status done = fine();
  if (minimised_) {
    SDL_Delay(50);
    if (after_frame) after_frame();
    return done;
  }
  if (panels) {
    ui_->begin(wide, high, renderer_->width(), renderer_->height(), settings.scale, keys);
    panels();
    done = renderer_->show(scene, [this] { ui_->draw(); });
  } else {
    ui_->forget_panels();
    done = renderer_->show(scene);
  }
  // a lost graphics card does not end the session; the next picture is drawn by what there is then
  if (!done) done = renew();
  if (after_frame) after_frame();
  return done;
}

Result<std::string> Desk::leave_picture(const std::string& into) {
  const render::Image image = renderer_->shown();
  std::filesystem::path path;
  std::string name;
  std::error_code nobody_asks;
  do {  // never over an older one
    name = fmt::format("burr_{:03d}.png", ++pictures_);
    path = std::filesystem::path(into) / name;
  } while (std::filesystem::exists(path, nobody_asks) && pictures_ < 100'000);
  const Status left = render::write_png(image, path);
  if (!left) return left.error();
  return name;
}

}  // namespace burr::app
