// render/gl/overlay.h - draws text, a scale bar and inset pictures over the picture. For use of
// this room only.
//
// Thread: main, with the context current.
#pragma once

#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

class Overlay {
 public:
  Status make(bool es);
  // Draws into the bound framebuffer of wide x high pixels; it holds the part of a picture of width
  // x height that starts at (left, top).
  void draw(const Scene& scene, int width, int height, int left, int top, int wide, int high);

 private:
  void load(const std::vector<float>& xy);
  void quads(const std::vector<float>& xy, const Eigen::Vector4f& colour);
  void vignette(const Scene& scene, int width, int height, const Eigen::Vector4f& clip_from_pixel);
  void insets(const Scene& scene, const Eigen::Vector4f& clip_from_pixel, float size);

  // an inset's picture on the GPU
  struct Sent {
    std::shared_ptr<const Image> image;
    Texture texture;
  };
  Program flat_, inset_, vignette_;
  std::vector<Sent> sent_;
  Buffer vertices_;
  VertexArray array_;
};

// A round length of about a fifth of the picture's width: 1, 2, 5, 10, 20 ... [m]
[[nodiscard]] double bar_length(double picture_width);

}  // namespace burr::render::gl
