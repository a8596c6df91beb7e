// Draws one eye's picture: only what differs from the one that is kept.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "burr/render/gl/renderer_work.h"

namespace burr::render {

using gl::Frame;
using gl::Piece;
using gl::Rect;
using gl::rect_of;
using math::Aabb;
using math::Vec3;

namespace {

bool same(const Light& a, const Light& b) {
  return (a.towards.array() == b.towards.array()).all() && a.colour == b.colour &&
         a.strength == b.strength;
}
bool same(const Look& a, const Look& b) {
  return same(a.key, b.key) && same(a.fill, b.fill) && a.ambient == b.ambient &&
         a.gloss == b.gloss && a.occlusion == b.occlusion &&
         a.occlusion_reach == b.occlusion_reach && a.occlusion_samples == b.occlusion_samples &&
         a.occlusion_half == b.occlusion_half && a.supersample == b.supersample &&
         a.opacity == b.opacity && a.plain == b.plain && a.background_top == b.background_top &&
         a.background_bottom == b.background_bottom;
}
bool same(const std::optional<ClipPlane>& a, const std::optional<ClipPlane>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return (a->p.array() == b->p.array()).all() && (a->n.array() == b->n.array()).all();
}
bool same(const Piece& a, const Piece& b) {
  return a.shape == b.shape && a.world_from_shape == b.world_from_shape && a.colour == b.colour &&
         a.on_top == b.on_top;
}

// Divides the picture into pieces, to be drawn one after the other.
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

// Finds what differs from the kept picture, and makes the new state the kept one.
Renderer::Work::Parts Renderer::Work::compare(const Scene& scene, const Frame& frame,
                                              const std::vector<Piece>& pieces, bool all) {
  const Quality& quality = scene.quality;
  Parts parts;
  std::vector<Vec3> shadow = gl::shadow_of(scene);
  const Rect there = rect_of(held->extent, frame).with(rect_around(pieces, frame));
  if (all) {
    parts.bone.add(there.with(held->there));  // the background looks the same from everywhere
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
  const Rect covered = all ? there : rect_of(held->extent, frame).with(rect_around(pieces, frame));
  held->there = all ? covered : held->there.with(covered);

  // a change also darkens or lightens the hollows around it
  parts.light_occlusion = has_occlusion(scene.look);
  if (parts.light_occlusion) {
    held->stale.add(parts.bone.grown(margin_of(scene, frame), frame.all()));
    held->stale.join();
    if (held->stale.rects().size() > 32) {
      held->stale = {};
      held->stale.add(frame.all());
    }
    const bool now = all ? quality.ambient_occlusion : !quality.ambient_occlusion_later;
    const bool later = quality.refine && held->coarse.empty() && parts.bone.empty();
    if (now || later) {
      parts.ambient_occlusion = std::exchange(held->stale, {});
    } else if (all) {
      parts.ambient_occlusion = held->stale;
      parts.few_samples = true;
    }
  }
  return parts;
}

// Draws the scene for the present eye into its sheet, which is then bound.
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
      target.resize(frame.width, frame.height, scene.look.occlusion_half ? 2 : 1);
  if (!fresh) return fresh.error();
  if (sees_through(scene.look))
    if (const Status more = through.resize(frame.width, frame.height); !more) return more;

  // draw everything if the eye moved; otherwise only where bone or tool changed
  const bool all = *fresh || !held || !same(held->camera, scene.camera) ||
                   !same(held->look, scene.look) || !same(held->clip, scene.clip) ||
                   held->drape != scene.drape;
  if (all) {
    const Rect sky_outside =
        held && !*fresh && same(held->look, scene.look) && held->drape == scene.drape ? held->there
                                                                                      : frame.all();
    held.emplace();
    held->there = sky_outside;
    held->bone = held->extent = bounds(scene);
    if (quality.coarse_px > quality.coarse_still_px || (quality.grain_still && !quality.grain))
      held->coarse = pieces_of(frame.all());
  }
  const double pixels_at_1m = high / (2 * std::tan(0.5 * scene.camera.field_of_view));
  skin.allow((all ? quality.coarse_px : quality.coarse_still_px) / pixels_at_1m);
  gl::set_depths(frame, scene.camera, held->bone);
  frame.clip =
      clip_from_view(scene.camera, static_cast<double>(wide) / high, frame.near, frame.far);
  Parts parts = compare(scene, frame, pieces, all);
  parts.grain = (all ? quality.grain : quality.grain_still) && !scene.look.plain;
  changed.clear();
  held->camera = scene.camera;
  held->look = scene.look;
  held->clip = scene.clip;
  held->drape = scene.drape;
  held->pieces = pieces;
  if (!parts.bone.empty() || !parts.tool.empty() || !parts.ambient_occlusion.empty())
    if (const Status painted = paint(scene, frame, parts, pieces); !painted) return painted;
  if (const Status sharp = focus(scene, frame); !sharp) return sharp;
  if (all) figures.redrawn = 1;

  return put_on_sheet(scene, frame.all(), factor, {wide, high}, wide, high, 0, 0);
}

}  // namespace burr::render
