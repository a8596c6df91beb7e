// Draws in five steps: what is there, how open it is, softened, lit, and shrunk to pixels. Each
// step works inside a rectangle, which is the whole picture or only where something moved.
#include "burr/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "burr/render/depth_tiles.h"
#include "burr/render/gl/context.h"
#include "burr/render/gl/frame.h"
#include "burr/render/gl/join.h"
#include "burr/render/gl/lighting.h"
#include "burr/render/gl/overlay.h"
#include "burr/render/gl/region.h"
#include "burr/render/gl/see_through.h"
#include "burr/render/gl/shaders.h"
#include "burr/render/gl/shapes.h"
#include "burr/render/gl/skin.h"
#include "burr/render/gl/target.h"

namespace burr::render {

using gl::Frame;
using gl::Piece;
using gl::Program;
using gl::Rect;
using gl::rect_of;
using gl::Region;
using math::Aabb;
using math::Vec3;

namespace {

constexpr int kMostSamples = 48;   // of the hollows, see shaders.h
constexpr int kMostReach = 512;    // of the hollows in samples: bounds the margin of a tile
constexpr int kMostTarget = 4096;  // samples along a side held at once
constexpr int kMostPicture = 65536;

constexpr float kBone = 1.0F, kSteel = 0.67F, kMark = 0.33F;  // kinds, as the shaders have them

bool same(const Light& a, const Light& b) {
  return (a.towards.array() == b.towards.array()).all() && a.colour == b.colour &&
         a.strength == b.strength;
}
bool same(const Look& a, const Look& b) {
  return same(a.key, b.key) && same(a.fill, b.fill) && a.ambient == b.ambient &&
         a.gloss == b.gloss && a.hollow == b.hollow && a.hollow_reach == b.hollow_reach &&
         a.hollow_samples == b.hollow_samples && a.hollow_half == b.hollow_half &&
         a.supersample == b.supersample && a.opacity == b.opacity && a.plain == b.plain &&
         a.background_top == b.background_top && a.background_bottom == b.background_bottom;
}
bool same(const std::optional<ClipPlane>& a, const std::optional<ClipPlane>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return (a->p.array() == b->p.array()).all() && (a->n.array() == b->n.array()).all();
}
bool same(const Piece& a, const Piece& b) {
  return a.shape == b.shape && a.world_from_shape == b.world_from_shape && a.colour == b.colour &&
         a.on_top == b.on_top;
}

// How far the hollows of one sample see, in samples: their reach at the target, a quarter more for
// what is nearer to the eye. Bounds what one change can touch.
double reach_of(const Scene& scene, const Frame& frame) {
  return std::min<double>(1.25 * scene.look.hollow_reach * frame.picture_height, kMostReach);
}
// ... and the softening, and half resolution
int margin_of(const Scene& scene, const Frame& frame) {
  return static_cast<int>(reach_of(scene, frame)) + 12;
}

bool sees_through(const Look& look) { return look.opacity < 1; }
bool has_hollows(const Look& look) { return look.hollow > 0 && !look.plain; }

}  // namespace

struct Renderer::Work {
  // the context first: it is the last to go
  std::unique_ptr<gl::Context> context;
  gl::Skin skin;
  gl::Shapes shapes;
  gl::Overlay overlay;
  gl::Target target;
  gl::Sheet sheet, stretched;  // the picture; what was lit, in its pixels where those are more
  Region lit_anew;             // samples, by the last paint()
  gl::VertexArray nothing;     // a screen's triangle has no data, but wants an array
  gl::Lighting lighting;
  gl::SeeThrough through;
  Program skin_mesh, clipped_skin, dressed_skin, clipped_dressed_skin, mesh, hollow, soften, shrink;
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
    Aabb bone;    // when it was drawn whole
    Aabb extent;  // ... and what was added since
    std::vector<Piece> pieces;
    std::vector<Vec3> shadow;
    Region stale;              // where hollows are old or missing
    std::vector<Rect> coarse;  // pieces that were drawn coarser than a picture at rest
  };
  std::optional<Held> held;
  std::vector<Aabb> changed;  // boxes of patches sent since the target was drawn

  // What is held belongs to one eye. The members above are those of the eye being drawn; those of
  // the others wait here, and those of the first in the place of whoever is drawn instead.
  struct Eye {
    gl::Target target;
    gl::SeeThrough through;
    gl::Sheet sheet, stretched;
    std::optional<Held> held;
    std::vector<Aabb> changed;
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
    Region bone;     // where it changed
    Region tool;     // where tool or marks did
    Region shadow;   // where the tool's falls or fell
    Region hollows;  // of the bone, to be found
    bool light_hollows = true;
    Aabb extent;  // of all bone
  };
  void paint(const Scene& scene, const Frame& frame, const Parts& parts,
             const std::vector<Piece>& pieces);
  void paint_bone(const Scene& scene, const Frame& frame, const Rect& r);
  void paint_tool(const Frame& frame, const Rect& r, const std::vector<Piece>& pieces);
  void draw_pieces(const Frame& frame, const Rect& r, const std::vector<Piece>& pieces,
                   bool with_marks);
  void paint_hollows(const Scene& scene, const Frame& frame, const Rect& r);
  struct Size {
    int width = 0, height = 0;
  };
  Status stretch(const Rect& from, int wide, int high);
  Status put_on_sheet(const Scene& scene, const Rect& from, int factor, const Size& size, int width,
                      int height, int left, int top);
  Parts compare(const Scene& scene, const Frame& frame, const std::vector<Piece>& pieces, bool all);
  static void read(const gl::Sheet& sheet, Image& image, int left, int top);
};

// ---- starting

Status Renderer::Work::start() {
  constexpr const char *kColours = gl::kColourFunctions, *kClip = "#define CLIP\n",
                       *kDressed = "#define DRESSED\n";
  const struct {
    Program* program;
    std::initializer_list<const char*> vertex, fragment;
  } all[] = {{&skin_mesh, {gl::kSkinVertex}, {gl::kMeshFragment}},
             {&clipped_skin, {kClip, gl::kSkinVertex}, {kClip, gl::kMeshFragment}},
             {&dressed_skin, {kDressed, gl::kSkinVertex}, {kDressed, gl::kMeshFragment}},
             {&clipped_dressed_skin,
              {kClip, kDressed, gl::kSkinVertex},
              {kClip, kDressed, gl::kMeshFragment}},
             {&mesh, {gl::kMeshVertex}, {gl::kMeshFragment}},
             {&hollow, {gl::kScreenVertex}, {gl::kHollowFragment}},
             {&soften, {gl::kScreenVertex}, {gl::kSoftenFragment}},
             {&shrink, {gl::kScreenVertex}, {kColours, gl::kShrinkFragment}}};
  for (const auto& one : all) {
    Result<Program> linked = Program::link(context->es(), one.vertex, one.fragment);
    if (!linked) return linked.error();
    *one.program = std::move(*linked);
  }
  for (const Status& made :
       {lighting.start(context->es()), through.start(context->es()), overlay.make(context->es())})
    if (!made) return made;
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  most = std::min({kMostTarget, texture, viewport[0], viewport[1]});
  nothing.make();
  reads_depth = !context->es() && context->software();
  started = true;
  return join.start(context->es());
}

Status Renderer::Work::look_with(int which) {
  const auto change = [this](int other) {
    if (other == 0) return;
    Eye& there = others[static_cast<std::size_t>(other - 1)];
    std::swap(target, there.target);
    std::swap(through, there.through);
    std::swap(sheet, there.sheet);
    std::swap(stretched, there.stretched);
    std::swap(held, there.held);
    std::swap(changed, there.changed);
    std::swap(started, there.started);
  };
  change(eye);
  eye = which;
  change(eye);
  if (std::exchange(started, true)) return fine();
  return through.start(context->es());
}

Renderer::Renderer(std::unique_ptr<Work> work) : work_(std::move(work)) {}

Renderer::~Renderer() {
  if (work_ != nullptr) work_->context->make_current();
}

Result<std::unique_ptr<Renderer>> Renderer::offscreen(Api api) {
  auto context = gl::Context::offscreen(api);
  if (!context) return context.error();
  auto work = std::make_unique<Work>();
  work->context = std::move(*context);
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(work)));
  const Status started = renderer->work_->start();
  if (!started) return started.error();
  return renderer;
}

Result<std::unique_ptr<Renderer>> Renderer::window(const std::string& title, int width, int height,
                                                   bool quad_buffer) {
  auto context = gl::Context::window(title, width, height, quad_buffer);
  if (!context) return context.error();
  auto work = std::make_unique<Work>();
  work->context = std::move(*context);
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(work)));
  const Status started = renderer->work_->start();
  if (!started) return started.error();
  return renderer;
}

// ---- the five steps

void Renderer::Work::update(const Scene& scene) {
  figures = {};
  std::vector<Aabb> sent;
  figures.patches_uploaded = skin.update(scene, sent);
  changed.insert(changed.end(), sent.begin(), sent.end());
  for (Eye& other : others)  // who holds nothing is drawn whole
    if (other.held) other.changed.insert(other.changed.end(), sent.begin(), sent.end());
}

void Renderer::Work::paint(const Scene& scene, const Frame& frame, const Parts& parts,
                           const std::vector<Piece>& pieces) {
  glEnable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  Rect not_bone;
  for (const Piece& piece : pieces)
    for (const auto& corners : piece.boxes) not_bone = not_bone.with(rect_of(corners, frame));
  const Rect there = rect_of(parts.extent, frame).with(not_bone);  // all that is not sky
  for (const Rect& rect : parts.bone.rects()) paint_bone(scene, frame, rect);
  Region fresh = parts.bone;
  fresh.add(parts.tool);
  fresh.join();
  for (const Rect& rect : fresh.rects()) paint_tool(frame, rect, pieces);
  const bool seen_through = sees_through(scene.look);
  if (seen_through)
    for (const Rect& rect : fresh.rects()) {
      const gl::Skin::Drawn drawn =
          through.paint(scene, frame, rect, skin, [&] { draw_pieces(frame, rect, pieces, false); });
      figures.patches_drawn += drawn.patches;
      figures.triangles_drawn += drawn.triangles;
    }

  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(nothing.get());
  for (const Rect& rect : parts.hollows.rects()) paint_hollows(scene, frame, rect.in(there));
  Region lit = fresh;
  lit.add(parts.hollows);
  lit.add(parts.shadow);
  lit.join();
  const std::vector<Vec3> shade = gl::shadow_of(scene);
  const Rect shaded = shade.empty() || scene.look.plain ? Rect{} : rect_of(shade, frame);
  const gl::Unlit what = {&target.colour, &target.normal, &target.depth, &target.lit_at};
  const gl::Hollows hollows = {parts.light_hollows ? &target.soft : nullptr, target.hollow_width,
                               target.hollow_height, target.stride};
  for (const Rect& rect : lit.rects()) {
    const Rect some = rect.in(there);
    const auto light = [&](const Rect& part, bool shadow) {
      lighting.paint(scene, frame, part.in(not_bone), what, hollows, {shadow, true});
      for (const Rect& bone : part.without(not_bone))
        lighting.paint(scene, frame, bone, what, hollows, {shadow, false});
    };
    light(some.in(shaded), true);
    for (const Rect& rest : some.without(shaded)) light(rest, false);
    for (const Rect& rest : rect.without(there))
      lighting.paint_sky(scene, frame, rest, target.lit_at);
    if (seen_through) through.blend(scene, frame, some, what, lighting);
  }
  glDisable(GL_SCISSOR_TEST);
  lit_anew = lit;
  figures.redrawn = std::max(figures.redrawn, std::min(1.0, lit.area() / frame.all().area()));
}

void Renderer::Work::paint_bone(const Scene& scene, const Frame& frame, const Rect& r) {
  if (r.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, target.bone.get());
  glViewport(0, 0, frame.width, frame.height);
  gl::scissor(r);
  const std::array<float, 4> none{};
  glClearBufferfv(GL_COLOR, 0, none.data());
  glClearBufferfv(GL_COLOR, 1, none.data());
  const float farthest = 1;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_CULL_FACE);

  Program& program = skin.dressed() ? (scene.clip ? clipped_dressed_skin : dressed_skin)
                                    : (scene.clip ? clipped_skin : skin_mesh);
  program.use();
  const Eigen::Matrix4d clip_from_world = frame.clip * frame.view;
  program.set("clip_from_model", Eigen::Matrix4f(clip_from_world.cast<float>()));
  const Eigen::Matrix3d turn = frame.view.block<3, 3>(0, 0);
  program.set("view_from_model_n", Eigen::Matrix3f(turn.cast<float>()));
  program.set("tint_kind", Eigen::Vector4f(1, 1, 1, kBone));
  program.set("tissue_colours", 0);
  program.set("grains_per_m", 2000.0F);
  if (scene.clip) {
    glDisable(GL_CULL_FACE);
    const Vec3& n = scene.clip->n;
    Eigen::Vector4f plane;
    plane << n.cast<float>(), static_cast<float>(-n.dot(scene.clip->p));
    program.set("plane", plane);
    program.set("plane_n", Eigen::Vector3f((turn * n).cast<float>()));
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, skin.colours());
  const gl::Skin::Hidden hidden = {
      [&] {
        depth.resize(static_cast<std::size_t>(r.x1 - r.x0) * static_cast<std::size_t>(r.y1 - r.y0));
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0, GL_DEPTH_COMPONENT, GL_FLOAT,
                     depth.data());
        tiles.look(depth.data(), {r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0});
      },
      [&](const Aabb& box) { return tiles.hide(box, clip_from_world, frame.width, frame.height); }};
  const gl::Skin::Drawn drawn =
      skin.draw(scene.camera.eye(), gl::planes_of(r, frame), scene.clip.has_value(),
                reads_depth && skip_hidden ? &hidden : nullptr);
  figures.patches_drawn += drawn.patches;
  figures.triangles_drawn += drawn.triangles;
}

// A copy of the bone, and what stands before it.
void Renderer::Work::paint_tool(const Frame& frame, const Rect& r,
                                const std::vector<Piece>& pieces) {
  if (r.empty()) return;
  gl::scissor(r);
  target.copy_bone(r.x0, r.y0, r.x1, r.y1);
  glBindFramebuffer(GL_FRAMEBUFFER, target.geometry.get());
  glViewport(0, 0, frame.width, frame.height);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_CULL_FACE);
  draw_pieces(frame, r, pieces, true);
}

// Tool and, with_marks, what is drawn over everything, into the framebuffer that is bound.
void Renderer::Work::draw_pieces(const Frame& frame, const Rect& r,
                                 const std::vector<Piece>& pieces, bool with_marks) {
  mesh.use();
  const Eigen::Matrix4d clip_from_world = frame.clip * frame.view;
  const Eigen::Matrix3d turn = frame.view.block<3, 3>(0, 0);
  for (const Piece& piece : pieces) {
    if (piece.on_top && !with_marks) continue;
    if (std::all_of(piece.boxes.begin(), piece.boxes.end(),
                    [&](const auto& corners) { return rect_of(corners, frame).in(r).empty(); }))
      continue;
    Eigen::Matrix4d m = clip_from_world * piece.world_from_shape;
    // on top: pressed into the nearest hundredth of the depth, where nothing else is
    if (piece.on_top) m.row(2) = 0.01 * m.row(2) - 0.985 * m.row(3);
    mesh.set("clip_from_model", Eigen::Matrix4f(m.cast<float>()));
    const Eigen::Matrix3d n =
        (turn * piece.world_from_shape.block<3, 3>(0, 0)).inverse().transpose();
    // scaled, so that single precision does not run out on small tools
    mesh.set("view_from_model_n", Eigen::Matrix3f((n / n.norm()).cast<float>()));
    mesh.set("tint_kind", Eigen::Vector4f(piece.colour[0], piece.colour[1], piece.colour[2],
                                          piece.steel ? kSteel : kMark));
    piece.shape->draw();
  }
}

namespace {

// sample places within the unit disc, dense in the middle: a golden spiral
std::array<float, 2 * kMostSamples> spiral(int count) {
  std::array<float, 2 * kMostSamples> xy{};
  for (int s = 0; s < count; ++s) {
    const double r = (s + 0.5) / count, angle = s * std::numbers::pi * (3 - std::sqrt(5.0));
    xy[static_cast<std::size_t>(2 * s)] = static_cast<float>(r * std::cos(angle));
    xy[static_cast<std::size_t>(2 * s + 1)] = static_cast<float>(r * std::sin(angle));
  }
  return xy;
}

}  // namespace

void Renderer::Work::paint_hollows(const Scene& scene, const Frame& frame, const Rect& r) {
  if (r.empty()) return;
  const int stride = target.stride;
  const int count = std::clamp(scene.look.hollow_samples, 1, kMostSamples);
  const Rect low = Rect{r.x0 / stride, r.y0 / stride, (r.x1 + stride - 1) / stride,
                        (r.y1 + stride - 1) / stride};
  glViewport(0, 0, target.hollow_width, target.hollow_height);
  gl::scissor(low);
  gl::bind(0, target.bone_depth);
  gl::bind(1, target.bone_colour);
  gl::bind(2, target.bone_normal);

  hollow.use();
  hollow.set("depth_map", 0);
  hollow.set("colour_map", 1);
  hollow.set("normal_map", 2);
  hollow.set("ray", gl::ray_of(frame));
  hollow.set("planes",
             Eigen::Vector2f(static_cast<float>(frame.near), static_cast<float>(frame.far)));
  hollow.set("size", frame.width, frame.height);
  hollow.set("stride", stride);
  hollow.set("reach", static_cast<float>(gl::hollow_reach(scene)));
  const double per_m =
      frame.picture_height / (2 * std::tan(scene.camera.field_of_view / 2));  // at 1 m
  hollow.set("pixels_per_m", static_cast<float>(per_m));
  hollow.set("most_pixels", static_cast<float>(std::min<double>(
                                2 * scene.look.hollow_reach * frame.picture_height, kMostReach)));
  hollow.set("samples", count);
  hollow.set_pairs("spiral", count, spiral(count).data());
  glBindFramebuffer(GL_FRAMEBUFFER, target.hollow_at.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);

  gl::bind(0, target.hollow);
  soften.use();
  soften.set("hollow_map", 0);
  soften.set("size", target.hollow_width, target.hollow_height);
  soften.set("strict", gl::strict_of(scene, frame));
  glBindFramebuffer(GL_FRAMEBUFFER, target.soft_at.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

// All of the target in more pixels, anew only where it is: to stretch costs more than to light.
Status Renderer::Work::stretch(const Rect& from, int wide, int high) {
  const bool kept = stretched.width == wide && stretched.height == high;
  if (const Status sized = stretched.resize(wide, high); !sized) return sized;
  if (!kept) {
    lit_anew = {};
    lit_anew.add(from);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.lit_at.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, stretched.at.get());
  glEnable(GL_SCISSOR_TEST);
  const double x = static_cast<double>(wide) / (from.x1 - from.x0),
               y = static_cast<double>(high) / (from.y1 - from.y0);
  const Region anew = std::exchange(lit_anew, {});
  for (const Rect& rect : anew.rects()) {
    // a pixel mixes the samples around it
    const Rect wider = rect.grown(1);
    gl::scissor(
        Rect{static_cast<int>(std::floor(wider.x0 * x)), static_cast<int>(std::floor(wider.y0 * y)),
             static_cast<int>(std::ceil(wider.x1 * x)), static_cast<int>(std::ceil(wider.y1 * y))}
            .in({0, 0, wide, high}));
    glBlitFramebuffer(from.x0, from.y0, from.x1, from.y1, 0, 0, wide, high, GL_COLOR_BUFFER_BIT,
                      GL_LINEAR);
  }
  glDisable(GL_SCISSOR_TEST);
  return fine();
}

// `from` of the target becomes the sheet of that size, shrunk by `factor` or stretched: the part of
// a picture of width x height that starts at (left, top); words on top.
Status Renderer::Work::put_on_sheet(const Scene& scene, const Rect& from, int factor,
                                    const Size& size, int width, int height, int left, int top) {
  const auto [wide, high] = size;
  const Status sized = sheet.resize(wide, high);
  if (!sized) return sized;
  glBindFramebuffer(GL_FRAMEBUFFER, sheet.at.get());
  glViewport(0, 0, wide, high);
  if (factor == 1) {
    const bool same_size = wide == from.x1 - from.x0 && high == from.y1 - from.y0;
    if (!same_size)
      if (const Status done = stretch(from, wide, high); !done) return done;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, sheet.at.get());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, (same_size ? target.lit_at : stretched.at).get());
    const Rect all = same_size ? from : Rect{0, 0, wide, high};
    glBlitFramebuffer(all.x0, all.y0, all.x1, all.y1, 0, 0, wide, high, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, sheet.at.get());
  } else {
    gl::bind(0, target.lit);
    shrink.use();
    shrink.set("picture", 0);
    shrink.set("factor", factor);
    shrink.set("from", from.x0, from.y0);
    glBindVertexArray(nothing.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  overlay.draw(scene, width, height, left, top, wide, high);
  return fine();
}

// the sheet into its place in a picture
void Renderer::Work::read(const gl::Sheet& sheet, Image& image, int left, int top) {
  const auto wide = static_cast<std::size_t>(sheet.width);
  std::vector<std::uint8_t> rgba(wide * static_cast<std::size_t>(sheet.height) * 4);
  glBindFramebuffer(GL_FRAMEBUFFER, sheet.at.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, sheet.width, sheet.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (int y = 0; y < sheet.height; ++y) {
    const std::uint8_t* from =
        rgba.data() + static_cast<std::size_t>(sheet.height - 1 - y) * wide * 4;
    std::uint8_t* to = image.rgb.data() +
                       (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(left)) *
                           3;
    for (std::size_t x = 0; x < wide; ++x) std::copy_n(from + 4 * x, 3, to + 3 * x);
  }
}

// ---- pictures

Result<Image> Renderer::image(const Scene& scene, int width, int height, int tile) {
  if (width < 1 || height < 1 || width > kMostPicture || height > kMostPicture)
    return error(Trouble::usage,
                 fmt::format("a picture of {} x {} pixels cannot be drawn; width and height go "
                             "from 1 to {}",
                             width, height, kMostPicture));
  Work& w = *work_;
  w.context->make_current();
  w.update(scene);
  w.changed.clear();
  w.held.reset();
  w.skin.allow(0);

  const int factor = std::clamp(scene.look.supersample, 1, 8);
  const int stride = scene.look.hollow_half ? 2 : 1;
  Frame whole;
  whole.picture_width = width * factor;
  whole.picture_height = height * factor;
  whole.view = view_from_world(scene.camera);
  const Aabb bone = bounds(scene);
  gl::set_depths(whole, scene.camera, bone);

  // tiles overlap by as far as hollows reach, in steps that keep their pattern in place
  const int margin = (margin_of(scene, whole) + 7) / 8 * 8;
  const auto step_for = [&](int size) {
    if (tile > 0) return (tile * factor + 8 * factor - 1) / (8 * factor) * (8 * factor);
    if (size <= w.most) return size;
    return std::max(8 * factor, (w.most - 2 * margin) / (8 * factor) * (8 * factor));
  };
  const int step_x = step_for(whole.picture_width), step_y = step_for(whole.picture_height);

  Image image{width, height, {}};
  image.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const std::vector<Piece>& pieces = w.shapes.pieces(scene);
  for (int y = 0; y < whole.picture_height; y += step_y)
    for (int x = 0; x < whole.picture_width; x += step_x) {
      const Rect inner = {x, y, std::min(x + step_x, whole.picture_width),
                          std::min(y + step_y, whole.picture_height)};
      const Rect outer = inner.grown(margin).in({0, 0, whole.picture_width, whole.picture_height});
      Frame frame = whole;
      frame.left = outer.x0;
      frame.bottom = outer.y0;
      frame.width = outer.x1 - outer.x0;
      frame.height = outer.y1 - outer.y0;
      const auto part = [](int at, int size) { return 2.0 * at / size - 1; };
      frame.clip = clip_from_view(
          scene.camera, static_cast<double>(width) / height, frame.near, frame.far,
          {part(outer.x0, whole.picture_width), part(outer.x1, whole.picture_width),
           part(outer.y0, whole.picture_height), part(outer.y1, whole.picture_height)});
      const Result<bool> sized = w.target.resize(frame.width, frame.height, stride);
      if (!sized) return sized.error();
      if (sees_through(scene.look))
        if (const Status more = w.through.resize(frame.width, frame.height); !more)
          return more.error();
      Work::Parts parts;
      parts.extent = bone;
      parts.bone.add(frame.all());
      parts.light_hollows = has_hollows(scene.look);
      if (parts.light_hollows) parts.hollows.add(frame.all());
      w.paint(scene, frame, parts, pieces);
      const int left = inner.x0 / factor, top = height - inner.y1 / factor;
      const Status done = w.put_on_sheet(
          scene,
          {inner.x0 - outer.x0, inner.y0 - outer.y0, inner.x1 - outer.x0, inner.y1 - outer.y0},
          factor, {(inner.x1 - inner.x0) / factor, (inner.y1 - inner.y0) / factor}, width, height,
          left, top);
      if (!done) return done.error();
      Work::read(w.sheet, image, left, top);
    }
  w.figures.redrawn = 1;
  if (glGetError() == GL_OUT_OF_MEMORY)
    return error(Trouble::io, "the graphics card ran out of memory; make the picture smaller");
  return image;
}

namespace {

// The picture in pieces, to be drawn one after the other.
std::vector<Rect> pieces_of(const Rect& all) {
  constexpr int kAcross = 6, kUp = 4;
  std::vector<Rect> pieces;
  for (int y = 0; y < kUp; ++y)
    for (int x = 0; x < kAcross; ++x)
      pieces.push_back({all.x1 * x / kAcross, all.y1 * y / kUp, all.x1 * (x + 1) / kAcross,
                        all.y1 * (y + 1) / kUp});
  return pieces;
}

}  // namespace

// What differs from the picture that is held; then that is what is held.
Renderer::Work::Parts Renderer::Work::compare(const Scene& scene, const Frame& frame,
                                              const std::vector<Piece>& pieces, bool all) {
  const Quality& quality = scene.quality;
  Parts parts;
  std::vector<Vec3> shadow = gl::shadow_of(scene);
  if (all) {
    parts.bone.add(frame.all());
  } else {
    for (const Aabb& box : changed) {
      parts.bone.add(rect_of(box, frame));
      held->extent.extend(box.lo);
      held->extent.extend(box.hi);
    }
    const std::vector<Piece>& old = held->pieces;
    const auto add = [&](const std::vector<Piece>& some, std::size_t i) {
      if (i >= some.size()) return;
      for (const auto& corners : some[i].boxes) parts.tool.add(rect_of(corners, frame));
    };
    for (std::size_t i = 0; i < std::max(old.size(), pieces.size()); ++i) {
      if (i < old.size() && i < pieces.size() && same(old[i], pieces[i])) continue;
      add(old, i);
      add(pieces, i);
    }
    if (quality.refine && !held->coarse.empty()) {
      parts.bone.add(held->coarse.back());
      held->coarse.pop_back();
    }
    parts.bone.join();
    parts.tool.join();
    if (!parts.tool.empty() || !parts.bone.empty())
      for (const auto* points : {&std::as_const(held->shadow), &std::as_const(shadow)})
        if (!points->empty()) parts.shadow.add(rect_of(*points, frame));
  }
  held->shadow = std::move(shadow);
  parts.extent = held->extent;

  // what changed darkens the hollows around it
  parts.light_hollows = has_hollows(scene.look);
  if (parts.light_hollows) {
    held->stale.add(parts.bone.grown(margin_of(scene, frame), frame.all()));
    held->stale.join();
    if (held->stale.rects().size() > 32) {
      held->stale = {};
      held->stale.add(frame.all());
    }
    const bool now = all ? quality.hollows : !quality.hollows_later;
    const bool later = quality.refine && held->coarse.empty() && parts.bone.empty();
    if (now || later) parts.hollows = std::exchange(held->stale, {});
    if (all && !now) {
      target.clear_hollows();
      parts.light_hollows = false;
    }
  }
  return parts;
}

// The scene as the eye that is drawn sees it, onto its sheet, which is bound then.
Status Renderer::Work::draw(const Scene& scene, int wide, int high) {
  const Quality& quality = scene.quality;
  const int factor = std::clamp(scene.look.supersample, 1, 4);
  const double scale = factor == 1 ? std::clamp(quality.scale, 0.25, 1.0) : factor;
  Frame frame;
  frame.picture_width = frame.width = std::max(1, static_cast<int>(std::lround(wide * scale)));
  frame.picture_height = frame.height = std::max(1, static_cast<int>(std::lround(high * scale)));
  frame.view = view_from_world(scene.camera);
  const std::vector<Piece>& pieces = shapes.pieces(scene);
  const Result<bool> fresh =
      target.resize(frame.width, frame.height, scene.look.hollow_half ? 2 : 1);
  if (!fresh) return fresh.error();
  if (sees_through(scene.look))
    if (const Status more = through.resize(frame.width, frame.height); !more) return more;

  // everything anew when the eye moved; else only where bone or tool did
  const bool all = *fresh || !held || !same(held->camera, scene.camera) ||
                   !same(held->look, scene.look) || !same(held->clip, scene.clip);
  if (all) {
    held.emplace();
    held->bone = held->extent = bounds(scene);
    if (quality.coarse_px > quality.coarse_still_px) held->coarse = pieces_of(frame.all());
  }
  const double pixels_at_1m = high / (2 * std::tan(0.5 * scene.camera.field_of_view));
  skin.allow((all ? quality.coarse_px : quality.coarse_still_px) / pixels_at_1m);
  gl::set_depths(frame, scene.camera, held->bone);
  frame.clip =
      clip_from_view(scene.camera, static_cast<double>(wide) / high, frame.near, frame.far);
  const Parts parts = compare(scene, frame, pieces, all);
  changed.clear();
  held->camera = scene.camera;
  held->look = scene.look;
  held->clip = scene.clip;
  held->pieces = pieces;
  if (!parts.bone.empty() || !parts.tool.empty() || !parts.hollows.empty())
    paint(scene, frame, parts, pieces);

  return put_on_sheet(scene, frame.all(), factor, {wide, high}, wide, high, 0, 0);
}

void Renderer::Work::present(Stereo how) {
  if (!context->visible()) {
    glFinish();
    return;
  }
  const auto put = [](const gl::Sheet& from) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from.at.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, from.width, from.height, 0, 0, from.width, from.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
  };
  if (how == Stereo::quad_buffer) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDrawBuffer(GL_BACK_RIGHT);
    put(others[0].sheet);
    glDrawBuffer(GL_BACK_LEFT);
    put(sheet);
    glDrawBuffer(GL_BACK);
  } else {
    put(*on_show);
  }
  context->swap();
}

Status Renderer::show(const Scene& scene, const std::function<void()>& over) {
  return show(scene, TwoEyes{}, over);
}

Status Renderer::show(const Scene& scene, const TwoEyes& eyes, const std::function<void()>& over) {
  Work& w = *work_;
  w.context->make_current();
  w.update(scene);
  const int wide = std::max(1, width()), high = std::max(1, height());
  const Stereo how = eyes.how == Stereo::quad_buffer && !quad_buffer() ? Stereo::off : eyes.how;
  w.on_show = &w.sheet;
  if (how == Stereo::off) {
    if (w.others[0].held) w.others[0] = {};
    if (const Status drawn = w.draw(scene, wide, high); !drawn) return drawn;
    if (over) over();  // the sheet is bound
  } else {
    const Eyes cameras = eyes_of(scene.camera, eyes.apart);
    Scene seen = scene;
    for (const int which : {0, 1}) {
      seen.camera = (which == 0) != eyes.swapped ? cameras.left : cameras.right;
      Status drawn = w.look_with(which);
      if (drawn) drawn = w.draw(seen, wide, high);
      if (drawn && over) over();
      if (!drawn) {
        static_cast<void>(w.look_with(0));
        return drawn;
      }
    }
    if (const Status back = w.look_with(0); !back) return back;
    if (how != Stereo::quad_buffer) {
      if (const Status sized = w.both.resize(wide, high); !sized) return sized;
      glBindVertexArray(w.nothing.get());
      w.join.draw(w.sheet, w.others[0].sheet, w.both, how, eyes.first_row);
      w.on_show = &w.both;
    }
  }
  w.present(how);
  if (glGetError() == GL_CONTEXT_LOST)
    return error(Trouble::io, "the graphics card was lost; start it anew");
  return fine();
}

Status Renderer::eye(const Scene& scene, int which, unsigned texture, int width, int height) {
  Work& w = *work_;
  w.context->make_current();
  const Figures so_far = w.figures;
  w.update(scene);
  Status drawn = w.look_with(2 + which);
  if (drawn) drawn = w.draw(scene, width, height);
  if (drawn) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, w.headset.make());
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, w.sheet.at.get());
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    // the texture is its owner's again
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFlush();
  }
  if (const Status back = w.look_with(0); drawn && !back) drawn = back;
  w.figures.redrawn = std::max(w.figures.redrawn, so_far.redrawn);
  w.figures.patches_uploaded += so_far.patches_uploaded;
  w.figures.patches_drawn += so_far.patches_drawn;
  w.figures.triangles_drawn += so_far.triangles_drawn;
  return drawn;
}

void Renderer::wait_for_screen(bool on) { work_->context->wait_for_screen(on); }
void Renderer::make_current() { work_->context->make_current(); }
bool Renderer::es() const { return work_->context->es(); }
bool Renderer::quad_buffer() const { return work_->context->quad_buffer(); }

void Renderer::skip_hidden(bool on) { work_->skip_hidden = on; }

void Renderer::title(const std::string& text) { work_->context->title(text); }

int Renderer::width() const {
  int wide = work_->idle_width, high = 0;
  if (work_->context->visible()) work_->context->size(wide, high);
  return wide;
}
int Renderer::height() const {
  int wide = 0, high = work_->idle_height;
  if (work_->context->visible()) work_->context->size(wide, high);
  return high;
}
void Renderer::resize_offscreen(int width, int height) {
  work_->idle_width = width;
  work_->idle_height = height;
}

std::string Renderer::gpu() const { return work_->context->gpu(); }
bool Renderer::software() const { return work_->context->software(); }
bool Renderer::refined() const {
  const auto done = [](const std::optional<Work::Held>& held) {
    return held->coarse.empty() && held->stale.empty();
  };
  const auto& other = work_->others[0].held;
  return work_->held && done(work_->held) && (!other || done(other));
}
Renderer::Figures Renderer::figures() const { return work_->figures; }

Image Renderer::shown() {
  Work& w = *work_;
  w.context->make_current();
  const gl::Sheet& sheet = *w.on_show;
  Image image{sheet.width, sheet.height, {}};
  image.rgb.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                   3);
  Work::read(sheet, image, 0, 0);
  return image;
}

}  // namespace burr::render
