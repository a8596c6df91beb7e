// render/quality.h - how much of a picture may be left out for speed, and made good later. Plain
// data; what a Governor decides from (governor.h). An image() is never less than whole.
#pragma once

namespace burr::render {

struct Quality {
  // of a picture drawn whole, as while the eye moves
  bool hollows = true;   // false: no ambient occlusion
  double coarse_px = 0;  // how far a coarser surface may be off, in pixels of the window; 0: none

  // where bone changes before an eye that rests
  bool hollows_later = false;  // leaves the old ones there
  double coarse_still_px = 0;

  // how seldom what milling leaves on bone is drawn anew (wound.h)  [s]
  double dress_s = 0.1;

  // makes good, piece by piece, what was left out before
  bool refine = true;

  double scale = 1;  // samples over pixels, along a side; at most 1
};

}  // namespace burr::render
