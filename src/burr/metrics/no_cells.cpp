#include "burr/metrics/no_cells.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "burr/base/check.h"
#include "burr/metrics/distance_map.h"
#include "burr/metrics/identified.h"
#include "burr/metrics/look_directions.h"
#include "burr/metrics/solidity.h"
#include "burr/rt/thread.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;
using volume::Field;

// Of the share of the walls that stands: twice what was measured on foam of known shape.
constexpr double kLeftError = 0.06;

Field field_at(const Bone& bone, const Ijk& v) { return bone.field(v.x(), v.y(), v.z()); }

// The voxels of the zone, brick by brick.
std::vector<Ijk> zone_of(const Bone& bone, const volume::DistanceTo& x, const Region& region,
                         const NoCellsSettings& settings) {
  const volume::Grid& grid = bone.grid();
  const double across = 7.0 * grid.voxel;  // more than from a brick's middle to any of its voxels
  // beyond the reach there is no distance, which says nothing about a brick that reaches back into it
  const bool far_reach = x.reach() >= settings.d + across;
  std::vector<Ijk> zone;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const Ijk first = bone.brick_ijk(brick);
    const Vec3 middle = grid.world_from_grid(first.cast<double>() + Vec3::Constant(3.5));
    const double to_middle = x.at(middle).distance;
    if ((far_reach || std::isfinite(to_middle)) && to_middle > settings.d + across) continue;
    if (depth_in(region, middle) < -across) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const Ijk at = first + Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (!grid.contains(at)) continue;
      const Vec3 place = grid.world_from_grid(at.cast<double>());
      const double far = x.at(place).distance;
      if (far > settings.hi && far <= settings.d && contains(region, place)) zone.push_back(at);
    }
  }
  return zone;
}

VoxelBox box_around(const std::vector<Ijk>& voxels, int margin, const Ijk& size) {
  Ijk lo = voxels.front(), hi = voxels.front();
  for (const Ijk& v : voxels) {
    lo = lo.cwiseMin(v);
    hi = hi.cwiseMax(v);
  }
  lo = (lo.array() - margin).max(0);
  hi = (hi.array() + margin).min(size.array() - 1);
  return {lo, hi - lo + Ijk::Ones()};
}

// For each voxel of the box: the ball, anywhere inside the solid, covers it.
std::vector<std::uint8_t> opening(const Bone& bone, const VoxelBox& box, double radius,
                                  int threads) {
  const double r = radius / bone.grid().voxel;
  std::vector<std::uint8_t> set(box.count());
  for (std::size_t n = 0; n < set.size(); ++n)
    set[n] = field_at(bone, box.first + box.at(n)) < volume::kIso;
  // the surface lies half a voxel before the first voxel of air
  std::vector<std::int32_t> square = squared_distances(box, set, threads);
  for (std::size_t n = 0; n < set.size(); ++n) set[n] = square[n] >= (r + 0.5) * (r + 0.5);
  square = squared_distances(box, set, threads);
  for (std::size_t n = 0; n < set.size(); ++n) set[n] = square[n] <= (r + 0.5) * (r + 0.5);
  return set;
}

// Every n-th, so that at most `most` remain.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (all.size() + most - 1) / most);
  std::vector<T> few;
  for (std::size_t n = 0; n < all.size(); n += step) few.push_back(all[n]);
  return few;
}

struct Walls {
  std::int64_t before = 0, after = 0;  // volume_units
  std::vector<Vec3> standing;
};

Walls walls_in(const Bone& before, const Bone& after, const std::vector<Ijk>& zone,
               const NoCellsSettings& settings) {
  const double h = before.grid().voxel;
  const int margin = static_cast<int>(std::ceil(2 * settings.ball / h)) + 2;
  const VoxelBox box = box_around(zone, margin, before.grid().size);
  const std::vector<std::uint8_t> thick = opening(before, box, settings.ball, settings.threads);
  Walls walls;
  for (const Ijk& v : zone) {
    const Field was = field_at(before, v);
    if (was < volume::kIso || thick[box.index(v - box.first)] != 0) continue;
    const Field is = std::min(was, field_at(after, v));
    walls.before += volume::volume_units(std::int32_t{was});
    walls.after += std::max(0, volume::volume_units(std::int32_t{is}));
    if (is >= volume::kIso)
      walls.standing.push_back(before.grid().world_from_grid(v.cast<double>()));
  }
  return walls;
}

std::string too_short(double reach, double d) {
  std::array<char, 160> text = {};
  std::snprintf(
      text.data(), text.size(),
      "the distance to the structure is known up to %.2f mm only; this zone needs %.2f mm",
      reach * 1e3, d * 1e3);
  return text.data();
}

bool is_seen(const Solidity& solidity, const std::vector<Vec3>& looks, const Ijk& v) {
  return std::any_of(looks.begin(), looks.end(), [&](const Vec3& w) {
    return !is_blocked(solidity, v.cast<double>(), w, std::numeric_limits<double>::infinity());
  });
}

// Of these voxels, those that no look reaches.
std::vector<Ijk> shut_of(const Bone& before, const Bone& after, const std::vector<Ijk>& air,
                         const NoCellsSettings& settings) {
  const Solidity solidity(before, after, nullptr, settings.glass);
  std::vector<Vec3> looks = cones_about(settings.towards);
  for (Vec3& w : looks) w = before.grid().frame.q.conjugate() * w;
  std::vector<std::uint8_t> seen(air.size(), 0);
  std::atomic<std::size_t> next{0};
  rt::on_threads(std::max(1, settings.threads), [&](int) {
    for (std::size_t n = next++; n < air.size(); n = next++)
      seen[n] = is_seen(solidity, looks, air[n]);
  });
  std::vector<Ijk> shut;
  for (std::size_t n = 0; n < air.size(); ++n)
    if (seen[n] == 0) shut.push_back(air[n]);
  return shut;
}

std::vector<Ijk> air_of(const Bone& bone, const std::vector<Ijk>& zone) {
  std::vector<Ijk> air;
  for (const Ijk& v : zone)
    if (field_at(bone, v) < volume::kIso &&
        bone.tissues()[bone.tissue(v.x(), v.y(), v.z())].kind != volume::TissueKind::soft)
      air.push_back(v);
  return air;
}

}  // namespace

Assessed<NoCells> no_cells(const Bone& before, const Bone& after, const volume::DistanceTo& x,
                           const Region& region, const NoCellsSettings& settings) {
  BURR_CHECK(same_grid(before, after) && !settings.towards.empty());
  const double h = before.grid().voxel, voxel = h * h * h;
  if (std::string reason = too_coarse(h, settings.ball / 1.5); !reason.empty())
    return NotAssessable{std::move(reason)};
  if (x.empty()) return NotAssessable{"the structure is not in this bone: no voxel has its label"};
  if (x.reach() < settings.d) return NotAssessable{too_short(x.reach(), settings.d)};
  const std::vector<Ijk> zone = zone_of(before, x, region, settings);
  const std::vector<Ijk> air = air_of(before, zone);
  NoCells out;
  out.air = static_cast<double>(air.size()) * voxel;
  if (out.air < settings.least_air)
    return NotAssessable{
        "hardly any air lay in this zone before the first cut: bone without cells"};
  const Walls walls = walls_in(before, after, zone, settings);
  if (walls.before == 0) return NotAssessable{"no walls of cells lie in this zone"};
  out.walls = static_cast<double>(walls.before) * voxel / static_cast<double>(volume::kVoxelUnits);
  out.standing = thinned(walls.standing, kMostShown);
  const double left = static_cast<double>(walls.after) / static_cast<double>(walls.before);
  out.left = {left <= settings.most_left, true, left, settings.most_left, kLeftError};

  const std::vector<Ijk> few = thinned(air, kMostShown);
  for (const Ijk& v : shut_of(before, after, few, settings))
    out.hidden.push_back(before.grid().world_from_grid(v.cast<double>()));
  const auto count = static_cast<double>(few.size());
  const double shut = static_cast<double>(out.hidden.size()) / count;
  out.shut = {shut <= settings.most_shut, true, shut, settings.most_shut,
              2 * std::sqrt(std::max(shut * (1 - shut), 1 / count) / count)};
  out.met = out.left.met && out.shut.met;
  return out;
}

}  // namespace burr::metrics
