// render/gl/skin.h - the bone's surface on the GPU: one vertex and index buffer per patch.
//
// Memory: 16 B a vertex, 2 B an index, as they are in the scene. A patch is sent when its version
// changes and skipped when it is out of sight or wholly turned away. A header of this room only.
#pragma once

#include <array>
#include <vector>

#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

class Skin {
 public:
  // Sends what changed since the last call; appends the boxes, before and after, of those patches.
  // Returns how many were sent.
  int update(const Scene& scene, std::vector<math::Aabb>& changed);
  // One row of 256 colours, by tissue.
  [[nodiscard]] GLuint colours() const { return colour_row_.get(); }

  struct Drawn {
    int patches = 0;
    long triangles = 0;
  };
  // Draws with the program in use what may be seen from `eye` inside the planes (nx, ny, nz, d:
  // n . p + d >= 0 inside).
  Drawn draw(const math::Vec3& eye, const std::array<Eigen::Vector4d, 6>& planes) const;

 private:
  struct Part {
    Buffer vertices, indices;
    VertexArray array;
    GLsizei count = 0;
    GLenum type = GL_UNSIGNED_SHORT;
    std::uint64_t version = 0;
    math::Aabb box;
    math::Vec3 facing = math::Vec3::Zero();  // middle of the cone of the triangles' normals
    double spread = 0;                       // its half angle; pi: every way         [rad]
  };
  void send(Part& part, const ScenePatch& patch);
  void send_colours();

  std::vector<Part> parts_;
  std::vector<Colour> colours_;
  Texture colour_row_;
};

}  // namespace burr::render::gl
