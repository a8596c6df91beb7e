#include "burr/render/picture.h"

#include <fmt/format.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <string>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/render/renderer.h"

namespace burr::render {

namespace {

void append(void* to, void* bytes, int count) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes),
                                        static_cast<std::size_t>(count));
}

}  // namespace

std::string jpeg_of(const Image& image, int quality) {
  std::string out;
  stbi_write_jpg_to_func(append, &out, image.width, image.height, 3, image.rgb.data(), quality);
  return out;
}

Result<Image> render_image(const Scene& scene, int width, int height) {
  auto renderer = Renderer::offscreen();
  if (!renderer) return renderer.error();
  return (*renderer)->image(scene, width, height);
}

Result<std::string> png_of(const Image& image) {
  BURR_CHECK(image.rgb.size() ==
             static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
  std::string bytes;
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(),
                             image.width * 3) == 0)
    return error(Trouble::internal, "a picture could not be encoded as PNG; please report it");
  return bytes;
}

Status write_png(const Image& image, const std::filesystem::path& path) {
  const auto bytes = png_of(image);
  if (!bytes) return bytes.error();
  Result<base::NewFile> file = base::NewFile::create(path.string(), base::kForAll);
  if (!file) return file.error();
  file->write(*bytes);
  return file->put_in_place();
}

Status render_png(const Scene& scene, int width, int height, const std::filesystem::path& path) {
  Result<Image> image = render_image(scene, width, height);
  if (!image) return image.error();
  return write_png(*image, path);
}

Result<Film> Film::in(const std::filesystem::path& folder, int width, int height) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble)
    return error(
        Trouble::io,
        fmt::format("{}: the folder of the film cannot be created: {}; choose another folder",
                    folder.string(), trouble.message()));
  auto renderer = Renderer::offscreen();
  if (!renderer) return renderer.error();
  return Film(folder, width, height, std::move(*renderer));
}

Film::Film(std::filesystem::path folder, int width, int height, std::unique_ptr<Renderer> renderer)
    : folder_(std::move(folder)), width_(width), height_(height), renderer_(std::move(renderer)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

Status Film::frame(const Scene& scene) {
  Result<Image> image = renderer_->image(scene, width_, height_);
  if (!image) return image.error();
  Status written = write_png(*image, folder_ / fmt::format("frame_{:06d}.png", frames_ + 1));
  if (written) ++frames_;
  return written;
}

}  // namespace burr::render
