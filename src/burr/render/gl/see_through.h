// render/gl/see_through.h - bone that lets what is in it and behind it be seen: nerves, vessels,
// dura, the tool.
//
// One layer of bone over what is nearest of those, each lit by itself, blended where bone is in
// front. That needs no order of triangles and no sieve of pixels, costs one more picture of few
// triangles, and gives every depth right but bone behind bone, which is left out: what lies deeper
// is not made darker by it. Nothing hides from it because bone hides it.
//
// Memory: 16 B per sample, from the first such picture on.
// A header of this room only.
#pragma once

#include <functional>

#include "burr/render/gl/lighting.h"
#include "burr/render/gl/skin.h"

namespace burr::render::gl {

class SeeThrough {
 public:
  Status start(bool es);
  Status resize(int wide, int high);

  // What is behind the bone. tool: draws it into the bound framebuffer.
  Skin::Drawn paint(const Scene& scene, const Frame& frame, const Rect& r, Skin& skin,
                    const std::function<void()>& tool);
  // ... lit, over the bone in `front`, which is lit already. The array of a screen's triangle is
  // bound.
  void blend(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& front,
             Lighting& lighting);

 private:
  Program walls_, clipped_walls_, through_;
  int width_ = 0, height_ = 0;
  Texture colour_, normal_, depth_, lit_;
  Framebuffer geometry_, lit_at_;
};

}  // namespace burr::render::gl
