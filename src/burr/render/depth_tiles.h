// render/depth_tiles.h - how deep a half-drawn picture is, coarsely, and so which boxes nothing of
// can show in it.
//
//     DepthTiles tiles;
//     tiles.look(depth, {x0, y0, width, height});        // what was drawn so far
//     if (tiles.hide(box, clip_from_world, 1280, 720)) continue;
//
// Of each 8 x 8 samples the farthest depth is kept (Greene et al. 1993, one level of the pyramid):
// a box all of which is behind the farthest depth of every tile it may touch is hidden. Never
// wrong the other way: what could show is never said to be hidden. Depth: 0 near .. 1 far, as
// glReadPixels gives it. Thread: one at a time.
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

  // Could nothing of the box, in the world, be seen in that part of a window of this size? What is
  // outside of the part is not asked for: a box beside it is hidden.
  [[nodiscard]] bool hide(const math::Aabb& box, const Eigen::Matrix4d& clip_from_world,
                          int window_width, int window_height) const;

 private:
  Part part_;
  int across_ = 0, up_ = 0;  // tiles
  std::vector<float> farthest_;
};

}  // namespace burr::render
