// render/renderer.h - draws scenes: into a picture without a display, or into a window.
//
// Keeps what it drew: a patch of bone is sent to the GPU again only when its version changed, and a
// window is drawn again only where something moved, so that milling before a resting eye is cheap
// even without a GPU. OpenGL 3.3 core, or OpenGL ES 3.0 where there is nothing better; both look
// the same. Thread: main only; one thread for all renderers (SDL). Errors: Trouble::io with what to
// install or what to make smaller. Cost: see bench/render.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/render/picture.h"
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
  // Without a display, or beside one.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> offscreen(Api api = Api::any);
  // With a window of that size, which the user may resize. Its events come through SDL.
  // quad_buffer: with a picture for each eye if the driver has such; see quad_buffer().
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> window(const std::string& title, int width,
                                                                int height,
                                                                bool quad_buffer = false);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // A picture of any size up to 65536 a side. tile: largest piece drawn at once, in pixels of the
  // picture; 0: what the GPU can hold.
  [[nodiscard]] Result<Image> image(const Scene& scene, int width, int height, int tile = 0);

  // Draws into the window (at most as often as the screen shows) and shows it. Without a window:
  // draws all the same, for benchmarks. over: draws on top before it is shown, with OpenGL of its
  // own into the framebuffer then bound, which has the window's size; leaves bindings as found.
  Status show(const Scene& scene, const std::function<void()>& over = {});
  // The same for two eyes on both sides of the scene's camera, each with all that lies over it, so
  // that `over` draws twice. A quad_buffer that is not there is shown as off.
  Status show(const Scene& scene, const TwoEyes& eyes, const std::function<void()>& over = {});
  void title(const std::string& text);
  // For whoever draws with OpenGL of its own.
  void make_current();

  // Leave out patches of bone that others hide (on by default; only a software renderer does). The
  // picture is the same either way.
  void skip_hidden(bool on);

  // of the window's drawing area; 1280 x 720 without a window  [pixel]
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  void resize_offscreen(int width, int height);

  // Into a texture of OpenGL's of that size, whose picture begins at the bottom: for a headset's
  // left (0) and right (1) eye. Each has a held picture of its own, beside the window's.
  Status eye(const Scene& scene, int which, unsigned texture, int width, int height);
  // Whether show() waits for the screen, as it does at first; a headset has a pace of its own.
  void wait_for_screen(bool on);

  // The window has a picture for each eye.
  [[nodiscard]] bool quad_buffer() const;

  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  [[nodiscard]] std::string gpu() const;
  [[nodiscard]] bool software() const;  // the processor draws
  [[nodiscard]] bool es() const;        // OpenGL ES, see Api
  // Nothing is left to be made good of what scene.quality left out: the next picture of the same
  // scene is this one.
  [[nodiscard]] bool refined() const;

  // What the last show() or image() did.
  struct Figures {
    int patches_uploaded = 0;
    int patches_drawn = 0;
    long triangles_drawn = 0;
    double redrawn = 0;  // part of the picture drawn anew, 0..1
  };
  [[nodiscard]] Figures figures() const;

  // The picture of the last show() with all that was drawn over it, for tests and for pictures of a
  // session.
  [[nodiscard]] Image shown();

 private:
  struct Work;
  explicit Renderer(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace burr::render
