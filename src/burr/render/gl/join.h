// render/gl/join.h - two eyes' pictures as one, on the GPU: what joined() in stereo.h does.
// A header of this room only.
#pragma once

#include "burr/render/gl/target.h"
#include "burr/render/stereo.h"

namespace burr::render::gl {

class Join {
 public:
  Status start(bool es);
  // All of the same size; the array of a screen's triangle is bound. first_row: of the screen, of
  // the picture's top one. how: one that is one picture.
  void draw(const Sheet& left, const Sheet& right, const Sheet& to, Stereo how, int first_row);

 private:
  Program program_;
};

}  // namespace burr::render::gl
