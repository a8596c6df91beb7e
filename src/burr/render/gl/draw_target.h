// render/gl/draw_target.h - the textures of one picture, and the framebuffers around them.
//
// The bone is drawn into textures of its own and kept: where only the tool moved, it is copied
// instead of drawn. Memory: about 38 B per sample, and 4 to 8 B per pixel of the sheets. For use of
// this room only.
// Thread: main, with the context current.
#pragma once

#include <initializer_list>

#include "burr/render/gl/objects.h"

namespace burr::render::gl {

// shape: a new texture of that size, without interpolation between texels. attach: a framebuffer of
// such textures; depth 0: without depth.
void shape(Texture& texture, GLint inside, int width, int height, GLenum format, GLenum type);
Status attach(Framebuffer& framebuffer, std::initializer_list<GLuint> colours, GLuint depth);

// All maps are width x height samples; the hollows' maps are the same or half of it.
struct Target {
  int width = 0, height = 0, stride = 0;
  int occlusion_width = 0, occlusion_height = 0;

  Texture bone_colour, bone_normal, bone_depth;  // the bone, alone
  Texture colour, normal, depth;                 // the bone with tool and marks in front of it
  Texture occlusion, soft;                       // ambient occlusion of the bone; raw and softened
  Texture lit;                                   // the picture in samples, before it is shrunk to
                                                 // pixels
  Framebuffer bone, geometry, occlusion_at, soft_at, lit_at;

  // True: everything is new and holds nothing yet.
  Result<bool> resize(int wide, int high, int occlusion_stride);
  // Replaces [x0, x1) x [y0, y1) of the picture by the bone alone.
  void copy_bone(int x0, int y0, int x1, int y1) const;
};

// The pixels of a picture.
struct PictureBuffer {
  int width = 0, height = 0;
  Texture colour;
  Framebuffer at;
  Status resize(int wide, int high);
};

}  // namespace burr::render::gl
