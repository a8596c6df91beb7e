#include "burr/edit/brush.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "burr/rt/flags.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kBrickVoxels;

constexpr int kMostSlices = 64;    // as the carver
constexpr int kRounding = 8;       // of a second difference: three of them, of rounded values
constexpr int kMayDiffer = 4096;   // a quarter of a voxel
constexpr int kLeastSlope = 4096;  // of a ramp along its steepest axis, a voxel  [field units]
constexpr float kSlopeMayDiffer = 0.25F;
constexpr double kMostShare = 0.125;  // of the second difference in a tick; beyond a sixth it rings
constexpr double kAnew = 0.25;        // of a lacking ramp in a tick
constexpr int kUsualBricks = 12;      // in a tick, some 8 us each; kMostBricks at the worst
constexpr float kPerSum = 1 << 20;    // of a sum's unit
constexpr int kAllBut = 4096;         // a quarter of a voxel of depth

Field clamped(float f) {
  return f <= 0 ? Field{0} : f >= 65535 ? volume::kSolid : static_cast<Field>(f + 0.5F);
}

// Towards the original by at most `most`, as far as the ball lets it. ball: first voxel less the
// middle, and its radius; inner: of what growing bone keeps out of; layers across the axis that may
// change. True: anything to write.
bool go_back(const KeptBrick& original, const float* ball, float inner, int most, int axis,
             unsigned layers, KeptBrick& now) {
  constexpr auto kPerVoxel = static_cast<float>(volume::kFieldPerVoxel);
  bool changed = false;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int is = now.field.voxel[v], was = original.field.voxel[v];
    if (is == was && now.tissue[v] == original.tissue[v]) continue;
    if (!in_layers(v, axis, layers)) continue;
    const float x = ball[0] + static_cast<float>(v & 7),
                y = ball[1] + static_cast<float>(v >> 3 & 7),
                z = ball[2] + static_cast<float>(v >> 6);
    const float d = std::sqrt(x * x + y * y + z * z);
    if (d > ball[3]) continue;
    int to = is;
    // the ball's edge is a ramp, but what is all but there goes all the way
    const float edge = std::abs(is - was) <= kAllBut ? 65535.0F : (ball[3] - d) * kPerVoxel;
    if (is < was) {
      const int room =
          std::min(clamped(32768.0F + edge), clamped(32768.0F + (d - inner) * kPerVoxel));
      to = std::max(is, std::min({was, is + most, room}));
    } else if (is > was) {
      to = std::min(is, std::max({was, is - most, int{clamped(32768.0F - edge)}}));
    }
    if (to == was && now.tissue[v] != original.tissue[v]) {
      now.tissue[v] = original.tissue[v];
      changed = true;
    }
    changed |= to != is;
    now.field.voxel[v] = static_cast<Field>(to);
  }
  return changed;
}

// A ramp's value; else it may be any depth beyond.
bool on_ramp(int field) { return field > 0 && field < 65535; }

// A brick and two voxels about it.
class Halo {
 public:
  static constexpr int kEdge = kBrickEdge + 4;
  static constexpr int kSteps[3] = {1, kEdge, kEdge* kEdge};

  Halo(const volume::Bone& bone, BrickIndex brick) {
    const math::Ijk at = bone.brick_ijk(brick) / kBrickEdge;
    const Field* about[3][3][3];
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const math::Ijk of = at + math::Ijk(i, j, k);
          const bool in = (of.array() >= 0).all() && (of.array() < bone.bricks().array()).all();
          about[k + 1][j + 1][i + 1] =
              in ? bone.brick_field(bone.brick_at(of.x(), of.y(), of.z())) : nullptr;
        }
    int* to = voxel_;
    for (int z = -2; z < kBrickEdge + 2; ++z)
      for (int y = -2; y < kBrickEdge + 2; ++y) {
        const auto& row = about[(z >> 3) + 1][(y >> 3) + 1];
        const int start = 8 * (y & 7) + 64 * (z & 7);
        for (int x = -2; x < kBrickEdge + 2; ++x) {
          const Field* field = row[(x >> 3) + 1];
          *to++ = field == nullptr ? 0 : field[start + (x & 7)];
        }
      }
  }
  [[nodiscard]] const int* at(int x, int y, int z) const {
    return voxel_ + (x + 2) + kEdge * (y + 2) + kEdge * kEdge * (z + 2);
  }

 private:
  int voxel_[kEdge * kEdge * kEdge];
};

// What a voxel a voxel or more from the surface lacks to what the two towards the surface foretell,
// along the axis that goes there most steeply; less what a curved ramp may differ by. Of two as
// steep the first counts; along the axis of step `flipped` that is the one above, as in a mirror.
int lack_of_ramp(const int* at, int flipped) {
  const int is = *at;
  int steepest = kLeastSlope, lack = 0;
  for (const int axis : Halo::kSteps)
    for (const int step : {axis == flipped ? axis : -axis, axis == flipped ? -axis : axis}) {
      const int near = at[step], nearer = at[2 * step];
      const int slope = is < 32768 ? nearer - near : near - nearer;
      if (!on_ramp(near) || !on_ramp(nearer) || slope <= steepest) continue;
      steepest = slope;
      lack = std::clamp(2 * near - nearer, 0, 65535) - is;
    }
  return lack > kMayDiffer ? lack - kMayDiffer : lack < -kMayDiffer ? lack + kMayDiffer : 0;
}

// What a voxel near the surface is to move by so that the ramp is as steep as a ramp is; nothing
// right at the surface, which stays where it is.
float lack_of_slope(const int* at) {
  float square = 0;
  for (const int step : Halo::kSteps) {
    if (!on_ramp(at[-step]) || !on_ramp(at[step])) return 0;
    const float along = static_cast<float>(at[step] - at[-step]) / (2 * 16384.0F);
    square += along * along;
  }
  const float lack = 1 - std::sqrt(square);
  const float less = lack > kSlopeMayDiffer    ? lack - kSlopeMayDiffer
                     : lack < -kSlopeMayDiffer ? lack + kSlopeMayDiffer
                                               : 0;
  return less * static_cast<float>(*at - 32768);
}

// The tissue of the fullest neighbour; of two as full the first, along the flipped axis the one
// above.
volume::TissueId grown_from(const volume::Bone& bone, int i, int j, int k, int flipped) {
  int fullest = 0;
  volume::TissueId tissue = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {axis == flipped ? 1 : -1, axis == flipped ? -1 : 1}) {
      math::Ijk at(i, j, k);
      at[axis] += step;
      const int is = bone.field(at.x(), at.y(), at.z());
      if (is <= fullest) continue;
      fullest = is;
      tissue = bone.tissue(at.x(), at.y(), at.z());
    }
  return tissue;
}

// A brick on the plane is written from both sides.
void keep_other_layers(const volume::Bone& bone, int axis, unsigned layers, KeptBrick& content) {
  const Field* field = bone.brick_field(content.brick);
  if (layers == kAllLayers || field == nullptr) return;
  const volume::TissueId* tissue = bone.brick_tissue(content.brick);
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (in_layers(v, axis, layers)) continue;
    content.field.voxel[v] = field[v];
    content.tissue[v] = tissue[v];
  }
}

}  // namespace

Brush::Box Brush::box_of(const Vec3& centre, double reach) const BURR_RT {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double most = bone_.bricks()[axis] - 1;
    box.lo[axis] = static_cast<int>(
        std::clamp(std::floor((centre[axis] - reach) / kBrickEdge), 0.0, most + 1));
    box.hi[axis] =
        static_cast<int>(std::clamp(std::floor((centre[axis] + reach) / kBrickEdge), -1.0, most));
  }
  return box;
}

// As many slices as the bricks of the last tick need.
void Brush::begin(int least_slices, std::uint32_t& flags) BURR_RT {
  int slices = std::clamp(least_slices, 1, kMostSlices);
  while (slices < kMostSlices && found_ > slices * kUsualBricks) slices *= 2;
  if (slices != slices_) slice_ = 0;
  slices_ = slices;
  if (least_slices > 1) flags |= rt::kFlagPutOff;
  slice_ = (slice_ + 1) % slices_;
  found_ = worked_ = 0;
  crowded_ = false;
}

template <class Wants>
void Brush::find(const Sides& sides, int side, double reach, const Wants& wants) BURR_RT {
  const Half& half = sides.half[side];
  const int most = worked_ + kMostBricks;
  const Box box = box_of(sides.centre[side], reach);
  for (int bk = box.lo.z(); bk <= box.hi.z(); ++bk)
    for (int bj = box.lo.y(); bj <= box.hi.y(); ++bj)
      for (int bi = box.lo.x(); bi <= box.hi.x(); ++bi) {
        if (!wants(bi, bj, bk)) continue;
        ++found_;
        const unsigned layers = layers_of({bi, bj, bk}, half, slices_, slice_);
        if (layers == 0) continue;
        if (worked_ == most) {
          crowded_ = true;
          continue;
        }
        Patch& patch = patches_[static_cast<std::size_t>(worked_++)];
        patch.brick = bone_.brick_at(bi, bj, bk);
        patch.layers = layers;
        patch.side = side;
      }
}

// Some of the one side and others of the other's would be no mirror: rather nothing, until there
// are more slices.
void Brush::end_finding(const Mirror& mirror, std::uint32_t& flags) BURR_RT {
  if (!mirror.on() || !crowded_) return;
  worked_ = 0;
  flags |= rt::kFlagPutOff;
}

int Brush::units_a_tick(const Brushing& now) const BURR_RT {
  const double voxels = kSpeed * now.strength * now.dt * slices_ / bone_.grid().voxel;
  return static_cast<int>(std::clamp(std::ceil(voxels * volume::kFieldPerVoxel), 0.0, 65535.0));
}

void Brush::restore(const Brushing& now, std::uint32_t& flags) BURR_RT {
  begin(now.slices, flags);
  const int most = units_a_tick(now);
  const double reach = now.radius + kReach;
  const Sides sides = sides_of(now.centre, now.mirror);
  for (int side = 0; side < sides.count; ++side)
    find(sides, side, reach, [this](int bi, int bj, int bk) BURR_RT {
      const BrickIndex brick = bone_.brick_at(bi, bj, bk);
      const KeptBrick* original = undo_.original_of(brick);
      const Field* field = original != nullptr ? bone_.brick_field(brick) : nullptr;
      return field != nullptr &&
             (std::memcmp(field, &original->field, sizeof original->field) != 0 ||
              std::memcmp(bone_.brick_tissue(brick), original->tissue, sizeof original->tissue) !=
                  0);
    });
  end_finding(now.mirror, flags);
  KeptBrick content;
  for (int n = 0; n < worked_; ++n) {
    const Patch& patch = patches_[static_cast<std::size_t>(n)];
    const Half& half = sides.half[patch.side];
    const Vec3 first = bone_.brick_ijk(patch.brick).cast<double>() - sides.centre[patch.side];
    const float ball[4] = {static_cast<float>(first.x()), static_cast<float>(first.y()),
                           static_cast<float>(first.z()), static_cast<float>(reach)};
    content.brick = patch.brick;
    std::memcpy(&content.field, bone_.brick_field(patch.brick), sizeof content.field);
    std::memcpy(content.tissue, bone_.brick_tissue(patch.brick), sizeof content.tissue);
    if (go_back(*undo_.original_of(patch.brick), ball, static_cast<float>(now.radius - kOverlap),
                most, half.mirror.axis, patch.layers, content))
      writer_.rewrite(content, flags);
  }
}

// ---- smooth

// Nothing but air, or nothing but solid, in the brick and beside it: no surface to smooth.
bool Brush::is_flat_around(int bi, int bj, int bk) const BURR_RT {
  const auto kind = [this](int i, int j, int k) {
    const math::Ijk& all = bone_.bricks();
    if (i < 0 || j < 0 || k < 0 || i >= all.x() || j >= all.y() || k >= all.z()) return 0;
    const BrickIndex brick = bone_.brick_at(i, j, k);
    const Field* field = bone_.brick_field(brick);
    if (field == nullptr) return 0;
    return !bone_.is_uniform(brick) ? -1 : field[0] == 0 ? 0 : 1;
  };
  const int is = kind(bi, bj, bk);
  return is >= 0 && kind(bi - 1, bj, bk) == is && kind(bi + 1, bj, bk) == is &&
         kind(bi, bj - 1, bk) == is && kind(bi, bj + 1, bk) == is && kind(bi, bj, bk - 1) == is &&
         kind(bi, bj, bk + 1) == is;
}

void Brush::look_at(Patch& patch, const Vec3& centre, double radius, const Half& half,
                    Sums& sums) const BURR_RT {
  const int axis = half.mirror.axis, flipped = half.is_image ? Halo::kSteps[axis] : 0;
  const Halo halo(bone_, patch.brick);
  const math::Ijk first = bone_.brick_ijk(patch.brick);
  const Vec3 from = first.cast<double>() - centre;
  const auto fx = static_cast<float>(from.x()), fy = static_cast<float>(from.y()),
             fz = static_cast<float>(from.z());
  const auto per_square = static_cast<float>(1 / (radius * radius));
  for (int v = 0; v < kBrickVoxels; ++v) {
    patch.flow[v] = patch.ramp[v] = patch.weight[v] = 0;
    if (!in_layers(v, axis, patch.layers)) continue;
    const int x = v & 7, y = v >> 3 & 7, z = v >> 6;
    if (!bone_.grid().contains(first + math::Ijk(x, y, z))) continue;  // it may end within a brick
    const float dx = fx + static_cast<float>(x), dy = fy + static_cast<float>(y),
                dz = fz + static_cast<float>(z);
    const float in = 1 - (dx * dx + dy * dy + dz * dz) * per_square;
    if (in <= 0) continue;
    const float weight = in * in;
    const int* at = halo.at(x, y, z);
    const int is = *at, off = std::abs(is - 32768);
    patch.weight[v] = weight;
    if (on_ramp(is)) {
      int bend = 0;
      for (const int step : Halo::kSteps)
        if (on_ramp(at[-step]) && on_ramp(at[step])) bend += at[-step] + at[step] - 2 * is;
      if (std::abs(bend) <= kRounding) bend = 0;
      patch.flow[v] = static_cast<float>(bend);
      // voxels on the plane move with the hand's side, but belong to both: to neither mean
      if (off < 16384 &&
          (!half.mirror.on() || 2 * (first[axis] + (v >> (3 * axis) & 7)) != half.mirror.twice)) {
        const float near = weight * (1 - static_cast<float>(off) / 16384);
        sums.flow += std::llround(kPerSum * near * static_cast<float>(bend));
        sums.weight += std::llround(kPerSum * near);
      }
    }
    patch.ramp[v] =
        off >= 16384 ? static_cast<float>(lack_of_ramp(at, flipped)) : lack_of_slope(at);
  }
}

// What becomes of a brick; nothing is written yet. True: anything to write.
bool Brush::move(Patch& patch, const Half& half, float share, float anew, float mean,
                 float most) const BURR_RT {
  const math::Ijk first = bone_.brick_ijk(patch.brick);
  KeptBrick& content = patch.content;
  content.brick = patch.brick;
  const Field* field = bone_.brick_field(patch.brick);
  if (field != nullptr) {
    std::memcpy(&content.field, field, sizeof content.field);
    std::memcpy(content.tissue, bone_.brick_tissue(patch.brick), sizeof content.tissue);
  } else {
    std::memset(&content.field, 0, sizeof content.field);
    std::memset(content.tissue, 0, sizeof content.tissue);
  }
  bool changed = false;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int is = content.field.voxel[v];
    const float moves = on_ramp(is) ? share * (patch.flow[v] - mean) : 0.0F;
    const float by = std::clamp(patch.weight[v] * (moves + anew * patch.ramp[v]), -most, most);
    const int to = std::clamp(is + static_cast<int>(std::lround(by)), 0, 65535);
    if (to == is) continue;
    changed = true;
    content.field.voxel[v] = static_cast<Field>(to);
    if (content.tissue[v] == 0)  // what grows into air is of what it grows from
      content.tissue[v] = grown_from(bone_, first.x() + (v & 7), first.y() + (v >> 3 & 7),
                                     first.z() + (v >> 6), half.is_image ? half.mirror.axis : -1);
  }
  return changed;
}

void Brush::smooth(const Brushing& now, std::uint32_t& flags) BURR_RT {
  begin(now.slices, flags);
  const double radius = kShare * now.radius;
  const Sides sides = sides_of(now.centre + now.radius * now.push, now.mirror);
  for (int side = 0; side < sides.count; ++side)
    find(sides, side, radius,
         [this](int bi, int bj, int bk) BURR_RT { return !is_flat_around(bi, bj, bk); });
  end_finding(now.mirror, flags);
  Sums sums[2];
  for (int n = 0; n < worked_; ++n) {
    Patch& patch = patches_[static_cast<std::size_t>(n)];
    look_at(patch, sides.centre[patch.side], radius, sides.half[patch.side], sums[patch.side]);
  }

  const double h = bone_.grid().voxel;
  const auto share =
      static_cast<float>(now.strength * std::min(kSpread * now.dt * slices_ / (h * h), kMostShare));
  const auto anew = static_cast<float>(now.strength * std::min(kAnew * slices_, 1.0));
  const auto most = static_cast<float>(units_a_tick(now));
  for (int n = 0; n < worked_; ++n) {
    Patch& patch = patches_[static_cast<std::size_t>(n)];
    const Sums& of = sums[patch.side];
    const auto mean = static_cast<float>(
        of.weight > 0 ? static_cast<double>(of.flow) / static_cast<double>(of.weight) : 0);
    if (!move(patch, sides.half[patch.side], share, anew, mean, most))
      patch.content.brick = volume::kNoBrick;
  }
  for (int n = 0; n < worked_; ++n) {
    Patch& patch = patches_[static_cast<std::size_t>(n)];
    if (patch.content.brick == volume::kNoBrick) continue;
    keep_other_layers(bone_, sides.half[patch.side].mirror.axis, patch.layers, patch.content);
    writer_.rewrite(patch.content, flags);
  }
}

}  // namespace burr::edit
