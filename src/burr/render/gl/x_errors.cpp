#include "burr/render/gl/x_errors.h"

#include <SDL2/SDL.h>
#include <SDL2/SDL_syswm.h>
#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

namespace burr::render::gl {
namespace {

#ifdef SDL_VIDEO_DRIVER_X11

constexpr int kLostDisplay = static_cast<int>(Trouble::io);
std::atomic<int> refused = 0;  // the first error since forget_x_error(); 0: none

// A function of libX11, which SDL has loaded if it draws on an X server.
template <class Function>
Function* of_xlib(const char* name) {
  void* const library = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  if (library == nullptr) return nullptr;
  void* const found = dlsym(library, name);
  dlclose(library);  // only lowers its use count
  return reinterpret_cast<Function*>(found);
}

int on_error(Display* /*display*/, XErrorEvent* event) {
  int none = 0;
  refused.compare_exchange_strong(none, event->error_code);
  return 0;
}

int on_lost_display(Display* /*display*/) {
  std::fputs(
      "burr: the connection to the display has ended, and the session with it; a recording holds "
      "everything up to this moment\n",
      stderr);
  // returning ends the program too, but with exit code 1
  _exit(kLostDisplay);
}

#endif

}  // namespace

#ifdef SDL_VIDEO_DRIVER_X11

void catch_x_errors() {
  if (auto* const set = of_xlib<decltype(XSetErrorHandler)>("XSetErrorHandler")) set(on_error);
  if (auto* const set = of_xlib<decltype(XSetIOErrorHandler)>("XSetIOErrorHandler"))
    set(on_lost_display);
}

void forget_x_error() { refused = 0; }

std::string x_error(SDL_Window* window) {
  SDL_SysWMinfo info = {};
  SDL_VERSION(&info.version);
  if (window == nullptr || SDL_GetWindowWMInfo(window, &info) == SDL_FALSE ||
      info.subsystem != SDL_SYSWM_X11)
    return {};
  Display* const display = info.info.x11.display;
  if (auto* const wait = of_xlib<decltype(XSync)>("XSync")) wait(display, False);
  const int code = refused;
  if (code == 0) return {};
  char text[128] = "an error without a name";
  if (auto* const name = of_xlib<decltype(XGetErrorText)>("XGetErrorText"))
    name(display, code, text, sizeof text);
  return std::string("the display refused it: ") + text;
}

#else

void catch_x_errors() {}
void forget_x_error() {}
std::string x_error(SDL_Window* /*window*/) { return {}; }

#endif

}  // namespace burr::render::gl
