// render/picture.h - writes scenes as PNG files: one picture of any size, or a film of many.
//
//     Status status = render_png(scene, 1280, 720, "bone.png");
//     Film film = ...;  film.frame(scene);          // dir/frame_000001.png, 000002 ...
//
// Needs no display. A file is written under another name beside its final place and then renamed.
// It holds the pixels and nothing else: no time, no name, no path. Errors: Trouble::io when no
// picture can be drawn (no OpenGL; the message says which packages help) or written, Trouble::usage
// for an impossible size.
// Thread: main only (SDL). Cost: see bench/render.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/render/image.h"
#include "burr/render/scene.h"

namespace burr::render {

class Renderer;

// Any size up to 65536 a side: a picture larger than the GPU can hold at once is drawn in tiles.
[[nodiscard]] Result<Image> render_image(const Scene& scene, int width, int height);

// The bytes of a PNG file.
[[nodiscard]] Result<std::string> png_of(const Image& image);

[[nodiscard]] Status write_png(const Image& image, const std::filesystem::path& path);

[[nodiscard]] Status render_png(const Scene& scene, int width, int height,
                                const std::filesystem::path& path);

// The bytes of a JPEG; quality: 1..100. Thread: any.
[[nodiscard]] std::string jpeg_of(const Image& image, int quality);

// A film as a sequence of numbered pictures, for ffmpeg -i frame_%06d.png. The bone stays on the
// GPU between frames, so that only changes are sent.
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
