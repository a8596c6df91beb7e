// render/picture.h - scenes as PNG files: one picture of any size, or a film of many.
//
//     Status status = render_png(scene, 1280, 720, "bone.png");
//     Film film = ...;  film.frame(scene);          // dir/frame_000001.png, 000002 ...
//
// Needs no display. Files are written beside and renamed; they hold the pixels and nothing else: no
// time, no name, no path. Errors: Trouble::io when no picture can be drawn (no OpenGL; the sentence
// says which packages help) or written, Trouble::usage for an impossible size.
// Thread: main only (SDL). Cost: see bench/render.
#pragma once

#include <filesystem>
#include <memory>

#include "burr/base/result.h"
#include "burr/render/image.h"
#include "burr/render/scene.h"

namespace burr::render {

class Renderer;

// Any size up to 65536 a side: what is larger than the GPU can hold at once is drawn in tiles.
[[nodiscard]] Result<Image> render_image(const Scene& scene, int width, int height);

[[nodiscard]] Status write_png(const Image& image, const std::filesystem::path& path);

[[nodiscard]] Status render_png(const Scene& scene, int width, int height,
                                const std::filesystem::path& path);

// A film as a sequence of numbered pictures, for ffmpeg -i frame_%06d.png. Keeps the bone on the
// GPU between frames, so that only what changed is sent again.
class Film {
 public:
  // Makes the folder. An older film in it is overwritten frame by frame.
  [[nodiscard]] static Result<Film> in(const std::filesystem::path& folder, int width, int height);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  Status frame(const Scene& scene);
  [[nodiscard]] int frames() const { return frames_; }  // written so far

 private:
  Film(std::filesystem::path folder, int width, int height, std::unique_ptr<Renderer> renderer);

  std::filesystem::path folder_;
  int width_ = 0, height_ = 0, frames_ = 0;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace burr::render
