// render/gl/lighting.h - lights the picture: lamps, ambient occlusion, the tool's shadow, and the
// background.
//
// For use of this room only.
// Thread: main, with the context current.
#pragma once

#include <vector>

#include "burr/render/gl/frame.h"
#include "burr/render/gl/objects.h"
#include "burr/render/gl/tool_shadow.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

// The maps to be lit, as the mesh shaders wrote them, and the destination of the picture.
struct Unlit {
  const Texture* colour = nullptr;
  const Texture* normal = nullptr;
  const Texture* depth = nullptr;
  const Framebuffer* lit_at = nullptr;
};
// Its ambient occlusion; stride 1, or 2 for half resolution.
struct OcclusionMaps {
  const Texture* map = nullptr;  // nullptr: none
  int width = 0, height = 0, stride = 1;
};

class Lighting {
 public:
  Status start(bool es);
  // The shadow of a tool that is no round burr; drawn before paint().
  ToolShadow tool_shadow;
  // What a rectangle may contain besides bone: the tool's shadow; tool and marks.
  struct Besides {
    bool shadow = false, others = false;
  };
  // The vertex array of the screen triangle must be bound.
  void paint(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& what,
             const OcclusionMaps& ambient_occlusion, const Besides& besides);
  void paint_sky(const Scene& scene, const Frame& frame, const Rect& r, const Framebuffer& lit_at);

 private:
  Program plain_, sky_;
  // [hollows: none, full, half resolution][shadow: none, of a round burr, by a map][others]
  Program lights_[3][3][2];
};

// Points around everything that the tool's shadow may touch; empty without a tool.
[[nodiscard]] std::vector<math::Vec3> shadow_of(const Scene& scene);

// Reach of the ambient occlusion [m], and 1 / (depth difference that counts as another surface).
[[nodiscard]] double occlusion_reach(const Scene& scene);
[[nodiscard]] float strict_of(const Scene& scene, const Frame& frame);

void bind(GLuint unit, const Texture& texture);
void scissor(const Rect& r);

}  // namespace burr::render::gl
