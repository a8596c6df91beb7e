// render/gl/renderer_work.h - the members of a renderer, and what it keeps between two pictures. Its
// functions are in renderer.cpp (start, pictures), work_paint.cpp (the five steps) and
// work_draw.cpp (only what changed).
//
// Thread: main, with the context current.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "burr/render/depth_tiles.h"
#include "burr/render/gl/context.h"
#include "burr/render/gl/draped.h"
#include "burr/render/gl/draw_target.h"
#include "burr/render/gl/focus_pass.h"
#include "burr/render/gl/frame.h"
#include "burr/render/gl/join.h"
#include "burr/render/gl/lighting.h"
#include "burr/render/gl/overlay.h"
#include "burr/render/gl/see_through_pass.h"
#include "burr/render/gl/skin.h"
#include "burr/render/gl/skin_programs.h"
#include "burr/render/gl/target_parts.h"
#include "burr/render/gl/tool_triangles.h"
#include "burr/render/renderer.h"

namespace burr::render {

inline constexpr int kMostReach = 512;    // limit on the hollows' reach, and so on the margin of a
                                          // tile [sample]
inline constexpr int kMostTarget = 4096;  // most samples along a side at once

// Reach of the ambient occlusion of one sample, in samples: that at the target plus a quarter, for
// what is nearer to the eye. It limits what one change can affect.
inline double reach_of(const Scene& scene, const gl::Frame& frame) {
  return std::min<double>(1.25 * scene.look.occlusion_reach * frame.picture_height, kMostReach);
}
// adds the reach of the softening, and of half resolution
inline int margin_of(const Scene& scene, const gl::Frame& frame) {
  return static_cast<int>(reach_of(scene, frame)) + 12;
}

// The rectangle that the pieces may cover.
[[nodiscard]] gl::Rect rect_around(const std::vector<gl::Piece>& pieces, const gl::Frame& frame);

inline bool sees_through(const Look& look) { return look.opacity < 1; }
inline bool has_occlusion(const Look& look) { return look.occlusion > 0 && !look.plain; }

struct Renderer::Work {
  // the context is first, because it must be destroyed last
  std::unique_ptr<gl::Context> context;
  gl::Skin skin;
  gl::Shapes shapes;
  gl::Draped draped;
  gl::Overlay overlay;
  gl::Target target;
  // the picture; the lit samples at pixel size, where there are more pixels than samples
  gl::PictureBuffer sheet, stretched;
  gl::PictureBuffer focused;  // the lit samples, as a lens draws them; of the eye drawn last
  gl::Region lit_anew;        // redrawn by the last paint(), in samples
  gl::VertexArray nothing;    // the screen triangle has no data, but OpenGL needs an array
  gl::Lighting lighting;
  gl::SeeThrough through;
  gl::SkinPrograms skins;
  gl::Program mesh, occlusion, soften, shrink;
  int most = kMostTarget;                    // most samples along a side
  int idle_width = 1280, idle_height = 720;  // size for show() without a window
  Figures figures;
  bool reads_depth = false;  // depth is cheap to read back; with a graphics card it waits, and
                             // OpenGL ES cannot
  bool skip_hidden = true;
  std::vector<float> depth;
  DepthTiles tiles;

  // the content of the target, so that the next picture draws only the difference
  struct Held {
    Camera camera;
    Look look;
    std::optional<ClipPlane> clip;
    std::shared_ptr<const Drape> drape;
    math::Aabb bone;    // extent when it was drawn whole
    math::Aabb extent;  // with what was added since
    std::vector<gl::Piece> pieces;
    std::vector<math::Vec3> shadow;
    gl::Rect there;                // outside it there has only been background
    gl::Region stale;              // where the hollows are old or missing
    std::vector<gl::Rect> coarse;  // parts drawn coarser than in a picture at rest
  };
  std::optional<Held> held;
  std::vector<math::Aabb> changed;  // boxes of the patches sent since the target was drawn

  // The target and its content belong to one eye. The members above belong to the eye being drawn;
  // those of the other eyes are stored here, and those of the first eye take the place of the eye
  // being drawn.
  struct Eye {
    gl::Target target;
    gl::SeeThrough through;
    gl::PictureBuffer sheet, stretched;
    std::optional<Held> held;
    std::vector<math::Aabb> changed;
    bool started = false;  // its programs have been linked
  };
  std::array<Eye, 3> others;  // the window's second eye, and two of a headset
  gl::Framebuffer headset;
  int eye = 0;
  bool started = false;
  gl::EyeJoiner join;
  gl::FocusPass focusing;
  gl::PictureBuffer both;               // the joined picture of two eyes
  gl::PictureBuffer* on_show = &sheet;  // the sheet of the last show()

  Status look_with(int which);
  Status draw(const Scene& scene, int wide, int high);
  void present(Stereo how);

  Status start();
  void update(const Scene& scene);
  // The parts of a picture that must be drawn.
  struct Parts {
    gl::Region bone;               // where it changed
    gl::Region tool;               // where tool or marks changed
    gl::Region shadow;             // where the tool's shadow is or was
    gl::Region ambient_occlusion;  // where the bone's hollows must be computed
    bool light_occlusion = true;
    bool few_samples = false;  // of the hollows
    bool grain = true;
    math::Aabb extent;  // of all bone
  };
  Status paint(const Scene& scene, const gl::Frame& frame, const Parts& parts,
               const std::vector<gl::Piece>& pieces);
  void paint_bone(const Scene& scene, const gl::Frame& frame, const gl::Rect& r, bool grain);
  void paint_tool(const gl::Frame& frame, const gl::Rect& r, const std::vector<gl::Piece>& pieces);
  void draw_pieces(const gl::Frame& frame, const gl::Rect& r, const std::vector<gl::Piece>& pieces,
                   bool with_marks);
  void paint_occlusion(const Scene& scene, const gl::Frame& frame, const gl::Rect& r, int samples);
  struct Size {
    int width = 0, height = 0;
  };
  Status focus(const Scene& scene, const gl::Frame& frame);
  Status stretch(const gl::Rect& from, int wide, int high, bool unsharp);
  Status put_on_sheet(const Scene& scene, const gl::Rect& from, int factor, const Size& size,
                      int width, int height, int left, int top);
  Parts compare(const Scene& scene, const gl::Frame& frame, const std::vector<gl::Piece>& pieces,
                bool all);
  static void read(const gl::PictureBuffer& sheet, Image& image, int left, int top);
};

}  // namespace burr::render
