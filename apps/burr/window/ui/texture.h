// apps/burr/window/ui/texture.h - a picture on the graphics card, for a page. Thread: main, with
// the window's context.
#pragma once

#include <cstdint>
#include <span>

namespace burr::app {

class Texture {
 public:
  Texture() = default;
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&&) = delete;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  // Rows from the top, 3 (RGB) or 4 (RGBA) bytes per pixel.
  void put(int width, int height, int bytes, std::span<const std::uint8_t> pixels);
  // The texture was destroyed with its context; nothing is deleted.
  void forget() { name_ = 0; }
  // OpenGL's name; 0: there is no texture yet.
  [[nodiscard]] unsigned name() const { return name_; }

 private:
  unsigned name_ = 0;
};

}  // namespace burr::app
