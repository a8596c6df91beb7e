// render/gl/focus_pass.h - draws the lit samples once more as a lens would: each as the mean of the
// discs that cover it (render/focus.h). For use of this room only.
//
// The disc of what is behind something sharp does not spread over it; the disc of what is in front
// does. Thread: main, with the context current.
#pragma once

#include "burr/render/focus.h"
#include "burr/render/gl/draw_target.h"
#include "burr/render/gl/frame.h"

namespace burr::render::gl {

// Radius of the largest disc that is drawn, a fortieth of the picture's height [sample].
[[nodiscard]] int most_unsharp(const Frame& frame);

class FocusPass {
 public:
  Status start(bool es);
  // Draws all of `frame` from `from` into `to`, which gets its size. view_height: what the whole
  // picture shows in the plane in focus [m]. The vertex array of the screen triangle must be bound.
  Status draw(const Focus& focus, double view_height, const Frame& frame, const Target& from,
              PictureBuffer& to);

 private:
  Program program_;
};

}  // namespace burr::render::gl
