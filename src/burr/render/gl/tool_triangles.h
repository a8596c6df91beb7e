// render/gl/tool_triangles.h - tool and marks as triangles: fluted and grainy ball, turned shaft,
// handpiece, ball, rod, arrow head. For use of this room only.
//
// Thread: main, with the context current. Units: m; frame: world.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

// One mesh on the GPU, in shades of grey; it gets its colour when it is drawn.
class Shape {
 public:
  // points, normals: (n); triangles: (m x 3), counter-clockwise from outside; shades: of the colour
  // at each point, 0..1; empty: 1 everywhere
  void send(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
            const std::vector<std::uint16_t>& triangles, const std::vector<float>& shades = {});
  void draw() const;

 private:
  Buffer vertices_, indices_;
  VertexArray array_;
  GLsizei count_ = 0;
};

// Something to draw besides bone: a shape, scaled and placed.
struct Piece {
  const Shape* shape = nullptr;
  Eigen::Matrix4d world_from_shape = Eigen::Matrix4d::Identity();
  Colour colour = {1, 1, 1};
  bool steel = false;  // part of the tool, with light and shadow; else a mark
  bool bone = false;   // looks like bone
  bool on_top = false;
  bool gives_shadow = false;  // drawn into the map of gl/tool_shadow.h
  // the space it fills: corners of oriented boxes in the world; several where one would be mostly
  // empty
  std::vector<std::array<math::Vec3, 8>> boxes;
};

class Shapes {
 public:
  // All pieces of the scene; valid until the next call.
  const std::vector<Piece>& pieces(const Scene& scene);

 private:
  void make();
  void make_shaft(const Burr& burr);
  void add(const Shape& shape, const Eigen::Matrix4d& world_from_shape, const Colour& colour,
           bool steel, bool on_top, const std::vector<math::Aabb>& boxes_shape);

  void add_tool(const Burr& burr);
  // A tool that is no round burr, and what of it the graphics card has.
  struct Sent {
    Shape cuts, rubs;
    std::shared_ptr<const ToolLook> look;
    std::vector<math::Aabb> cuts_boxes, rubs_boxes;
  };
  void add_other(Sent& sent, const math::Pose& at, const std::shared_ptr<const ToolLook>& look);
  void add_chips(const std::shared_ptr<const surface::Mesh>& chips);
  void add_rod(const Rod& rod);
  void add_mirrored(const Mirrored& mirrored, const Burr& burr);

  Shape ball_, head_, grains_, rod_, tip_, shaft_;
  Shape collet_, nose_, grip_, tail_;  // of the handpiece
  Sent held_, beside_;                 // in the first hand, in the other
  Shape chips_;
  std::shared_ptr<const surface::Mesh> sent_chips_;
  std::vector<math::Aabb> chips_boxes_;
  bool made_ = false;
  double shaft_of_[2] = {0, 0};  // radius and shaft_radius of the present shaft
  std::vector<Piece> pieces_;
};

}  // namespace burr::render::gl
