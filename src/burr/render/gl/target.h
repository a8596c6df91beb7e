// render/gl/target.h - the textures one picture is made of, and the framebuffers around them.
//
// The bone is drawn by itself and kept: where only the tool moved, it is copied instead of drawn.
// Memory: about 38 B per sample, and 4 to 8 B per pixel of the sheets.
// A header of this room only.
#pragma once

#include <initializer_list>

#include "burr/render/gl/objects.h"

namespace burr::render::gl {

// A new texture of that size, each texel by itself; a framebuffer into such, depth 0: without.
void shape(Texture& texture, GLint inside, int width, int height, GLenum format, GLenum type);
Status attach(Framebuffer& framebuffer, std::initializer_list<GLuint> colours, GLuint depth);

// Size of all maps is width x height samples; of the hollows' the same or half of it.
struct Target {
  int width = 0, height = 0, stride = 0;
  int hollow_width = 0, hollow_height = 0;

  Texture bone_colour, bone_normal, bone_depth;  // the bone, alone
  Texture colour, normal, depth;                 // ... with tool and marks before it
  Texture hollow, soft;                          // how open the bone is; raw and softened
  Texture lit;                                   // the picture, at full samples
  Framebuffer bone, geometry, hollow_at, soft_at, lit_at;

  // True: everything was made anew and holds nothing yet.
  Result<bool> resize(int wide, int high, int hollow_stride);
  // The bone of [x0, x1) x [y0, y1) takes the place of what was there.
  void copy_bone(int x0, int y0, int x1, int y1) const;
  // As if there were none.
  void clear_hollows() const;
};

// A picture's pixels.
struct Sheet {
  int width = 0, height = 0;
  Texture colour;
  Framebuffer at;
  Status resize(int wide, int high);
};

}  // namespace burr::render::gl
