#include "window/mill/structure_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burr::app {

using math::Vec3;
using volume::TissueId;

namespace {

// calls with (i, j, k, tissue) for each voxel of a brick that is labelled
template <class Does>
void each_voxel(const volume::Bone& bone, volume::BrickIndex brick, const Does& does) {
  const TissueId* tissue = bone.brick_tissue(brick);
  if (tissue == nullptr) return;
  const math::Ijk first = bone.brick_ijk(brick);
  for (int n = 0; n < volume::kBrickVoxels; ++n) {
    if (tissue[n] == 0) continue;
    const math::Ijk at = first + math::Ijk(n & 7, n >> 3 & 7, n >> 6);
    if (bone.grid().contains(at)) does(at, tissue[n]);
  }
}

}  // namespace

bool StructureMap::counts(const volume::Bone& bone, int i, int j, int k, TissueId id) {
  if (!bone.grid().contains({i, j, k}) || bone.tissue(i, j, k) != id) return false;
  return bone.tissues()[id].kind != volume::TissueKind::solid ||
         bone.field(i, j, k) >= volume::kIso;
}

void StructureMap::look_at(const volume::Bone& bone, volume::BrickIndex brick,
                           const std::vector<bool>& wanted) {
  each_voxel(bone, brick, [&](const math::Ijk& at, TissueId id) {
    if (!counts(bone, at.x(), at.y(), at.z(), id)) return;
    Part& part = parts_[id];
    ++part.voxels;
    part.sum += at.cast<double>();
    if (id >= wanted.size() || !wanted[id]) return;
    bool rim = false;
    for (int a = 0; a < 3 && !rim; ++a)
      for (const int way : {-1, 1}) {
        math::Ijk beside = at;
        beside[a] += way;
        rim = rim || !counts(bone, beside.x(), beside.y(), beside.z(), id);
      }
    if (!rim) return;
    const Vec3 place = at.cast<double>();
    // the voxels of a brick come one after another
    if (part.buckets.empty() ||
        (part.buckets.back().box.lo.cast<int>() / volume::kBrickEdge != at / volume::kBrickEdge))
      part.buckets.push_back({{place, place}, part.rim.size(), 0});
    Bucket& bucket = part.buckets.back();
    bucket.box.lo = bucket.box.lo.cwiseMin(place);
    bucket.box.hi = bucket.box.hi.cwiseMax(place);
    ++bucket.count;
    part.rim.push_back(place.cast<float>());
  });
}

void StructureMap::find_places(const volume::Bone& bone) {
  for (Part& part : parts_) part.apart = std::numeric_limits<float>::infinity();
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    each_voxel(bone, brick, [&](const math::Ijk& at, TissueId id) {
      Part& part = parts_[id];
      if (part.voxels == 0) return;
      const Vec3 mean = part.sum / static_cast<double>(part.voxels);
      const auto apart = static_cast<float>((at.cast<double>() - mean).squaredNorm());
      if (apart >= part.apart || !counts(bone, at.x(), at.y(), at.z(), id)) return;
      part.apart = apart;
      part.middle = at.cast<float>();
    });
}

StructureMap::StructureMap(const volume::Bone& bone, const std::vector<bool>& wanted)
    : bone_(bone), grid_(bone.grid()) {
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    look_at(bone, brick, wanted);
  find_places(bone);
}

std::optional<Vec3> StructureMap::place(TissueId id) const {
  const Part& part = parts_[id];
  if (part.voxels == 0) return std::nullopt;
  return grid_.world_from_grid(part.middle.cast<double>());
}

std::optional<double> StructureMap::distance(TissueId id, const Vec3& p) const {
  const Part& part = parts_[id];
  if (part.rim.empty()) return std::nullopt;
  const Vec3 at = grid_.grid_from_world(p);
  const math::Ijk in = at.array().round().cast<int>();
  if (grid_.contains(in) && bone_.shared_tissue(in.x(), in.y(), in.z()) == id &&
      bone_.tissues()[id].kind != volume::TissueKind::solid)
    return -0.5 * grid_.voxel;
  double least = std::numeric_limits<double>::infinity();
  for (const Bucket& bucket : part.buckets) {
    const Vec3 beyond = (bucket.box.lo - at).cwiseMax(at - bucket.box.hi).cwiseMax(Vec3::Zero());
    if (beyond.squaredNorm() >= least) continue;
    for (std::size_t n = bucket.first; n < bucket.first + bucket.count; ++n)
      least = std::min(least, (part.rim[n].cast<double>() - at).squaredNorm());
  }
  return (std::sqrt(least) - 0.5) * grid_.voxel;
}

}  // namespace burr::app
