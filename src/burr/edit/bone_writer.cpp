#include "burr/edit/bone_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "burr/math/sums.h"
#include "burr/rt/flags.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {

using math::Vec3;
using volume::BrickField;
using volume::BrickIndex;
using volume::kBrickVoxels;

BoneWriter::BoneWriter(volume::Bone& bone, volume::IsoVertices& surface, UndoStore& undo,
                       ChangedQueue* changed, Known known)
    : bone_(bone), surface_(surface), undo_(undo), changed_(changed), known_(std::move(known)) {
  const double h = bone.grid().voxel;
  unit_m3_ = h * h * h / static_cast<double>(volume::kVoxelUnits);
  const auto bricks = static_cast<std::size_t>(bone.brick_count());
  if (known_.highest.size() == bricks) return;
  known_.highest.assign(bricks, 0);
  known_.uniform.assign(bricks, 0);
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const volume::Field* field = bone.brick_field(b);
    if (field == nullptr) continue;
    known_.highest[static_cast<std::size_t>(b)] = *std::max_element(field, field + kBrickVoxels);
    const volume::TissueId* tissue = bone.brick_tissue(b);
    int one = -1;
    for (int v = 0; v < kBrickVoxels; ++v)
      if (field[v] != 0) one = one < 0 || one == tissue[v] ? tissue[v] : kMixed;
    known_.uniform[static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(std::max(one, 0));
  }
}

bool BoneWriter::make_room(BrickIndex brick, std::uint32_t& flags) BURR_RT {
  if (bone_.ensure_slot(brick) != volume::kNoSlot) return true;
  flags |= rt::kFlagReserve;
  return false;
}

void BoneWriter::write(BrickIndex brick, const BrickField& now) BURR_RT {
  bone_.write_brick(brick, now);
  if (changed_ != nullptr) changed_->push(brick);
  if (watch_ != nullptr) watch_->push(brick);
}

void BoneWriter::write_applied(BrickIndex brick, const BrickField& now,
                               const Applied& applied) BURR_RT {
  write(brick, now);
  known_.highest[static_cast<std::size_t>(brick)] = static_cast<std::uint16_t>(applied.highest);
  surface_.changed(brick, applied.most, applied.rows, applied.columns);
}

void BoneWriter::write_less(BrickIndex brick, const BrickField& now, const Applied& applied,
                            std::uint32_t& flags) BURR_RT {
  const Count count(*this);
  if (undo_.keep(brick)) flags |= rt::kFlagUndoFull;
  write_applied(brick, now, applied);
}

void BoneWriter::write_more(BrickIndex brick, const BrickField& now, const Applied& applied,
                            volume::TissueId material, std::uint32_t& flags) BURR_RT {
  const Count count(*this);
  if (undo_.keep(brick)) flags |= rt::kFlagUndoFull;
  const volume::Field* field = bone_.brick_field(brick);
  const math::Ijk first = bone_.brick_ijk(brick);
  for (int v = 0; v < kBrickVoxels; ++v)
    if (now.voxel[v] != field[v] && field[v] < volume::kIso / 2)
      bone_.set_tissue(first.x() + (v & 7), first.y() + (v >> 3 & 7), first.z() + (v >> 6),
                       material);
  std::uint8_t& one = known_.uniform[static_cast<std::size_t>(brick)];
  one = highest(brick) == 0 || one == material ? material : kMixed;
  write_applied(brick, now, applied);
}

// The change of a whole brick, found by comparing it with what was there.
void BoneWriter::note_whole(BrickIndex brick, const BrickField& before,
                            const BrickField& now) BURR_RT {
  int most = 0, highest = 0;
  std::uint64_t rows = 0;
  unsigned columns = 0;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int change = std::abs(int{now.voxel[v]} - int{before.voxel[v]});
    highest = std::max(highest, int{now.voxel[v]});
    if (change == 0) continue;
    most = std::max(most, change);
    rows |= 1ULL << (v >> 3);
    columns |= 1U << (v & 7);
  }
  known_.highest[static_cast<std::size_t>(brick)] = static_cast<std::uint16_t>(highest);
  if (most > 0) surface_.changed(brick, most, rows, columns);
}

void BoneWriter::restore(const KeptBrick& kept) BURR_RT {
  const Count count(*this);
  if (bone_.ensure_slot(kept.brick) == volume::kNoSlot)
    return;  // cannot happen: the brick had a slot when it was kept
  BrickField before;
  std::memcpy(&before, bone_.brick_field(kept.brick), sizeof before);
  const math::Ijk first = bone_.brick_ijk(kept.brick);
  const volume::TissueId* tissue = bone_.brick_tissue(kept.brick);
  bool same_tissue = true;
  for (int v = 0; v < kBrickVoxels; ++v)
    if (tissue[v] != kept.tissue[v]) {
      same_tissue = false;
      bone_.set_tissue(first.x() + (v & 7), first.y() + (v >> 3 & 7), first.z() + (v >> 6),
                       kept.tissue[v]);
    }
  if (!same_tissue) known_.uniform[static_cast<std::size_t>(kept.brick)] = kMixed;
  write(kept.brick, kept.field);
  note_whole(kept.brick, before, kept.field);
}

void BoneWriter::rewrite(const KeptBrick& now, std::uint32_t& flags) BURR_RT {
  if (!make_room(now.brick, flags)) return;
  if (undo_.keep(now.brick)) flags |= rt::kFlagUndoFull;
  const volume::Field* field = bone_.brick_field(now.brick);
  std::int64_t gone = 0;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const int before = field[v], after = now.field.voxel[v];
    if (before == after) continue;
    const std::int64_t by = volume::volume_units(after) - volume::volume_units(before);
    (after < before ? gone : account_.added) += after < before ? -by : by;
  }
  account_.removed += gone;
  account_.asked += static_cast<double>(gone);
  restore(now);
}

void BoneWriter::put(const KeptBrick& now, std::uint32_t& flags) BURR_RT {
  if (!make_room(now.brick, flags)) return;
  if (undo_.keep(now.brick)) flags |= rt::kFlagUndoFull;
  restore(now);
}

void BoneWriter::swap(KeptBrick& kept) BURR_RT {
  KeptBrick now;
  now.brick = kept.brick;
  const volume::Field* field = bone_.brick_field(kept.brick);
  if (field == nullptr) return;
  std::memcpy(&now.field, field, sizeof now.field);
  std::memcpy(now.tissue, bone_.brick_tissue(kept.brick), sizeof now.tissue);
  restore(kept);
  kept = now;
}

bool BoneWriter::clear_of(const KeptBrick& kept, const Vec3& centre, double radius) const BURR_RT {
  const Vec3 first = bone_.brick_ijk(kept.brick).cast<double>();
  for (int v = 0; v < kBrickVoxels; ++v) {
    if (kept.field.voxel[v] < volume::kIso / 2) continue;
    const Vec3 p = first + Vec3(v & 7, v >> 3 & 7, v >> 6);
    if (math::squared_norm(p - centre) < (radius + 1) * (radius + 1)) return false;
  }
  return true;
}

}  // namespace burr::edit
