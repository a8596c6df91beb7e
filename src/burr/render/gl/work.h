// What a renderer draws with and what it holds between pictures. Its functions are in renderer.cpp
// (starting, pictures), work_paint.cpp (the five steps) and work_draw.cpp (only what changed).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "burr/render/depth_tiles.h"
#include "burr/render/gl/context.h"
#include "burr/render/gl/frame.h"
#include "burr/render/gl/join.h"
#include "burr/render/gl/lighting.h"
#include "burr/render/gl/overlay.h"
#include "burr/render/gl/region.h"
#include "burr/render/gl/see_through.h"
#include "burr/render/gl/shapes.h"
#include "burr/render/gl/skin.h"
#include "burr/render/gl/target.h"
#include "burr/render/renderer.h"

namespace burr::render {

inline constexpr int kMostReach = 512;    // of the hollows in samples: bounds the margin of a tile
inline constexpr int kMostTarget = 4096;  // samples along a side held at once

// How far the hollows of one sample see, in samples: their reach at the target, a quarter more for
// what is nearer to the eye. Bounds what one change can touch.
inline double reach_of(const Scene& scene, const gl::Frame& frame) {
  return std::min<double>(1.25 * scene.look.hollow_reach * frame.picture_height, kMostReach);
}
// ... and the softening, and half resolution
inline int margin_of(const Scene& scene, const gl::Frame& frame) {
  return static_cast<int>(reach_of(scene, frame)) + 12;
}

// What pieces may cover.
[[nodiscard]] gl::Rect rect_around(const std::vector<gl::Piece>& pieces, const gl::Frame& frame);

inline bool sees_through(const Look& look) { return look.opacity < 1; }
inline bool has_hollows(const Look& look) { return look.hollow > 0 && !look.plain; }

struct Renderer::Work {
  // the context first: it is the last to go
  std::unique_ptr<gl::Context> context;
  gl::Skin skin;
  gl::Shapes shapes;
  gl::Overlay overlay;
  gl::Target target;
  gl::Sheet sheet, stretched;  // the picture; what was lit, in its pixels where those are more
  gl::Region lit_anew;         // samples, by the last paint()
  gl::VertexArray nothing;     // a screen's triangle has no data, but wants an array
  gl::Lighting lighting;
  gl::SeeThrough through;
  gl::Program skin_mesh, clipped_skin, dressed_skin, clipped_dressed_skin, mesh, hollow, soften,
      shrink;
  int most = kMostTarget;                    // samples along a side
  int idle_width = 1280, idle_height = 720;  // of show() without a window
  Figures figures;
  bool reads_depth = false;  // cheaply: a graphics card waits for it, and OpenGL ES does not at all
  bool skip_hidden = true;
  std::vector<float> depth;
  DepthTiles tiles;

  // what the target holds, to draw only the difference next time
  struct Held {
    Camera camera;
    Look look;
    std::optional<ClipPlane> clip;
    math::Aabb bone;    // when it was drawn whole
    math::Aabb extent;  // ... and what was added since
    std::vector<gl::Piece> pieces;
    std::vector<math::Vec3> shadow;
    gl::Rect there;                // outside it there was but sky, all the time
    gl::Region stale;              // where hollows are old or missing
    std::vector<gl::Rect> coarse;  // pieces that were drawn coarser than a picture at rest
  };
  std::optional<Held> held;
  std::vector<math::Aabb> changed;  // boxes of patches sent since the target was drawn

  // What is held belongs to one eye. The members above are those of the eye being drawn; those of
  // the others wait here, and those of the first in the place of whoever is drawn instead.
  struct Eye {
    gl::Target target;
    gl::SeeThrough through;
    gl::Sheet sheet, stretched;
    std::optional<Held> held;
    std::vector<math::Aabb> changed;
    bool started = false;  // its programs are linked
  };
  std::array<Eye, 3> others;  // the window's second, a headset's two
  gl::Framebuffer headset;
  int eye = 0;
  bool started = false;
  gl::Join join;
  gl::Sheet both;               // two eyes' pictures as one
  gl::Sheet* on_show = &sheet;  // of the last show()

  Status look_with(int which);
  Status draw(const Scene& scene, int wide, int high);
  void present(Stereo how);

  Status start();
  void update(const Scene& scene);
  // What is to be drawn of a picture.
  struct Parts {
    gl::Region bone;     // where it changed
    gl::Region tool;     // where tool or marks did
    gl::Region shadow;   // where the tool's falls or fell
    gl::Region hollows;  // of the bone, to be found
    bool light_hollows = true;
    math::Aabb extent;  // of all bone
  };
  void paint(const Scene& scene, const gl::Frame& frame, const Parts& parts,
             const std::vector<gl::Piece>& pieces);
  void paint_bone(const Scene& scene, const gl::Frame& frame, const gl::Rect& r);
  void paint_tool(const gl::Frame& frame, const gl::Rect& r, const std::vector<gl::Piece>& pieces);
  void draw_pieces(const gl::Frame& frame, const gl::Rect& r, const std::vector<gl::Piece>& pieces,
                   bool with_marks);
  void paint_hollows(const Scene& scene, const gl::Frame& frame, const gl::Rect& r);
  struct Size {
    int width = 0, height = 0;
  };
  Status stretch(const gl::Rect& from, int wide, int high);
  Status put_on_sheet(const Scene& scene, const gl::Rect& from, int factor, const Size& size,
                      int width, int height, int left, int top);
  Parts compare(const Scene& scene, const gl::Frame& frame, const std::vector<gl::Piece>& pieces,
                bool all);
  static void read(const gl::Sheet& sheet, Image& image, int left, int top);
};

}  // namespace burr::render
