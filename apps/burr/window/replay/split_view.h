// apps/burr/window/replay/split_view.h - two scenes in one window, left and right. Each is drawn
// off-screen, half as wide, and copied into the window's picture. A half in which nothing moved
// costs nothing.
//
// Thread: main. Errors: as render/renderer.h.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"

namespace burr::app {

class SplitView {
 public:
  // Draws the scenes into both(), for a window of this size [pixel]. Afterwards the caller must
  // make the window's context current again.
  Status draw(const std::array<const render::Scene*, 2>& scenes, int width, int height);
  [[nodiscard]] const render::Scene& both() const { return both_; }
  // Of the last draw(): the time for a half, and the share of it that was drawn again (0..1).
  [[nodiscard]] double took_s(std::size_t side) const { return halves_[side].took_s; }
  [[nodiscard]] double redrawn(std::size_t side) const { return halves_[side].redrawn; }

 private:
  struct Half {
    std::unique_ptr<render::Renderer> renderer;
    double took_s = 0, redrawn = 0;
    std::vector<render::Inset> slices;  // of the last picture
  };
  Status half(Half& half, const render::Scene& scene, render::Inset& inset) const;

  std::array<Half, 2> halves_;
  render::Scene both_;
};

}  // namespace burr::app
