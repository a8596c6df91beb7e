// render/gl/skin.h - the bone's surface on the GPU: one vertex and index buffer per patch.
//
// Memory: 20 B a vertex, 2 B an index, as they are in the scene. A patch is sent when its version
// changes and skipped when it is out of sight, wholly turned away or hidden. Where it is allowed, a
// coarse block is drawn in the place of its patches. A header of this room only.
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
  // Any patch is dressed.
  [[nodiscard]] bool dressed() const { return dressed_; }
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
  // Blocks may be drawn for their patches: by an error of `error_share` times their distance.
  void allow(double error_share) { error_share_ = error_share; }
  // Draws with the program in use what may be seen from `eye` inside the planes (nx, ny, nz, d:
  // n . p + d >= 0 inside). With `hidden`: first what was seen the last time, then of the rest what
  // is not hidden behind it (two passes: Hill & Collin, GPU Pro 2, 2011). The picture is the same.
  using Planes = std::array<Eigen::Vector4d, 6>;
  // both_sides: what is turned away is seen too.
  Drawn draw(const math::Vec3& eye, const Planes& planes, bool both_sides, const Hidden* hidden);
  // The walls of what soft tissue fills, both sides of them, though bone hides them.
  Drawn draw_walls(const Planes& planes);

 private:
  struct Part {
    Buffer vertices, indices;
    VertexArray array;
    // one after the other in `indices`, finest first
    struct Level {
      double error = 0;  // [m]
      GLsizei first = 0, count = 0;
    };
    std::vector<Level> levels;  // none: nothing to draw
    GLenum type = GL_UNSIGNED_SHORT;
    Level walls;  // behind all levels in `indices`: triangles beside soft tissue
    math::Aabb box;
    math::Vec3 facing = math::Vec3::Zero();  // middle of the cone of the triangles' normals
    double spread = 0;                       // its half angle; pi: every way         [rad]
    bool seen = false;                       // when it was last asked for
  };
  struct Patch : Part {
    std::uint64_t version = 0;
    std::shared_ptr<const std::vector<Dress>> dress;
    Buffer dress_values;
  };
  struct Block : Part {
    std::vector<int> patches, inner;
    bool outermost = true, laid_out = false;
    std::shared_ptr<const CoarseMesh> mesh;
    std::uint64_t now = 0;  // as the scene's block has it; its box is that of its patches
    bool of_now = false;    // its mesh was made of the patches as they are now
    bool dressed = false;   // one of them is: the mesh does not show it
  };
  // A part with the level it is to be drawn at.
  struct Asked {
    Part* part = nullptr;
    const Part::Level* level = nullptr;
  };

  void send(Patch& part, const ScenePatch& patch);
  static void send_dress(Patch& part, const ScenePatch& patch);
  static void send(Block& part, const CoarseMesh& mesh);
  static void draw(const Part& part, const Part::Level& level, Drawn& drawn);
  // Asks for what is to be drawn of it. What that costs, in triangles.
  long ask(Patch& patch, const math::Vec3& eye, const Planes& planes);
  long ask(Block& block, const math::Vec3& eye, const Planes& planes);
  long ask_inside(Block& block, const math::Vec3& eye, const Planes& planes);
  void update_blocks(const Scene& scene);
  void find_dressed(const Scene& scene);
  void find_box(Block& part, const Scene& scene) const;
  void send_colours();

  std::vector<Patch> patches_;
  std::vector<Block> blocks_;
  std::vector<Asked> asked_;          // of this draw
  std::vector<math::Vec3f> normals_;  // of the patch being sent
  double error_share_ = 0;
  bool dressed_ = false;
  bool other_dresses_ = false;  // some patch has lost its dress, or got one
  std::uint64_t known_ = 0;     // of the scene's changes
  bool both_sides_ = false;     // in this draw
  std::vector<Colour> colours_;
  Texture colour_row_;
};

}  // namespace burr::render::gl
