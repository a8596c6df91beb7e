// apps/burr/window/start/thumbnails.h - small pictures of the built-in cases for the start page.
//
// Made once from the formula, coarsely, and kept in the cache; the bone is made on a thread of its
// own, the picture drawn on main between two frames. A damaged picture in the cache is made anew.
// Thread: main.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/render/renderer.h"
#include "window/shell/loading.h"
#include "window/shell/texture.h"

namespace burr::app {

class Thumbnails {
 public:
  static constexpr int kWidth = 472, kHeight = 270;  // [pixel]

  // cache: empty, nothing is kept
  Thumbnails(std::filesystem::path cache, std::vector<std::string> cases);

  // Goes on a little with what is missing; each frame.
  void step(render::Renderer& renderer);
  // What was on the GPU is gone: everything from the start.
  void forget();
  // OpenGL's name of the texture; 0: not there yet.
  [[nodiscard]] unsigned texture(std::size_t which) const { return textures_[which].name(); }
  [[nodiscard]] bool finished() const { return next_ >= cases_.size(); }

 private:
  [[nodiscard]] std::filesystem::path file(std::size_t which) const;
  void put(std::size_t which, const render::Image& image);

  std::filesystem::path cache_;
  std::vector<std::string> cases_;
  std::vector<Texture> textures_;
  std::size_t next_ = 0;
  std::unique_ptr<Loading<render::Scene>> loading_;
};

}  // namespace burr::app
