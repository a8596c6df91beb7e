// render/gl/skin_programs.h - the programs that draw bone and soft structures: with or without what
// milling left on the bone, the grain of materials, a clip plane.
//
// The grain needs a table of smooth noise, tileable, 64^3:
//     r   clouds, some 0.6 mm across        b   the same, finer
//     g   1 in the middle of a pore, 0 outside it; pores lie a few mm apart
//     a   as b, another
// Memory: 1 MiB. For use of this room only. Thread: main, with the context current.
#pragma once

#include "burr/render/gl/frame.h"
#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

struct SkinKind {
  bool stained = false, grain = false, clipped = false;
};

class SkinPrograms {
 public:
  Status start(bool es);
  // Takes a program into use, with everything set. colours: Skin::colours().
  void use(const SkinKind& kind, const Scene& scene, const Frame& frame, GLuint colours);

 private:
  Program programs_[2][2][2];  // [stained][grain][clipped]
  Texture noise_;
};

}  // namespace burr::render::gl
