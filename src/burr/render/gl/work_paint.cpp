// The five steps of a picture: surface maps, ambient occlusion, its softening, light, shrinking to
// pixels. Each works inside a rectangle: the whole picture, or only where something moved.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "burr/render/gl/renderer_work.h"
#include "burr/render/gl/shaders.h"

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

constexpr int kMostSamples = 48;  // of the hollows, see shaders.h

constexpr int kFewSamples = 3;  // where time is short

constexpr float kBone = 1, kSteel = 0.67F, kMark = 0.33F;  // kinds, as in the shaders

}  // namespace

Rect rect_around(const std::vector<Piece>& pieces, const Frame& frame) {
  Rect all;
  for (const Piece& piece : pieces)
    for (const auto& corners : piece.boxes) all = all.with(rect_of(corners, frame));
  return all;
}

Status Renderer::Work::paint(const Scene& scene, const Frame& frame, const Parts& parts,
                             const std::vector<Piece>& pieces) {
  glEnable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  const Rect not_bone = rect_around(pieces, frame);
  const Rect there = rect_of(parts.extent, frame).with(not_bone);  // everything that is not
                                                                   // background
  for (const Rect& rect : parts.bone.rects()) paint_bone(scene, frame, rect, parts.grain);
  Region fresh = parts.bone;
  fresh.add(parts.tool);
  fresh.join();
  for (const Rect& rect : fresh.rects()) paint_tool(frame, rect, pieces);
  const bool seen_through = sees_through(scene.look);
  if (seen_through)
    for (const Rect& rect : fresh.rects()) {
      const gl::Skin::Drawn drawn = through.paint(scene, frame, rect, {skin, skins, parts.grain},
                                                  [&] { draw_pieces(frame, rect, pieces, false); });
      figures.patches_drawn += drawn.patches;
      figures.triangles_drawn += drawn.triangles;
    }

  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  if (const Status drawn = lighting.tool_shadow.draw(scene, frame, pieces); !drawn) return drawn;
  glEnable(GL_SCISSOR_TEST);
  glBindVertexArray(nothing.get());
  const int samples = parts.few_samples ? std::min(kFewSamples, scene.look.occlusion_samples)
                                        : scene.look.occlusion_samples;
  for (const Rect& rect : parts.ambient_occlusion.rects())
    paint_occlusion(scene, frame, rect.in(there), samples);
  Region lit = fresh;
  lit.add(parts.ambient_occlusion);
  lit.add(parts.shadow);
  lit.join();
  const std::vector<Vec3> shade = gl::shadow_of(scene);
  const Rect shaded = shade.empty() || scene.look.plain ? Rect{} : rect_of(shade, frame);
  const gl::Unlit what = {&target.colour, &target.normal, &target.depth, &target.lit_at};
  const gl::OcclusionMaps ambient_occlusion = {parts.light_occlusion ? &target.soft : nullptr,
                                               target.occlusion_width, target.occlusion_height,
                                               target.stride};
  for (const Rect& rect : lit.rects()) {
    const Rect some = rect.in(there);
    const auto light = [&](const Rect& part, bool shadow) {
      lighting.paint(scene, frame, part.in(not_bone), what, ambient_occlusion, {shadow, true});
      for (const Rect& bone : part.without(not_bone))
        lighting.paint(scene, frame, bone, what, ambient_occlusion, {shadow, false});
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
  return fine();
}

void Renderer::Work::paint_bone(const Scene& scene, const Frame& frame, const Rect& r, bool grain) {
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
  draped.draw(scene.drape, frame, mesh);

  if (scene.clip) glDisable(GL_CULL_FACE);
  const Eigen::Matrix4d clip_from_world = frame.clip * frame.view;
  skins.use({skin.stained(), grain, scene.clip.has_value()}, scene, frame, skin.colours());
  const gl::Skin::Hidden hidden = {
      [&] {
        depth.resize(static_cast<std::size_t>(r.x1 - r.x0) * static_cast<std::size_t>(r.y1 - r.y0));
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0, GL_DEPTH_COMPONENT, GL_FLOAT,
                     depth.data());
        tiles.look(depth.data(), {r.x0, r.y0, r.x1 - r.x0, r.y1 - r.y0});
      },
      [&](const Aabb& box) { return tiles.hide(box, clip_from_world, frame.width, frame.height); }};
  const Vec3 from = scene.camera.eye();
  const gl::Skin::Planes planes = gl::planes_of(r, frame);
  const gl::Skin::Drawn drawn = skin.draw(from, planes, scene.clip.has_value(),
                                          reads_depth && skip_hidden ? &hidden : nullptr);
  skins.use({false, grain, scene.clip.has_value()}, scene, frame, skin.colours());
  if (scene.clip) {  // what fills a canal to its wall is in front of the wall
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(0, -60000);
  }
  const gl::Skin::Drawn soft = skin.draw_soft(from, planes, scene.clip.has_value());
  glDisable(GL_POLYGON_OFFSET_FILL);
  figures.patches_drawn += drawn.patches;
  figures.triangles_drawn += drawn.triangles + soft.triangles;
}

// Copies the bone and draws the tool and marks in front of it.
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

// Draws the tool and, with_marks, what is drawn over everything, into the bound framebuffer.
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
    // on top: moved into the nearest hundredth of the depth, where nothing else is
    if (piece.on_top) m.row(2) = 0.01 * m.row(2) - 0.985 * m.row(3);
    mesh.set("clip_from_model", Eigen::Matrix4f(m.cast<float>()));
    const Eigen::Matrix3d n =
        (turn * piece.world_from_shape.block<3, 3>(0, 0)).inverse().transpose();
    // scaled, so that single precision suffices for small tools
    mesh.set("view_from_model_n", Eigen::Matrix3f((n / n.norm()).cast<float>()));
    mesh.set("tint_kind", Eigen::Vector4f(piece.colour[0], piece.colour[1], piece.colour[2],
                                          piece.bone    ? kBone
                                          : piece.steel ? kSteel
                                                        : kMark));
    piece.shape->draw();
  }
}

namespace {

// sample positions within the unit disc, dense in the middle: a golden spiral
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

void Renderer::Work::paint_occlusion(const Scene& scene, const Frame& frame, const Rect& r,
                                     int samples) {
  if (r.empty()) return;
  const int stride = target.stride;
  const int count = std::clamp(samples, 1, kMostSamples);
  const Rect low = Rect{r.x0 / stride, r.y0 / stride, (r.x1 + stride - 1) / stride,
                        (r.y1 + stride - 1) / stride};
  glViewport(0, 0, target.occlusion_width, target.occlusion_height);
  gl::scissor(low);
  gl::bind(0, target.bone_depth);
  gl::bind(1, target.bone_colour);
  gl::bind(2, target.bone_normal);

  occlusion.use();
  occlusion.set("depth_map", 0);
  occlusion.set("colour_map", 1);
  occlusion.set("normal_map", 2);
  occlusion.set("ray", gl::ray_of(frame));
  occlusion.set("planes",
                Eigen::Vector2f(static_cast<float>(frame.near), static_cast<float>(frame.far)));
  occlusion.set("size", frame.width, frame.height);
  occlusion.set("stride", stride);
  occlusion.set("reach", static_cast<float>(gl::occlusion_reach(scene)));
  const double per_m =
      frame.picture_height / (2 * std::tan(scene.camera.field_of_view / 2));  // at 1 m
  occlusion.set("pixels_per_m", static_cast<float>(per_m));
  occlusion.set("most_pixels",
                static_cast<float>(std::min<double>(
                    2 * scene.look.occlusion_reach * frame.picture_height, kMostReach)));
  occlusion.set("samples", count);
  occlusion.set_pairs("spiral", count, spiral(count).data());
  glBindFramebuffer(GL_FRAMEBUFFER, target.occlusion_at.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);

  gl::bind(0, target.occlusion);
  soften.use();
  soften.set("occlusion_map", 0);
  soften.set("size", target.occlusion_width, target.occlusion_height);
  soften.set("strict", gl::strict_of(scene, frame));
  glBindFramebuffer(GL_FRAMEBUFFER, target.soft_at.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

// Draws the lit samples as the scene's lens does.
Status Renderer::Work::focus(const Scene& scene, const Frame& frame) {
  if (!scene.focus) return fine();
  glBindVertexArray(nothing.get());
  const double height = 2 * scene.focus->distance * std::tan(0.5 * scene.camera.field_of_view);
  return focusing.draw(*scene.focus, height, frame, target, focused);
}

// Enlarges the whole target to more pixels, but renews only what changed: enlarging costs more than
// lighting.
Status Renderer::Work::stretch(const Rect& from, int wide, int high, bool unsharp) {
  const bool kept = stretched.width == wide && stretched.height == high;
  if (const Status sized = stretched.resize(wide, high); !sized) return sized;
  if (!kept || unsharp) {  // a sample that changed changes those around it
    lit_anew = {};
    lit_anew.add(from);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, (unsharp ? focused.at : target.lit_at).get());
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

// Shrinks `from` of the target by `factor`, or enlarges it, into a sheet of that size: the part of
// a picture of width x height that starts at (left, top). Then draws the overlay.
Status Renderer::Work::put_on_sheet(const Scene& scene, const Rect& from, int factor,
                                    const Size& size, int width, int height, int left, int top) {
  const auto [wide, high] = size;
  const bool unsharp = scene.focus.has_value();
  const Status sized = sheet.resize(wide, high);
  if (!sized) return sized;
  glBindFramebuffer(GL_FRAMEBUFFER, sheet.at.get());
  glViewport(0, 0, wide, high);
  if (factor == 1) {
    const bool same_size = wide == from.x1 - from.x0 && high == from.y1 - from.y0;
    if (!same_size)
      if (const Status done = stretch(from, wide, high, unsharp); !done) return done;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, sheet.at.get());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, (!same_size ? stretched.at
                                            : unsharp  ? focused.at
                                                       : target.lit_at)
                                               .get());
    const Rect all = same_size ? from : Rect{0, 0, wide, high};
    glBlitFramebuffer(all.x0, all.y0, all.x1, all.y1, 0, 0, wide, high, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, sheet.at.get());
  } else {
    gl::bind(0, unsharp ? focused.colour : target.lit);
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

// Copies the sheet to its place in a picture.
void Renderer::Work::read(const gl::PictureBuffer& sheet, Image& image, int left, int top) {
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

}  // namespace burr::render
