#include "burr/edit/brush.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kBrickVoxels;

constexpr std::uint32_t kPutOff = 1U << 15;  // of haptics/contact.h, as in carve.cpp
constexpr int kMostTurns = Carver::kMostTurns;
constexpr int kAllBut = 4096;  // a quarter of a voxel of depth

Field clamped(float f) {
  return f <= 0 ? Field{0} : f >= 65535 ? volume::kSolid : static_cast<Field>(f + 0.5F);
}

// Towards the original by at most `most`, as far as the ball lets it. ball: first voxel less the
// middle, and its radius; inner: of what growing bone keeps out of. True: anything to write.
bool go_back(const KeptBrick& original, const float* ball, float inner, int most, KeptBrick& now) {
  constexpr auto kPerVoxel = static_cast<float>(volume::kFieldPerVoxel);
  bool changed = false;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int is = now.field.voxel[v], was = original.field.voxel[v];
    if (is == was && now.tissue[v] == original.tissue[v]) continue;
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

// As many turns as the bricks of the last tick need.
void Brush::begin(int least_turns, std::uint32_t& flags) BURR_RT {
  int turns = std::clamp(least_turns, 1, kMostTurns);
  while (turns < kMostTurns && found_ > turns * kMostBricks / 2) turns *= 2;
  if (turns != turns_) turn_ = 0;
  turns_ = turns;
  if (least_turns > 1) flags |= kPutOff;
  turn_ = (turn_ + 1) % turns_;
  found_ = worked_ = 0;
}

bool Brush::is_turn_of(int bi, int bj, int bk) const BURR_RT {
  return static_cast<unsigned>(bi + 3 * bj + 5 * bk) % static_cast<unsigned>(turns_) ==
         static_cast<unsigned>(turn_);
}

int Brush::units_a_tick(const Brushing& now) const BURR_RT {
  const double voxels = kSpeed * now.strength * now.dt * turns_ / bone_.grid().voxel;
  return static_cast<int>(std::clamp(std::ceil(voxels * volume::kFieldPerVoxel), 0.0, 65535.0));
}

void Brush::restore(const Brushing& now, std::uint32_t& flags) BURR_RT {
  begin(now.turns, flags);
  const int most = units_a_tick(now);
  const double reach = now.radius + kReach;
  const Box box = box_of(now.centre, reach);
  KeptBrick content;
  for (int bk = box.lo.z(); bk <= box.hi.z(); ++bk)
    for (int bj = box.lo.y(); bj <= box.hi.y(); ++bj)
      for (int bi = box.lo.x(); bi <= box.hi.x(); ++bi) {
        const BrickIndex brick = bone_.brick_at(bi, bj, bk);
        const KeptBrick* original = undo_.original_of(brick);
        const Field* field = original != nullptr ? bone_.brick_field(brick) : nullptr;
        if (field == nullptr) continue;
        const volume::TissueId* tissue = bone_.brick_tissue(brick);
        if (std::memcmp(field, &original->field, sizeof original->field) == 0 &&
            std::memcmp(tissue, original->tissue, sizeof original->tissue) == 0)
          continue;
        ++found_;
        if (!is_turn_of(bi, bj, bk) || worked_ == kMostBricks) continue;
        ++worked_;
        const Vec3 first = Vec3(kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk) - now.centre;
        const float ball[4] = {static_cast<float>(first.x()), static_cast<float>(first.y()),
                               static_cast<float>(first.z()), static_cast<float>(reach)};
        content.brick = brick;
        std::memcpy(&content.field, field, sizeof content.field);
        std::memcpy(content.tissue, tissue, sizeof content.tissue);
        if (go_back(*original, ball, static_cast<float>(now.radius - kInto), most, content))
          carver_.rewrite(content, flags);
      }
}

}  // namespace burr::edit
