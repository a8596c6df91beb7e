// render/gl/context.h - an OpenGL context, with a window or without a display. SDL underneath.
//
// Without a display SDL's `offscreen` driver is used (EGL); beside a window a hidden one. Thread:
// main. Errors: Trouble::io, saying which packages bring OpenGL.
// A header of this room only.
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
  void size(int& width, int& height) const;  // of the drawing area  [pixel]

  [[nodiscard]] bool visible() const { return visible_; }
  [[nodiscard]] bool quad_buffer() const { return quad_buffer_; }
  [[nodiscard]] bool es() const { return es_; }
  [[nodiscard]] bool software() const;  // drawn by the processor
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
