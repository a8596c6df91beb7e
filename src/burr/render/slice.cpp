#include "burr/render/slice.h"

#include <algorithm>
#include <cmath>

namespace burr::render {

using math::Ijk;
using math::Vec3;
using volume::kBrickEdge;

namespace {

constexpr int kTries = 8;  // while the servo is writing a brick
constexpr Colour kAir = {0.03F, 0.03F, 0.04F};
constexpr Colour kBone = {0.86F, 0.86F, 0.84F};
constexpr float kSoft = 0.45F;    // factor for a soft tissue's colour
constexpr float kTint = 0.2F;     // share of a tissue's colour over the scan's value
constexpr double kClearly = 0.1;  // share of the way from the least value to that of bone

std::uint8_t unorm(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}

// The scan's value at a point, and the change since. solid: 0 air .. 1 bone, at present; bone: its
// colour; what: its tissue, nullptr: not shown.
Colour over_greys(const Slice& slice, double measured, float solid, const Colour& bone,
                  const volume::Tissue* what) {
  const volume::Greys& greys = *slice.greys;
  const auto grey = static_cast<float>(
      std::clamp((measured - slice.level) / std::max(slice.window, 1e-9) + 0.5, 0.0, 1.0));
  // clearly bone or clearly not, in the scan: noise around the level is neither
  const double edge = std::max(kClearly * (greys.iso - greys.least), 1e-9);
  const auto was = static_cast<float>(std::clamp((measured - greys.iso) / edge, 0.0, 1.0)),
             was_not = static_cast<float>(std::clamp((greys.iso - measured) / edge - 1, 0.0, 1.0));
  const float removed = was * (1 - solid), added = was_not * solid;
  float tint = 0;
  if (what != nullptr && what->kind == volume::TissueKind::solid) tint = kTint * solid;
  if (what != nullptr && what->kind == volume::TissueKind::soft) tint = kTint;
  Colour seen;
  for (std::size_t c = 0; c < 3; ++c) {
    const float own = what != nullptr ? what->colour[c] : bone[c];
    float v = grey + tint * (own - grey);
    v += removed * (kAir[c] - v);
    seen[c] = v + added * (bone[c] - v);
  }
  return seen;
}

}  // namespace

Vec3 right_of(Plane plane) { return plane == Plane::sagittal ? Vec3::UnitY() : Vec3::UnitX(); }
Vec3 up_of(Plane plane) { return plane == Plane::axial ? Vec3(0, -1, 0) : Vec3(0, 0, 1); }

Eigen::Vector2d pixel_of(const Slice& slice, const Vec3& p, int width, int height) {
  const double per_m = height / slice.height;
  const Vec3 d = p - slice.through;
  return {0.5 * width + per_m * d.dot(right_of(slice.plane)),
          0.5 * height - per_m * d.dot(up_of(slice.plane))};
}

Vec3 point_of(const Slice& slice, const Eigen::Vector2d& pixel, int width, int height) {
  const double m = slice.height / height;
  return slice.through + m * (pixel.x() - 0.5 * width) * right_of(slice.plane) -
         m * (pixel.y() - 0.5 * height) * up_of(slice.plane);
}

Slicer::Slicer(volume::Bone& bone)
    : bone_(bone),
      changed_(bone.add_watcher()),
      at_(static_cast<std::size_t>(bone.brick_count()), -1) {}

void Slicer::forget() {
  std::fill(at_.begin(), at_.end(), -1);
  kept_.clear();
}

const volume::BrickField* Slicer::brick(int bi, int bj, int bk) {
  const volume::BrickIndex index = bone_.brick_at(bi, bj, bk);
  std::int32_t& at = at_[static_cast<std::size_t>(index)];
  if (at < 0) {
    at = static_cast<std::int32_t>(kept_.size());
    kept_.emplace_back();
  }
  Kept& kept = kept_[static_cast<std::size_t>(at)];
  for (int n = 0; n < kTries && !kept.known; ++n) kept.known = bone_.copy_brick(index, kept.field);
  all_now_ = all_now_ && kept.known;
  return &kept.field;
}

// 0 air .. 65535 solid; outside the grid is air
double Slicer::field(const Ijk& ijk) {
  if (!bone_.grid().contains(ijk)) return 0;
  const Ijk b = ijk / kBrickEdge, in = ijk - b * kBrickEdge;
  const auto place = static_cast<std::size_t>(in.x() + kBrickEdge * (in.y() + kBrickEdge * in.z()));
  return brick(b.x(), b.y(), b.z())->voxel[place];
}

bool Slicer::draw(const Slice& slice, Image& image) {
  changed_.take_all([this](std::size_t brick) {
    if (const std::int32_t at = at_[brick]; at >= 0)
      kept_[static_cast<std::size_t>(at)].known = false;
  });
  if (kept_.size() > kMostKept) forget();
  all_now_ = true;
  const volume::Grid& grid = bone_.grid();
  image.rgb.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                   3);
  const auto to_grid = [&](double x, double y) {
    return grid.grid_from_world(point_of(slice, {x, y}, image.width, image.height));
  };
  const Vec3 first = to_grid(0.5, 0.5);
  const Vec3 across = to_grid(1.5, 0.5) - first, down = to_grid(0.5, 1.5) - first;
  std::size_t out = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, out += 3) {
      const Vec3 p = first + x * across + y * down;
      const Vec3 low = p.array().floor();
      if ((low.array() < -1).any() || (low.array() > grid.size.cast<double>().array()).any()) {
        for (std::size_t c = 0; c < 3; ++c) image.rgb[out + c] = unorm(kAir[c]);
        continue;
      }
      const Ijk at = low.cast<int>();
      const Vec3 part = p - low;
      double value = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Ijk o(corner & 1, corner >> 1 & 1, corner >> 2);
        const double w = (o.x() != 0 ? part.x() : 1 - part.x()) *
                         (o.y() != 0 ? part.y() : 1 - part.y()) *
                         (o.z() != 0 ? part.z() : 1 - part.z());
        if (w > 0) value += w * field(at + o);
      }
      // the change from air to bone takes one voxel
      const auto solid = static_cast<float>(
          std::clamp((value - volume::kIso) / volume::kFieldPerVoxel + 0.5, 0.0, 1.0));
      Colour bone = kBone, air = kAir;
      const Ijk nearest = p.array().round().cast<int>();
      const volume::Tissue* what = nullptr;
      if (slice.labels && grid.contains(nearest)) {
        what = &bone_.tissues()[bone_.shared_tissue(nearest.x(), nearest.y(), nearest.z())];
        if (what->kind == volume::TissueKind::solid) bone = what->colour;
        if (what->kind == volume::TissueKind::soft)
          for (std::size_t c = 0; c < 3; ++c) air[c] = kSoft * what->colour[c];
      }
      double measured = 0;
      if (slice.greys != nullptr && slice.greys->at(grid.world_from_grid(p), measured)) {
        const Colour seen = over_greys(slice, measured, solid, bone, what);
        for (std::size_t c = 0; c < 3; ++c) image.rgb[out + c] = unorm(seen[c]);
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c)
        image.rgb[out + c] = unorm(air[c] + solid * (bone[c] - air[c]));
    }
  return all_now_;
}

}  // namespace burr::render
