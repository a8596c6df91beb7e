// render/gl/join.h - joins the pictures of two eyes on the GPU, as join_eyes() in stereo.h does.
// For use of this room only.
//
// Thread: main, with the context current.
#pragma once

#include "burr/render/gl/draw_target.h"
#include "burr/render/stereo.h"

namespace burr::render::gl {

class EyeJoiner {
 public:
  Status start(bool es);
  // All sheets have the same size; the vertex array of the screen triangle must be bound.
  // first_row: the row of the screen that holds the top row of the picture. how: a mode that makes
  // one picture of two.
  void draw(const PictureBuffer& left, const PictureBuffer& right, const PictureBuffer& to,
            Stereo how, int first_row);

 private:
  Program program_;
};

}  // namespace burr::render::gl
