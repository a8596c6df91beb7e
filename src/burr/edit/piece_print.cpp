#include "burr/edit/piece_print.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include "burr/base/hash.h"
#include "burr/math/pose.h"
#include "burr/volume/volume_of.h"

namespace burr::edit::piece_print {
namespace {

using math::Ijk;
using math::Quat;
using math::Vec3;
using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kBrickVoxels;
using volume::TissueId;

int in_brick(const Ijk& voxel) {
  return (voxel.x() & 7) + kBrickEdge * ((voxel.y() & 7) + kBrickEdge * (voxel.z() & 7));
}
BrickIndex brick_of(const Bone& bone, const Ijk& voxel) {
  return bone.brick_at(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
}

void read(const Bone& bone, BrickIndex brick, KeptBrick& to) {
  to.brick = brick;
  const Field* const field = bone.brick_field(brick);
  const TissueId* const tissue = bone.brick_tissue(brick);
  if (field != nullptr)
    std::memcpy(&to.field, field, sizeof to.field);
  else
    std::memset(&to.field, 0, sizeof to.field);
  if (field != nullptr && tissue != nullptr)
    std::memcpy(to.tissue, tissue, sizeof to.tissue);
  else
    std::memset(to.tissue, 0, sizeof to.tissue);
}

std::uint64_t hash_of(const std::vector<KeptBrick>& bricks) {
  std::uint64_t hash = base::mix(0, static_cast<std::uint64_t>(bricks.size()));
  std::uint64_t words[volume::kBrickWords];
  for (const KeptBrick& brick : bricks) {
    hash = base::mix(hash, static_cast<std::uint64_t>(brick.brick));
    std::memcpy(words, &brick.field, sizeof words);
    hash = base::mix(hash, words);
    std::memcpy(words, brick.tissue, kBrickVoxels);
    hash = base::mix(hash, std::span<const std::uint64_t>(words, kBrickVoxels / 8));
  }
  return hash;
}

// Rows of the rotation of a unit quaternion x, y, z, w, by plain sums and products.
std::array<Vec3, 3> rows_of(const Quat& q) {
  const double x = q.x(), y = q.y(), z = q.z(), w = q.w();
  return {Vec3(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
          Vec3(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
          Vec3(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y))};
}
double dot(const Vec3& a, const Vec3& b) { return a.x() * b.x() + a.y() * b.y() + a.z() * b.z(); }
Vec3 times(const std::array<Vec3, 3>& rows, const Vec3& v) {
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

struct Sampled {
  int field = 0;
  TissueId tissue = 0;
};

// Trilinear; the tissue is that of the heaviest voxel that holds something.
Sampled sample(const Bone& bone, const Vec3& p) {
  const Ijk at(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
               static_cast<int>(std::floor(p.z())));
  const double fx = p.x() - at.x(), fy = p.y() - at.y(), fz = p.z() - at.z();
  double sum = 0, heaviest = -1;
  Sampled out;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const Field field = bone.field(at.x() + i, at.y() + j, at.z() + k);
    if (field == 0) continue;
    const double weight = (i != 0 ? fx : 1 - fx) * (j != 0 ? fy : 1 - fy) * (k != 0 ? fz : 1 - fz);
    sum += weight * field;
    if (weight <= heaviest) continue;
    heaviest = weight;
    out.tissue = bone.tissue(at.x() + i, at.y() + j, at.z() + k);
  }
  out.field = static_cast<int>(sum + 0.5);
  return out;
}

}  // namespace

KeptBrick& Work::at(BrickIndex brick) {
  const auto [found, fresh] = bricks_.try_emplace(brick);
  if (fresh) {
    found->second = std::make_unique<KeptBrick>();
    read(bone_, brick, *found->second);
  }
  return *found->second;
}

Vec3 Way::source(const Vec3& p) const { return from + times(back, p - goal); }

Result<Way> way_of(const volume::Grid& grid, const Vec3& centre, const Ijk& low, const Ijk& high,
                   const PieceMove& move) {
  const Quat turn(move.turn[3], move.turn[0], move.turn[1], move.turn[2]);
  if (!(std::abs(turn.norm() - 1) < 1e-6))
    return error(Trouble::usage, "the turn of the piece is not a rotation");
  const std::array<Vec3, 3> axes = rows_of(grid.frame.q), turned = rows_of(turn);
  const auto axis = [&axes](int n) { return Vec3(axes[0][n], axes[1][n], axes[2][n]); };
  Way way;
  std::array<Vec3, 3> rotation;  // grid from grid: axes^T turned axes
  for (int column = 0; column < 3; ++column) {
    const Vec3 world = times(turned, axis(column));
    for (int row = 0; row < 3; ++row) {
      const double value = dot(axis(row), world);
      rotation[static_cast<std::size_t>(row)][column] = value;
      way.back[static_cast<std::size_t>(column)][row] = value;
    }
  }
  const Vec3 by(move.by[0], move.by[1], move.by[2]);
  Vec3 shift;
  for (int row = 0; row < 3; ++row) {
    shift[row] = dot(axis(row), by) / grid.voxel;
    // a whole number of voxels stays one
    if (std::abs(shift[row] - std::round(shift[row])) < 1e-9) shift[row] = std::round(shift[row]);
  }
  if (!shift.allFinite()) return error(Trouble::usage, "the way of the piece is not finite");
  way.from = centre;
  way.goal = centre + shift;
  way.lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  way.hi = -way.lo;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? high.x() + 1.0 : low.x() - 1.0,
                 (corner & 2) != 0 ? high.y() + 1.0 : low.y() - 1.0,
                 (corner & 4) != 0 ? high.z() + 1.0 : low.z() - 1.0);
    const Vec3 there = way.goal + times(rotation, p - centre);
    way.lo = way.lo.cwiseMin(there);
    way.hi = way.hi.cwiseMax(there);
  }
  constexpr double kMost = 1e6;
  if (way.lo.minCoeff() < -kMost || way.hi.maxCoeff() > kMost)
    return error(Trouble::usage, "the piece would leave the volume; move it less");
  return way;
}

bool lay(const Bone& piece, const Way& way, const Bone& bone, Work& work,
         std::vector<Print>& prints, std::int64_t& overlap) {
  std::map<BrickIndex, std::unique_ptr<Print>> made;
  bool inside = true;
  const Ijk lo(static_cast<int>(std::floor(way.lo.x())), static_cast<int>(std::floor(way.lo.y())),
               static_cast<int>(std::floor(way.lo.z()))),
      hi(static_cast<int>(std::ceil(way.hi.x())), static_cast<int>(std::ceil(way.hi.y())),
         static_cast<int>(std::ceil(way.hi.z())));
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const Sampled put = sample(piece, way.source(Vec3(i, j, k)));
        if (put.field == 0) continue;
        const Ijk at(i, j, k);
        if (!bone.grid().contains(at)) {
          inside = inside && put.field < volume::kIso;
          continue;
        }
        const BrickIndex brick = brick_of(bone, at);
        std::unique_ptr<Print>& print = made[brick];
        KeptBrick& now = work.at(brick);
        if (print == nullptr) {
          print = std::make_unique<Print>();
          print->brick = brick;
          std::memset(print->put, 0, sizeof print->put);
          std::memset(print->tissue, 0, sizeof print->tissue);
          std::memcpy(print->under, now.field.voxel, sizeof print->under);
          std::memcpy(print->under_tissue, now.tissue, sizeof print->under_tissue);
        }
        const int v = in_brick(at);
        print->put[v] = static_cast<Field>(put.field);
        print->tissue[v] = put.tissue;
        overlap += volume::volume_units(std::min(put.field, int{now.field.voxel[v]}));
        if (put.field <= now.field.voxel[v]) continue;
        now.field.voxel[v] = static_cast<Field>(put.field);
        now.tissue[v] = put.tissue;
      }
  for (const auto& [brick, print] : made) prints.push_back(*print);
  return inside;
}

void find_changed(const Bone& bone, const Work& work, MovedBricks& bricks) {
  KeptBrick before;
  for (const auto& [brick, now] : work.all()) {
    read(bone, brick, before);
    if (std::memcmp(&before.field, &now->field, sizeof before.field) == 0 &&
        std::memcmp(before.tissue, now->tissue, sizeof before.tissue) == 0)
      continue;
    bricks.lost +=
        volume::volume_units(before.field.voxel) - volume::volume_units(now->field.voxel);
    bricks.bricks.push_back(*now);
  }
  bricks.hash = hash_of(bricks.bricks);
}

bool lies_there(const Bone& bone, const Print& print) {
  KeptBrick now;
  read(bone, print.brick, now);
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (print.put[v] == 0) continue;
    if (now.field.voxel[v] != std::max(print.put[v], print.under[v])) return false;
    if (now.tissue[v] != (print.put[v] > print.under[v] ? print.tissue : print.under_tissue)[v])
      return false;
  }
  return true;
}

void take_out(const std::vector<Print>& prints, Work& work) {
  for (const Print& print : prints) {
    KeptBrick& brick = work.at(print.brick);
    for (int v = 0; v < kBrickVoxels; ++v) {
      if (print.put[v] == 0) continue;
      brick.field.voxel[v] = print.under[v];
      brick.tissue[v] = print.under_tissue[v];
    }
  }
}

}  // namespace burr::edit::piece_print
