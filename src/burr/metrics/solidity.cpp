#include "burr/metrics/solidity.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/open_cavity.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Bone;
using volume::BrickIndex;
using volume::Field;

constexpr double kStep = 0.5;  // [voxel]

bool is_air(const Field* field) {
  return field == nullptr ||
         std::all_of(field, field + volume::kBrickVoxels, [](Field f) { return f == 0; });
}

int nearest(double x) { return static_cast<int>(std::floor(x + 0.5)); }

// The number of whole steps from `at` that stay in its brick, where bricks end half a voxel before
// their first voxel, along w. At least 1.
int steps_in_brick(const Vec3& at, const Vec3& w) {
  double left = 1e9;
  for (int a = 0; a < 3; ++a) {
    const double first = 8 * std::floor((at[a] + 0.5) / 8) - 0.5;
    if (w[a] > 1e-9) left = std::min(left, (first + 8 - at[a]) / w[a]);
    if (w[a] < -1e-9) left = std::min(left, (first - at[a]) / w[a]);
  }
  return std::max(1, static_cast<int>(std::floor(left / kStep)));
}

// Walks until step(p) says stop or the grid ends; the first point lies half a step behind `from`.
// may_skip(): what is air before and after need not be looked at.
template <class MaySkip, class Step>
void march(const Solidity& solidity, const Vec3& from, const Vec3& w, double reach,
           const MaySkip& may_skip, const Step& step) {
  const math::Ijk& size = solidity.grid().size;
  for (int n = 0;;) {
    const double l = (n + 0.5) * kStep;
    if (l > reach) return;
    const Vec3 p = from + l * w;
    for (int a = 0; a < 3; ++a)
      if (p[a] < -1 && w[a] <= 0) return;
    for (int a = 0; a < 3; ++a)
      if (p[a] > size[a] && w[a] >= 0) return;
    if (may_skip() && solidity.is_clear(nearest(p.x()), nearest(p.y()), nearest(p.z()))) {
      n += steps_in_brick(p, w);
      continue;
    }
    if (!step(p, l)) return;
    ++n;
  }
}

}  // namespace

bool same_grid(const Bone& a, const Bone& b) {
  const volume::Grid &u = a.grid(), &v = b.grid();
  return u.size == v.size && u.voxel == v.voxel && u.frame.p == v.frame.p &&
         u.frame.q.coeffs() == v.frame.q.coeffs();
}

Solidity::Solidity(const Bone& before, const Bone& after, const VoxelSet* seen,
                   std::span<const volume::TissueId> glass)
    : before_(before), after_(after), seen_(seen) {
  BURR_CHECK(same_grid(before, after));
  for (std::size_t id = 1; id < before.tissues().tissues.size() && id < hides_.size(); ++id)
    hides_[id] = before.tissues().tissues[id].kind == volume::TissueKind::soft;
  for (const volume::TissueId id : glass) hides_[id] = false;
  find_flags();
}

Solidity Solidity::of_bone(const Bone& before, const Bone& after) {
  std::vector<volume::TissueId> all(256);
  for (std::size_t id = 0; id < all.size(); ++id) all[id] = static_cast<volume::TissueId>(id);
  return {before, after, nullptr, all};
}

std::uint8_t Solidity::flags_of(BrickIndex b) const {
  const Field *was = before_.brick_field(b), *is = after_.brick_field(b);
  const volume::TissueId* tissue = before_.brick_tissue(b);
  const bool hidden =
      tissue != nullptr && std::any_of(tissue, tissue + volume::kBrickVoxels,
                                       [&](volume::TissueId t) { return hides_[t]; });
  const bool air = is_air(was) && is_air(is);
  const bool uncut = air || (was != nullptr && is != nullptr &&
                             std::memcmp(was, is, volume::kBrickVoxels * sizeof(Field)) == 0);
  const bool seen = seen_ != nullptr && seen_->count() > 0 && seen_->has_any_in(b);
  return static_cast<std::uint8_t>((air && !hidden ? kClear : 0) | (uncut ? kUncut : 0) |
                                   (seen ? 0 : kWithoutSeen));
}

void Solidity::find_flags() {
  const math::Ijk& bricks = before_.bricks();
  const auto count = static_cast<std::size_t>(before_.brick_count());
  std::vector<std::uint8_t> own(count);
  for (BrickIndex b = 0; b < before_.brick_count(); ++b)
    own[static_cast<std::size_t>(b)] = flags_of(b);
  // a point between voxels reads one voxel on either side
  flags_ = own;
  for (BrickIndex b = 0; b < before_.brick_count(); ++b) {
    const math::Ijk at = before_.brick_ijk(b) / volume::kBrickEdge;
    for (int k = std::max(0, at.z() - 1); k <= std::min(at.z() + 1, bricks.z() - 1); ++k)
      for (int j = std::max(0, at.y() - 1); j <= std::min(at.y() + 1, bricks.y() - 1); ++j)
        for (int i = std::max(0, at.x() - 1); i <= std::min(at.x() + 1, bricks.x() - 1); ++i)
          flags_[static_cast<std::size_t>(b)] &=
              own[static_cast<std::size_t>(before_.brick_at(i, j, k))];
  }
}

bool Solidity::is_clear(int i, int j, int k) const {
  if (!before_.grid().contains({i, j, k})) return false;
  return (flags_[static_cast<std::size_t>(before_.brick_at(i >> 3, j >> 3, k >> 3))] & kClear) != 0;
}

double Solidity::before(const Vec3& p_grid) const {
  return solidity_of(volume::sample(before_, p_grid));
}

double Solidity::after(const Vec3& p_grid) const {
  return solidity_of(volume::sample(after_, p_grid));
}

Solidity::Pair Solidity::at(const Vec3& p_grid) const {
  const int i = nearest(p_grid.x()), j = nearest(p_grid.y()), k = nearest(p_grid.z());
  std::uint8_t flags = 0;
  if (before_.grid().contains({i, j, k})) {
    flags = flags_[static_cast<std::size_t>(before_.brick_at(i >> 3, j >> 3, k >> 3))];
    const bool own = (flags & kWithoutSeen) == 0 && seen_->has(i, j, k);
    if (!own && hides_[before_.tissue(i, j, k)]) return {1, 1};
  }
  const double other = (flags & kWithoutSeen) != 0 ? 1 : 1 - share_of_seen(p_grid);
  const double was = other * before(p_grid);
  return {was, (flags & kUncut) != 0 ? was : other * after(p_grid)};
}

// 1 inside the structure, 0 outside, between the voxels of its border a steep ramp through 1/2 in
// the middle. Only where it lies in solid bone: in a canal of its own the field knows the border
// better than the labels do.
double Solidity::share_of_seen(const Vec3& p) const {
  if (seen_ == nullptr) return 0;
  const int i = static_cast<int>(std::floor(p.x())), j = static_cast<int>(std::floor(p.y())),
            k = static_cast<int>(std::floor(p.z()));
  double share = 0;
  for (int n = 0; n < 8; ++n) {
    const int x = i + (n & 1), y = j + ((n >> 1) & 1), z = k + (n >> 2);
    if (!seen_->has(x, y, z) || before_.field(x, y, z) < volume::kIso) continue;
    share += ((n & 1) != 0 ? p.x() - i : 1 - (p.x() - i)) *
             ((n & 2) != 0 ? p.y() - j : 1 - (p.y() - j)) *
             ((n & 4) != 0 ? p.z() - k : 1 - (p.z() - k));
  }
  return std::clamp(0.5 + 2 * (share - 0.5), 0.0, 1.0);
}

Met walk(const Solidity& solidity, const Vec3& from, const Vec3& w, const Vec3& n,
         const RaySettings& settings) {
  const double h = solidity.grid().voxel;
  Vec3 start = from;
  double least = solidity.at(from).after;
  for (int back = 1; back <= 2 && least > 0; ++back) {
    const Vec3 p = from - back * kStep * w;
    const double there = solidity.at(p).after;
    if (there >= least) break;
    least = there;
    start = p;
  }
  const double slant = std::max(0.5, math::dot(n, w));
  const double end = settings.most_bone / h, near_end = settings.near_reach / h;
  Met met;  // [voxel] until the end
  met.opened = settings.open == nullptr;
  bool under_bone = false;
  // air under bone that the cavity does not reach hides as bone does
  const auto may_skip = [&] { return met.opened || !under_bone; };
  const auto step = [&](const Vec3& p, double l) {
    const Solidity::Pair sigma = solidity.at(p);
    met.opened = met.opened || settings.open->has(p);
    met.bone += kStep * (may_skip() ? sigma.after : 1);
    under_bone = under_bone || sigma.after >= 0.5;
    met.removed += kStep * std::max(0.0, sigma.before - sigma.after);
    if (l <= near_end) met.near += kStep * sigma.before;
    return met.bone <= end;
  };
  march(solidity, start, w, std::numeric_limits<double>::infinity(), may_skip, step);
  return {met.bone * h, met.bone * slant * h, met.removed * h, met.near * h, met.opened};
}

bool is_blocked(const Solidity& solidity, const Vec3& from, const Vec3& w, double reach) {
  bool blocked = false;
  march(
      solidity, from, w, reach, [] { return true; },
      [&](const Vec3& p, double) {
        blocked = solidity.at(p).after >= 0.5;
        return !blocked;
      });
  return blocked;
}

}  // namespace burr::metrics
