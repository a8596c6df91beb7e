// render/gl/tool_shadow.h - the shadow of a tool that is no round burr: a map of what it covers, as the
// key light sees it.
//
// The shadow of a round burr needs no map (gl/shaders.h: passes()). For use of this room only.
// Thread: main, with the context current.
#pragma once

#include <vector>

#include "burr/render/gl/frame.h"
#include "burr/render/gl/objects.h"
#include "burr/render/gl/tool_triangles.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

// The part of a tool that gives shadow. Frame: of the tool [m]
[[nodiscard]] math::Aabb shadow_box(const ToolLook& look);

class ToolShadow {
 public:
  Status start(bool es);
  // Draws the map, if the tool in the hand is no round burr. Changes framebuffer, viewport and program; depth test and scissor are
  // off afterwards.
  Status draw(const Scene& scene, const Frame& frame, const std::vector<Piece>& pieces);
  // Gives the map to a program in use; nothing where the last draw() drew none.
  void set(Program& light, int unit) const;
  [[nodiscard]] bool drawn() const { return drawn_; }

 private:
  Program covers_;
  Texture map_, depth_;
  Framebuffer at_;
  Eigen::Matrix4f map_from_view_ =
      Eigen::Matrix4f::Identity();                  // to 0..1 on each axis; z away from the light
  Eigen::Vector3f size_ = Eigen::Vector3f::Ones();  // of the map [m]
  bool drawn_ = false;
};

}  // namespace burr::render::gl
