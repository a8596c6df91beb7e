#include "window/ui/desk.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "burr/render/picture.h"
#include "shared/front_words.h"
#include "shared/word_names.h"

namespace burr::app {

Result<std::unique_ptr<Desk>> Desk::open(const DeskPlaces& places) {
  std::unique_ptr<Desk> desk(new Desk);
  desk->places_ = places;
  if (!places.config.empty()) {
    SettingsRead read = read_settings(places.config / "settings.toml");
    desk->settings = read.settings;
    desk->keep_old_ = !read.troubles.empty();
    desk->troubles = std::move(read.troubles);
  }
  speak(language_of(desk->settings));
  desk->headset_wanted = desk->settings.headset;
  desk->asked_quads_ = desk->settings.stereo == render::Stereo::quad_buffer;
  auto renderer = render::Renderer::window("burr", 1280, 720, desk->asked_quads_);
  if (!renderer)
    return error(renderer.error().trouble,
                 renderer.error().text +
                     "; without a window, use burr run --headless, burr mill or burr picture");
  desk->renderer_ = std::move(*renderer);
  if (desk->asked_quads_ && !desk->renderer_->quad_buffer())
    desk->troubles.emplace_back(word(Word::stereo_no_quads));
  desk->ui_ = Ui::make();
  return desk;
}

void Desk::settings_changed() {
  speak(language_of(settings));
  if (places_.config.empty()) return;
  const Status kept = write_settings(settings, places_.config / "settings.toml", keep_old_);
  if (kept)
    keep_old_ = false;
  else
    troubles = {in_options(kept.error()).text};
}

bool Desk::next(SDL_Event& event) {
  do {
    if (!pointer_.next(event)) return false;
    const bool stereo_key =
        event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_F3 && !ui_->typing();
    if (!stereo_key) break;
    next_stereo();
  } while (true);
  if (halves()) into_half(event);
  if (is_plug_event(event)) {
    pads.scan();
    pedals.scan();
  }
  if (page != Page::milling) as_key(event);
  ui_->event(event);
  printed_.translate(event);
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

void Desk::next_stereo() {
  using render::Stereo;
  auto next = static_cast<Stereo>((static_cast<int>(settings.stereo) + 1) %
                                  (static_cast<int>(Stereo::quad_buffer) + 1));
  if (next == Stereo::quad_buffer && !renderer_->quad_buffer()) next = Stereo::off;
  settings.stereo = next;
  settings_changed();
  constexpr Word kNames[] = {Word::stereo_off, Word::stereo_side_by_side, Word::stereo_anaglyph,
                             Word::stereo_interleaved, Word::stereo_quad_buffer};
  troubles.push_back(say(Word::stereo_now, word(kNames[static_cast<std::size_t>(next)])));
}

namespace {

int window_width() {
  int wide = 0, high = 0;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  return std::max(2, wide);
}

// x in the whole picture, for an x in one that is squeezed into half of the window
int stretched(int x, bool right_half) {
  const int wide = window_width();
  return std::clamp(2 * (x - (right_half ? wide / 2 : 0)), 0, wide - 1);
}

}  // namespace

// While a button is down, the mouse stays in the half in which it was pressed.
void Desk::into_half(SDL_Event& event) {
  if (event.type == SDL_MOUSEMOTION) {
    if (event.motion.state == 0) in_right_half_ = event.motion.x >= window_width() / 2;
    event.motion.x = stretched(event.motion.x, in_right_half_);
    event.motion.xrel *= 2;
  } else if (event.type == SDL_MOUSEBUTTONDOWN || event.type == SDL_MOUSEBUTTONUP) {
    event.button.x = stretched(event.button.x, in_right_half_);
  }
}

void Desk::mouse(int& x, int& y) const {
  SDL_GetMouseState(&x, &y);
  if (halves()) x = stretched(x, x >= window_width() / 2);
}

render::TwoEyes Desk::eyes(const render::Camera& camera) const {
  render::TwoEyes eyes;
  eyes.how = settings.stereo;
  eyes.eye_distance = settings.stereo_depth * render::kComfortable * camera.distance;
  eyes.swapped = settings.swap_eyes;
  SDL_Window* window = SDL_GL_GetCurrentWindow();
  if (eyes.how != render::Stereo::interleaved || window == nullptr) return eyes;
  // which row of the screen belongs to which eye does not change when the window moves
  int y = 0, wide = 0, high = 1;
  SDL_GetWindowPosition(window, nullptr, &y);
  SDL_GetWindowSize(window, &wide, &high);
  eyes.first_row = y * renderer_->height() / std::max(1, high);
  return eyes;
}

Status Desk::renew() {
  int wide = 1280, high = 720;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  // keeps SDL's video part, and with it the waiting events, while there is no window
  const bool held = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
  ui_.reset();
  headset.reset();
  renderer_.reset();
  asked_quads_ = settings.stereo == render::Stereo::quad_buffer;
  auto renderer = render::Renderer::window("burr", wide, high, asked_quads_);
  if (held) SDL_QuitSubSystem(SDL_INIT_VIDEO);
  if (!renderer) return renderer.error();
  renderer_ = std::move(*renderer);
  if (asked_quads_ && !renderer_->quad_buffer()) troubles.emplace_back(word(Word::stereo_no_quads));
  ui_ = Ui::make();
  minimised_ = false;
  ++renewed_;
  return fine();
}

Status Desk::show(const render::Scene& scene, const std::function<void()>& panels, bool keys) {
  std::erase_if(under_way, [](const std::function<bool()>& ended) { return ended(); });
  // quad buffers can only be requested when a window is made
  if (settings.stereo == render::Stereo::quad_buffer && !asked_quads_)
    if (const Status anew = renew(); !anew) return anew;
  int wide = renderer_->width(), high = renderer_->height();
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  Status done = fine();
  if (minimised_) {
    SDL_Delay(50);
    if (after_frame) after_frame();
    return done;
  }
  ui_->own_pointer(halves());  // the desktop's pointer would be in one half only
  if (panels || halves()) {
    ui_->begin(wide, high, renderer_->width(), renderer_->height(), settings.scale, keys);
    if (panels) panels();
    done = renderer_->show(scene, eyes(scene.camera), [this] { ui_->draw(); });
  } else {
    ui_->forget_panels();
    done = renderer_->show(scene, eyes(scene.camera));
  }
  // a lost graphics card does not end the session: the next picture uses what is there then
  if (!done) done = renew();
  if (after_frame) after_frame();
  return done;
}

Result<std::string> Desk::leave_picture(const std::string& into) {
  const render::Image image = renderer_->shown();
  std::filesystem::path path;
  std::string name;
  std::error_code nobody_asks;
  do {  // never overwrite an older picture
    name = fmt::format("burr_{:03d}.png", ++pictures_);
    path = std::filesystem::path(into) / name;
  } while (std::filesystem::exists(path, nobody_asks) && pictures_ < 100'000);
  const Status left = render::write_png(image, path);
  if (!left) return left.error();
  return name;
}

}  // namespace burr::app
