// render/renderer.h - draws scenes: into a picture without a display, or into a window.
//
// It keeps what it drew: a patch of bone is sent to the GPU again only when its version changed,
// and a window is redrawn only where something moved, so milling in front of an eye at rest is
// cheap even without a GPU. OpenGL 3.3 core, or OpenGL ES 3.0 where there is nothing better; both
// give the same picture. Thread: main only; one thread for all renderers (SDL). Errors:
// Trouble::io, with what to install or what to make smaller. Cost: see bench/render.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/render/image.h"
#include "burr/render/scene.h"
#include "burr/render/stereo.h"

namespace burr::render {

enum class Api {
  any,   // OpenGL 3.3 core, else OpenGL ES 3.0
  core,  // OpenGL 3.3 core or an error
  es,    // OpenGL ES 3.0 or an error
};

class Renderer {
 public:
  // For pictures without a display, or beside a window.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> offscreen(Api api = Api::any);
  // With a window of that size, which the user may resize. Its events come through SDL.
  // quad_buffer: ask for a picture for each eye, if the driver has that; see quad_buffer().
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> window(const std::string& title, int width,
                                                                int height,
                                                                bool quad_buffer = false);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // A picture of any size up to 65536 a side. tile: largest piece that is drawn at once, in pixels
  // of the picture; 0: as large as the GPU can hold.
  [[nodiscard]] Result<Image> image(const Scene& scene, int width, int height, int tile = 0);

  // Draws into the window (at most at the screen's rate) and shows it. Without a window it draws
  // all the same, for benchmarks. over: draws on top, with its own OpenGL calls, before the picture
  // is shown, into the framebuffer then bound, which has the window's size; it must leave the
  // bindings as found.
  Status show(const Scene& scene, const std::function<void()>& over = {});
  // The same for two eyes to either side of the scene's camera. Each gets the overlay, so `over` is
  // called twice. Stereo::quad_buffer without such a buffer is shown as off.
  Status show(const Scene& scene, const TwoEyes& eyes, const std::function<void()>& over = {});
  void title(const std::string& text);
  // For a caller that draws with its own OpenGL calls.
  void make_current();

  // Skip patches of bone that others hide (on by default; only a software renderer does it). The
  // picture is the same either way.
  void skip_hidden(bool on);

  // of the window's drawing area; 1280 x 720 without a window  [pixel]
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  void resize_offscreen(int width, int height);

  // Draws into an OpenGL texture of that size, first row at the bottom: for a headset's left (0)
  // and right (1) eye. Each keeps its own picture, separate from the window's.
  Status eye(const Scene& scene, int which, unsigned texture, int width, int height);
  // Whether show() waits for the screen; true at first. A headset has a rate of its own.
  void wait_for_screen(bool on);

  // True: the window has a picture for each eye.
  [[nodiscard]] bool quad_buffer() const;

  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  [[nodiscard]] std::string gpu() const;
  [[nodiscard]] bool software() const;  // the processor draws
  [[nodiscard]] bool es() const;        // OpenGL ES, see Api
  // True: nothing that scene.quality left out remains to be drawn; the next picture of the same
  // scene would be the same.
  [[nodiscard]] bool refined() const;

  // Figures of the last show() or image().
  struct Figures {
    int patches_uploaded = 0;
    int patches_drawn = 0;
    long triangles_drawn = 0;
    double redrawn = 0;  // share of the picture that was redrawn, 0..1
  };
  [[nodiscard]] Figures figures() const;

  // The picture of the last show() with everything drawn over it, for tests and for pictures of a
  // session.
  [[nodiscard]] Image shown();

 private:
  struct Work;
  explicit Renderer(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace burr::render
