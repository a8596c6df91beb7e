// apps/burr/window/start/thumbnails.h - small pictures of the built-in cases for the start page.
//
// Each is made once from the formula with large voxels, and kept in the cache. The bone is made on
// a thread of its own; the picture is drawn on the main thread between two frames. A damaged
// picture in the cache is made again.
// Thread: main.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/render/renderer.h"
#include "window/ui/loading.h"
#include "window/ui/texture.h"

namespace burr::app {

class Thumbnails {
 public:
  static constexpr int kWidth = 472, kHeight = 270;  // [pixel]

  // cache: empty: nothing is kept
  Thumbnails(std::filesystem::path cache, std::vector<std::string> cases);

  // Makes a little more of what is missing; call it in each frame.
  void step(render::Renderer& renderer);
  // Call it after the GPU was lost: all textures are made again.
  void forget();
  // OpenGL's name of the texture; 0: not made yet.
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
