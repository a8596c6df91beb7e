#include "burr/render/gl/context.h"

#include <SDL2/SDL.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <string_view>

#include "burr/render/gl/x_errors.h"

namespace burr::render::gl {

namespace {

Error no_gl(const std::string& why) {
  return error(Trouble::io,
               fmt::format("OpenGL 3.3 or OpenGL ES 3.0 is not available ({}): install the "
                           "packages libgl1-mesa-dri and libegl1, or your graphics card's driver",
                           why));
}

// "DISPLAY is :0"
std::string display() {
  for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"})
    if (const char* value = SDL_getenv(name); value != nullptr && *value != '\0')
      return fmt::format("{} is {}", name, value);
  return "neither DISPLAY nor WAYLAND_DISPLAY is set";
}

Error no_display(const std::string& why) {
  return error(Trouble::io,
               fmt::format("no window can be opened ({}; {}): use the computer's own display, or "
                           "connect with ssh -X",
                           why, display()));
}

bool on_x_server() {
  const char* driver = SDL_GetCurrentVideoDriver();
  return driver != nullptr && std::string_view(driver) == "x11";
}

// SDL takes a driver that shows nothing if no other works. For a window that is an error, unless
// the user asked for it.
bool nothing_is_seen() {
  const char* driver = SDL_GetCurrentVideoDriver();
  if (driver == nullptr || SDL_getenv("SDL_VIDEODRIVER") != nullptr) return false;
  return std::string_view(driver) == "offscreen" || std::string_view(driver) == "dummy";
}

// SDL's video is started once, with a count of users: a hidden context may exist beside a window.
bool start_video(bool visible, std::string& why) {
  SDL_SetMainReady();
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C is handled by the program
  // otherwise SDL drops the first press after the window came to the front, however late it is
  SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
  if (SDL_WasInit(SDL_INIT_VIDEO) != 0 || visible) {
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) {
      why = SDL_GetError();
      return false;
    }
    if (!visible || !nothing_is_seen()) return true;
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    why = "nothing answers there";
    return false;
  }
  // no display is needed or requested; the user's own choice of driver is respected
  if (SDL_getenv("SDL_VIDEODRIVER") == nullptr) SDL_SetHint(SDL_HINT_VIDEODRIVER, "offscreen");
  const bool started = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
  if (!started) why = SDL_GetError();
  SDL_ResetHint(SDL_HINT_VIDEODRIVER);
  // an SDL without that driver: use a hidden window where there is a display
  return started || SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
}

}  // namespace

Result<std::unique_ptr<Context>> Context::offscreen(Api api) {
  std::unique_ptr<Context> context(new Context);
  const Status made = context->create("burr", 64, 64, false, api);
  if (!made) return made.error();
  return context;
}

Result<std::unique_ptr<Context>> Context::window(const std::string& title, int width, int height,
                                                 bool quad_buffer) {
  std::unique_ptr<Context> context(new Context);
  const Status made = context->create(title, width, height, true, Api::any, quad_buffer);
  if (!made) return made.error();
  return context;
}

Status Context::create(const std::string& title, int width, int height, bool visible, Api api,
                       bool quad_buffer) {
  std::string why;
  if (!start_video(visible, why)) return visible ? no_display(why) : no_gl(why);
  catch_x_errors();
  sdl_ = true;
  visible_ = visible;

  // by EGL: an X server without GLX, or one that is far away (ssh -X), may still show pictures
  const struct {
    bool es, quad_buffer, egl;
  } tries[] = {{false, true, false},
               {false, false, false},
               {true, false, false},
               {false, false, true},
               {true, false, true}};
  for (const auto& [es, quads, egl] : tries) {
    if ((es && api == Api::core) || (!es && api == Api::es) || (quads && !quad_buffer)) continue;
    if (egl && !on_x_server()) continue;
    SDL_SetHint(SDL_HINT_VIDEO_X11_FORCE_EGL, egl ? "1" : "0");
    if (egl && !es) {  // SDL does not let go of a GLX that it could not use
      SDL_QuitSubSystem(SDL_INIT_VIDEO);
      SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11");  // and no driver that shows nothing
      sdl_ = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
      SDL_ResetHint(SDL_HINT_VIDEODRIVER);
      if (!sdl_) break;
      catch_x_errors();
    }
    forget_x_error();
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, es ? 0 : 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK,
                        es ? SDL_GL_CONTEXT_PROFILE_ES : SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
    SDL_GL_SetAttribute(SDL_GL_STEREO, quads ? 1 : 0);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 0);  // we draw into framebuffers of our own
    const Uint32 flags =
        SDL_WINDOW_OPENGL |
        (visible ? Uint32{SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI | SDL_WINDOW_SHOWN}
                 : Uint32{SDL_WINDOW_HIDDEN});
    SDL_Window* made = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED,
                                        SDL_WINDOWPOS_CENTERED, width, height, flags);
    void* gl = made == nullptr ? nullptr : SDL_GL_CreateContext(made);
    const std::string refused = x_error(made);
    if (gl != nullptr && !refused.empty()) {
      SDL_GL_DeleteContext(gl);
      gl = nullptr;
    }
    if (gl == nullptr) {
      if (why.empty()) why = refused.empty() ? SDL_GetError() : refused;
      if (made != nullptr) SDL_DestroyWindow(made);
      continue;
    }
    window_ = made;
    gl_ = gl;
    es_ = es;
    // the driver may give something else than requested
    GLboolean given = GL_FALSE;
    if (quads) glGetBooleanv(GL_STEREO, &given);
    quad_buffer_ = given == GL_TRUE;
    break;
  }
  if (gl_ == nullptr) return no_gl(why);

  if (epoxy_gl_version() < (es_ ? 30 : 33))
    return no_gl(fmt::format("the driver offers only version {}.{}", epoxy_gl_version() / 10,
                             epoxy_gl_version() % 10));
  // show at the screen's rate; a driver that cannot wait for it is fine too
  if (visible) SDL_GL_SetSwapInterval(1);
  if (const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER))) gpu_ = name;
  return fine();
}

Context::~Context() {
  if (gl_ != nullptr) SDL_GL_DeleteContext(gl_);
  if (window_ != nullptr) SDL_DestroyWindow(static_cast<SDL_Window*>(window_));
  if (sdl_) SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

bool Context::software() const {
  for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "SWR"})
    if (gpu_.find(name) != std::string::npos) return true;
  return false;
}

void Context::make_current() { SDL_GL_MakeCurrent(static_cast<SDL_Window*>(window_), gl_); }
void Context::swap() { SDL_GL_SwapWindow(static_cast<SDL_Window*>(window_)); }
void Context::wait_for_screen(bool on) {
  make_current();
  if (visible_) SDL_GL_SetSwapInterval(on ? 1 : 0);
}
void Context::title(const std::string& text) {
  SDL_SetWindowTitle(static_cast<SDL_Window*>(window_), text.c_str());
}
void Context::size(int& width, int& height) const {
  SDL_GL_GetDrawableSize(static_cast<SDL_Window*>(window_), &width, &height);
}

}  // namespace burr::render::gl
