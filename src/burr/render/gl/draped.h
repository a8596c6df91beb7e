// render/gl/draped.h - the drape around the work on the GPU. For use of this room only.
//
// Thread: main, with the context current.
#pragma once

#include <memory>

#include "burr/render/gl/frame.h"
#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

class Draped {
 public:
  // Draws it with `mesh`, the program of tool and marks, into the bound framebuffer, as a surface of
  // its own colours: moist, and the steel wet, so that it shines. Sends it first if it changed.
  void draw(const std::shared_ptr<const Drape>& drape, const Frame& frame, Program& mesh);

 private:
  void send(const Drape& drape);

  std::shared_ptr<const Drape> sent_;
  Buffer vertices_, indices_;
  VertexArray array_;
};

}  // namespace burr::render::gl
