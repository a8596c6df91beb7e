// render/gl/skin.h - the bone's surface on the GPU: one vertex and index buffer per patch.
//
// Memory: 20 B a vertex, 2 B an index, as in the scene. A patch is sent when its version changes.
// It is skipped when it is out of sight, turned away as a whole, or hidden. Where allowed, a coarse
// block is drawn instead of its patches, or a patch with fewer of its triangles. For use of this room only.
// Thread: main, with the context current. Units: m; frame: world.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "burr/render/gl/objects.h"
#include "burr/render/scene.h"

namespace burr::render::gl {

class Skin {
 public:
  // Sends what changed since the last call. Appends the boxes of those patches, before and after
  // the change. Returns how many were sent.
  int update(const Scene& scene, std::vector<math::Aabb>& changed);
  // True: at least one patch has a Stain (render/wound.h).
  [[nodiscard]] bool stained() const { return stained_; }
  // Two rows of 256, indexed by tissue: colour and gloss; grain, pores, milk.
  [[nodiscard]] GLuint colours() const { return colour_row_.get(); }

  struct Drawn {
    int patches = 0;
    long triangles = 0;
  };
  // Tests whether a box is completely behind what has been drawn when `look` was called.
  struct Hidden {
    std::function<void()> look;
    std::function<bool(const math::Aabb& box)> is;
  };
  // Allows blocks and coarser levels instead of patches, with an error of at most `error_share` times their distance.
  void allow(double error_share) { error_share_ = error_share; }
  // With the program in use, draws what may be seen from `eye` inside the planes (nx, ny, nz, d: n
  // . p + d >= 0 inside). With `hidden`: first what was visible the last time, then what that does
  // not hide (two passes: Hill & Collin, GPU Pro 2, 2011). The picture is the same.
  using Planes = std::array<Eigen::Vector4d, 6>;
  // both_sides: draw triangles that are turned away too.
  Drawn draw(const math::Vec3& eye, const Planes& planes, bool both_sides, const Hidden* hidden);
  // Draws the soft structures, which have no stains; open: also the parts that no bone covers.
  Drawn draw_soft(const math::Vec3& eye, const Planes& planes, bool open);

 private:
  struct Part {
    Buffer vertices, indices;
    VertexArray array;
    // the levels follow each other in `indices`, finest first
    struct Level {
      double error = 0;  // [m]
      GLsizei first = 0, count = 0;
    };
    std::vector<Level> levels;  // empty: nothing to draw
    GLenum type = GL_UNSIGNED_SHORT;
    math::Aabb box;
    math::Vec3 facing = math::Vec3::Zero();  // axis of the cone of the triangles' normals
    double spread = 0;                       // half angle of the cone; pi: all directions [rad]
    bool seen = false;                       // was visible in the last draw
  };
  struct Patch : Part {
    std::uint64_t version = 0;
    std::shared_ptr<const std::vector<Stain>> stains;
    std::shared_ptr<const std::vector<CoarseLevel>> coarser;
    Buffer stain_values;
    bool passing = false;  // some of its stains pass, and a coarser mesh must not hide them
  };
  struct Block : Part {
    std::vector<int> patches, inner;
    bool outermost = true, laid_out = false;
    std::shared_ptr<const CoarseMesh> mesh;
    std::uint64_t now = 0;  // SceneBlock::now; its box is that of its patches
    bool of_now = false;    // its mesh was made from the present patches
    bool stained = false;   // one of its patches has a Stain that passes; the mesh shows none
  };
  struct Soft : Part {
    std::shared_ptr<const CoarseMesh> mesh;
    volume::TissueId tissue = 0;
    bool open = false;  // no bone covers it
  };
  // A part and the level to draw it at.
  struct Asked {
    Part* part = nullptr;
    const Part::Level* level = nullptr;
  };

  void send(Patch& part, const ScenePatch& patch);
  static void send_indices(Patch& part, const ScenePatch& patch);
  void send_stains(Patch& part, const ScenePatch& patch);
  static void send(Part& part, const CoarseMesh& mesh);
  void update_soft(const Scene& scene, std::vector<math::Aabb>& changed);
  [[nodiscard]] const Part::Level& coarsest(const Part& part, const math::Vec3& eye) const;
  static void draw(const Part& part, const Part::Level& level, Drawn& drawn);
  // Adds what must be drawn of it to asked_. Returns the cost in triangles.
  long ask(Patch& patch, const math::Vec3& eye, const Planes& planes);
  long ask(Block& block, const math::Vec3& eye, const Planes& planes);
  long ask_inside(Block& block, const math::Vec3& eye, const Planes& planes);
  void update_blocks(const Scene& scene);
  void find_stained(const Scene& scene);
  void find_box(Block& part, const Scene& scene) const;
  void send_colours();

  std::vector<Patch> patches_;
  std::vector<Block> blocks_;
  std::vector<Soft> soft_;
  std::vector<Asked> asked_;          // parts of this draw
  std::vector<math::Vec3f> normals_;  // of the patch being sent
  double error_share_ = 0;
  bool stained_ = false;
  bool other_stains_ = false;  // some patch has got or lost a Stain that passes
  std::uint64_t known_ = 0;    // last seen number of the scene's changes
  bool both_sides_ = false;    // in this draw
  std::vector<Colour> colours_;
  std::vector<Material> materials_;
  Texture colour_row_;
};

}  // namespace burr::render::gl
