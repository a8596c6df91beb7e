// render/gl/skin.h - the bone's surface on the GPU: one vertex and index buffer per patch.
//
// Memory: 16 B a vertex, 2 B an index, as they are in the scene. A patch is sent when its version
// changes and skipped when it is out of sight or wholly turned away. A header of this room only.
#pragma once

#include <array>
#include <functional>
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
  // Whether nothing of a box can be seen behind what has been drawn since `look`.
  struct Hidden {
    std::function<void()> look;
    std::function<bool(const math::Aabb& box)> is;
  };
  // Draws with the program in use what may be seen from `eye` inside the planes (nx, ny, nz, d:
  // n . p + d >= 0 inside). With `hidden`: first what was seen the last time, then of the rest what
  // is not hidden behind it (two passes: Hill & Collin, GPU Pro 2, 2011). The picture is the same.
  Drawn draw(const math::Vec3& eye, const std::array<Eigen::Vector4d, 6>& planes,
             const Hidden* hidden);

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
    bool seen = false;                       // when it was last asked for
  };
  void draw(const Part& part, Drawn& drawn) const;
  void send(Part& part, const ScenePatch& patch);
  void send_colours();

  std::vector<Part> parts_;
  std::vector<Part*> asked_;  // of this draw
  std::vector<Colour> colours_;
  Texture colour_row_;
};

}  // namespace burr::render::gl
