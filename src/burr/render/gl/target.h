// render/gl/target.h - the textures one picture is made of, and the framebuffers around them.
//
// Memory: about 22 B per sample.
// A header of this room only.
#pragma once

#include "burr/render/gl/objects.h"

namespace burr::render::gl {

// Size of all maps is width x height samples; of the hollows' the same or half of it.
struct Target {
  int width = 0, height = 0, stride = 0;
  int hollow_width = 0, hollow_height = 0;

  Texture colour, normal, depth;  // what is there
  Texture hollow, soft;           // how open it is; raw and softened
  Texture lit;                    // the picture, at full samples
  Framebuffer geometry, hollow_at, soft_at, lit_at;

  // True: everything was made anew and holds nothing yet.
  Result<bool> resize(int wide, int high, int hollow_stride);
};

// A picture's pixels.
struct Sheet {
  int width = 0, height = 0;
  Texture colour;
  Framebuffer at;
  Status resize(int wide, int high);
};

}  // namespace burr::render::gl
