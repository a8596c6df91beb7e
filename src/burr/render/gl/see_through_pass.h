// render/gl/see_through_pass.h - transparent bone that shows what is in it and behind it: nerves,
// vessels, dura, the tool.
//
// One layer of bone is blended over the nearest of those; each is lit by itself. This needs no
// sorting of triangles and no discarding of pixels, and costs one more picture with few triangles.
// Soft structures have surfaces of their own (render/soft_scene.h). Every depth is right except bone
// behind bone, which is left out: it does not darken what lies deeper. Nothing is left out because bone hides it.
//
// Memory: 16 B per sample, allocated with the first transparent picture. For use of this room only.
// Thread: main, with the context current.
#pragma once

#include <functional>

#include "burr/render/gl/lighting.h"
#include "burr/render/gl/skin.h"
#include "burr/render/gl/skin_programs.h"

namespace burr::render::gl {

class SeeThrough {
 public:
  Status start(bool es);
  Status resize(int wide, int high);

  // Draws what is behind the bone. tool: draws the tool into the bound framebuffer.
  struct Of {
    Skin& skin;
    SkinPrograms& programs;
    bool grain = false;
  };
  Skin::Drawn paint(const Scene& scene, const Frame& frame, const Rect& r, const Of& of,
                    const std::function<void()>& tool);
  // Lights it and blends it over the bone in `front`, which is lit already. The vertex array of the
  // screen triangle must be bound.
  void blend(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& front,
             Lighting& lighting);

 private:
  Program through_;
  int width_ = 0, height_ = 0;
  Texture colour_, normal_, depth_, lit_;
  Framebuffer geometry_, lit_at_;
};

}  // namespace burr::render::gl
