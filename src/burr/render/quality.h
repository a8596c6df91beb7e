// render/quality.h - what of a picture may be left out for speed and drawn later. Plain data, set
// by the governor (governor.h). An image() is always complete.
#pragma once

namespace burr::render {

struct Quality {
  // for a picture that is drawn whole, as while the eye moves
  bool ambient_occlusion = true;  // false: with few samples
  double coarse_px = 0;  // largest error of a coarser surface, in pixels of the window; 0: full
                         // detail

  bool grain = true;  // the fine grain of materials; false: their mean colours

  // where the bone changes in front of an eye at rest
  bool ambient_occlusion_later = false;  // keep the old ones there for now
  double coarse_still_px = 0;
  bool grain_still = true;

  // time between two updates of dust, water and blood on the bone (wound.h) [s]
  double stain_s = 0.1;

  // draw, piece by piece, what was left out before
  bool refine = true;

  double scale = 1;  // samples / pixels along a side; at most 1
};

}  // namespace burr::render
