#include "burr/volume/shared_copy.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace burr::volume {
namespace {

constexpr int kTries = 1 << 20;  // for one brick while its writer is writing it
constexpr int kLooks = 100'000;  // passes; a tick changes far less than a pass copies

struct Content {
  BrickField field = {};
  std::array<TissueId, kBrickVoxels> tissue = {};
};

bool copy(const Bone& bone, BrickIndex brick, Content& out) {
  for (int n = 0; n < kTries; ++n) {
    if (!bone.copy_brick(brick, out.field)) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    for (int v = 0; v < kBrickVoxels; ++v)
      out.tissue[static_cast<std::size_t>(v)] =
          bone.shared_tissue(first.x() + (v & 7), first.y() + ((v >> 3) & 7), first.z() + (v >> 6));
    return true;
  }
  return false;
}

bool empty(const Content& content) {
  return std::all_of(std::begin(content.field.voxel), std::end(content.field.voxel),
                     [](Field value) { return value == 0; }) &&
         std::all_of(content.tissue.begin(), content.tissue.end(),
                     [](TissueId tissue) { return tissue == 0; });
}

bool all_solid(const Content& content) {
  return std::all_of(std::begin(content.field.voxel), std::end(content.field.voxel),
                     [](Field value) { return value == kSolid; }) &&
         std::all_of(content.tissue.begin(), content.tissue.end(),
                     [&](TissueId tissue) { return tissue == content.tissue.front(); });
}

}  // namespace

Result<std::unique_ptr<Bone>> shared_copy(const Bone& bone, rt::ChangedBits& changed,
                                          Progress& progress) {
  const Error too_fast =
      error("the bone changes faster than it can be copied; lift the burr and try again");
  const Error stopped = error(Trouble::interrupted, "stopped");
  std::map<BrickIndex, Content> mixed;
  std::map<BrickIndex, TissueId> solid;
  const auto keep = [&](BrickIndex brick, const Content& content) {
    mixed.erase(brick);
    solid.erase(brick);
    if (empty(content)) return;  // air may carry a label
    if (all_solid(content))
      solid[brick] = content.tissue.front();
    else
      mixed[brick] = content;
  };

  // changes before this moment are in the first copy
  changed.take_all([](std::size_t) {});
  Content content;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    if (brick % 4096 == 0) {
      if (progress.cancelled()) return stopped;
      progress.report(static_cast<double>(brick) / bone.brick_count(), "copying the bone");
    }
    if (!copy(bone, brick, content)) return too_fast;
    keep(brick, content);
  }
  bool rests = false;
  for (int n = 0; n < kLooks && !rests; ++n) {
    rests = true;
    bool copied = true;
    changed.take_all([&](std::size_t brick) {
      rests = false;
      copied = copied && copy(bone, static_cast<BrickIndex>(brick), content);
      if (copied) keep(static_cast<BrickIndex>(brick), content);
    });
    if (!copied) return too_fast;
    if (progress.cancelled()) return stopped;
  }
  if (!rests) return too_fast;

  auto whole =
      std::make_unique<Bone>(bone.grid(), bone.tissues(), mixed.size() + solid.size(), 0, false);
  for (const auto& [brick, one] : mixed)
    whole->build_brick(brick, one.field.voxel, one.tissue.data());
  std::fill(std::begin(content.field.voxel), std::end(content.field.voxel), kSolid);
  for (const auto& [brick, tissue] : solid) {
    content.tissue.fill(tissue);
    whole->build_brick(brick, content.field.voxel, content.tissue.data());
  }
  whole->pack();
  return whole;
}

}  // namespace burr::volume
