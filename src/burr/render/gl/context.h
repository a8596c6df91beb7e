// render/gl/context.h - an OpenGL context, with a window or without a display, by SDL.
//
// Without a display it uses SDL's `offscreen` driver (EGL); beside a window, a hidden window.
// Thread: main. Errors: Trouble::io, with the packages that contain OpenGL. For use of this room
// only.
#pragma once

#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/render/renderer.h"

namespace burr::render::gl {

class Context {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Context>> offscreen(Api api);
  [[nodiscard]] static Result<std::unique_ptr<Context>> window(const std::string& title, int width,
                                                               int height, bool quad_buffer);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void make_current();
  void swap();
  void wait_for_screen(bool on);
  void title(const std::string& text);
  void size(int& width, int& height) const;  // of the drawing area [pixel]

  [[nodiscard]] bool visible() const { return visible_; }
  [[nodiscard]] bool quad_buffer() const { return quad_buffer_; }
  [[nodiscard]] bool es() const { return es_; }
  [[nodiscard]] bool software() const;  // the processor draws, without a graphics card
  [[nodiscard]] const std::string& gpu() const { return gpu_; }

 private:
  Context() = default;
  Status create(const std::string& title, int width, int height, bool visible, Api api,
                bool quad_buffer = false);

  void* window_ = nullptr;  // SDL_Window
  void* gl_ = nullptr;      // SDL_GLContext
  bool visible_ = false, es_ = false, sdl_ = false, quad_buffer_ = false;
  std::string gpu_;
};

}  // namespace burr::render::gl
