// render/gl/lighting.h - what is there becomes a picture: lights, hollows, the tool's shadow, and
// the sky where there is nothing.
//
// A header of this room only.
#pragma once

#include <vector>

#include "burr/render/gl/frame.h"
#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

// What is lit, as the mesh shaders left it, and where the picture goes.
struct Unlit {
  const Texture* colour = nullptr;
  const Texture* normal = nullptr;
  const Texture* depth = nullptr;
  const Framebuffer* lit_at = nullptr;
};
// Hollows found for it; stride 1, or 2 for half resolution.
struct Hollows {
  const Texture* map = nullptr;  // nullptr: none
  int width = 0, height = 0, stride = 1;
};

class Lighting {
 public:
  Status start(bool es);
  // What may be in a rectangle besides bone: the tool's shadow; tool and marks themselves.
  struct Besides {
    bool shadow = false, others = false;
  };
  // The array of a screen's triangle is bound.
  void paint(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& what,
             const Hollows& hollows, const Besides& besides);
  void paint_sky(const Scene& scene, const Frame& frame, const Rect& r, const Framebuffer& lit_at);

 private:
  Program plain_, sky_;
  Program lights_[3][2][2];  // [hollows: none, full, half resolution][shadow][others]
};

// Points around everything the tool's shadow may touch; none without a tool.
[[nodiscard]] std::vector<math::Vec3> shadow_of(const Scene& scene);

// How far hollows see [m], and 1 / (depth difference that is another surface).
[[nodiscard]] double hollow_reach(const Scene& scene);
[[nodiscard]] float strict_of(const Scene& scene, const Frame& frame);

void bind(GLuint unit, const Texture& texture);
void scissor(const Rect& r);

}  // namespace burr::render::gl
