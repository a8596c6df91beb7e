// apps/burr/window/replay/split_view.h - two scenes in one window, left and right. Each is drawn without a
// window, half as wide, and its picture laid into the window's; a half in which nothing moved costs
// nothing.
//
// Thread: main. Errors: as render/renderer.h.
#pragma once

#include <array>
#include <memory>

#include "burr/base/result.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"

namespace burr::app {

class SplitView {
 public:
  // Into both(), for a window of that size [pixel]. The window's context is to be made current
  // again.
  Status draw(const std::array<const render::Scene*, 2>& scenes, int width, int height);
  [[nodiscard]] const render::Scene& both() const { return both_; }
  // Of the last draw: how long a half took, and how much of it was drawn anew (0..1).
  [[nodiscard]] double took_s(std::size_t side) const { return halves_[side].took_s; }
  [[nodiscard]] double redrawn(std::size_t side) const { return halves_[side].redrawn; }

 private:
  struct Half {
    std::unique_ptr<render::Renderer> renderer;
    double took_s = 0, redrawn = 0;
  };
  Status half(Half& half, const render::Scene& scene, render::Inset& inset) const;

  std::array<Half, 2> halves_;
  render::Scene both_;
};

}  // namespace burr::app
