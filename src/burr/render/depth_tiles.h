// render/depth_tiles.h - a coarse map of the depth of a half-drawn picture; it shows which boxes
// cannot be seen in it.
//
//     DepthTiles tiles;
//     tiles.look(depth, {x0, y0, width, height});        // what was drawn so far
//     if (tiles.hide(box, clip_from_world, 1280, 720)) continue;
//
// Of each 8 x 8 samples the farthest depth is kept (Greene et al. 1993, one level of the pyramid).
// A box is hidden if all of it lies behind the farthest depth of every tile that it may touch. The
// test is conservative: a box that may be visible is never called hidden. Depth: 0 near .. 1 far,
// as from glReadPixels. Thread: one at a time.
#pragma once

#include <vector>

#include "burr/math/aabb.h"

namespace burr::render {

class DepthTiles {
 public:
  // Samples [x0, x0 + width) x [y0, y0 + height) of the window, y up.
  struct Part {
    int x0 = 0, y0 = 0, width = 0, height = 0;
  };
  // depth: row by row, from the part's lower left.
  void look(const float* depth, const Part& part);

  // True: nothing of the box (world) can be seen in that part of a window of this size. Only the
  // part counts: a box beside it is hidden.
  [[nodiscard]] bool hide(const math::Aabb& box, const Eigen::Matrix4d& clip_from_world,
                          int window_width, int window_height) const;

 private:
  Part part_;
  int across_ = 0, up_ = 0;  // number of tiles
  std::vector<float> farthest_;
};

}  // namespace burr::render
