#include "window/replay/split_view.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace burr::app {

Status SplitView::draw(const std::array<const render::Scene*, 2>& scenes, int width, int height) {
  both_.insets.resize(2);
  const int middle = width / 2;
  for (std::size_t n = 0; n < 2; ++n) {
    render::Inset& inset = both_.insets[n];
    inset.x = n == 0 ? 0 : middle;
    inset.width = std::max(1, n == 0 ? middle : width - middle);
    inset.height = std::max(1, height);
    const Status done = half(halves_[n], *scenes[n], inset);
    if (!done) {  // a lost graphics card: the next picture makes a new renderer
      halves_[n].renderer.reset();
      return done;
    }
  }
  return fine();
}

Status SplitView::half(Half& half, const render::Scene& scene, render::Inset& inset) const {
  using Clock = std::chrono::steady_clock;
  if (!half.renderer) {
    auto made = render::Renderer::offscreen();
    if (!made) return made.error();
    half.renderer = std::move(*made);
    inset.image.reset();
  }
  const Clock::time_point start = Clock::now();
  half.renderer->resize_offscreen(inset.width, inset.height);
  const Status shown = half.renderer->show(scene);
  if (!shown) return shown;
  half.redrawn = half.renderer->figures().redrawn;
  const bool other_size = inset.image == nullptr || inset.image->width != inset.width ||
                          inset.image->height != inset.height;
  // slices over the scene change without it
  std::vector<render::Inset> slices = scene.insets;
  const bool same_slices =
      std::equal(slices.begin(), slices.end(), half.slices.begin(), half.slices.end(),
                 [](const render::Inset& a, const render::Inset& b) {
                   return a.image == b.image && a.x == b.x;
                 });
  half.slices = std::move(slices);
  if (half.redrawn > 0 || other_size || !same_slices)
    inset.image = std::make_shared<render::Image>(half.renderer->shown());
  half.took_s = std::chrono::duration<double>(Clock::now() - start).count();
  return fine();
}

}  // namespace burr::app
