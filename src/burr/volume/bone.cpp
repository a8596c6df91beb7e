#include "burr/volume/bone.h"

#include <algorithm>
#include <cstring>

#include "burr/base/check.h"
#include "burr/base/hash.h"

namespace burr::volume {
namespace {

std::size_t at(std::int32_t slot) { return static_cast<std::size_t>(slot) * kBrickVoxels; }

std::size_t inside_brick(int i, int j, int k) {
  return static_cast<std::size_t>((i & 7) + 8 * ((j & 7) + 8 * (k & 7)));
}

}  // namespace

Bone::Bone(const Grid& grid, TissueTable tissues, std::size_t capacity_bricks,
           std::size_t reserve_bricks, bool with_intensity)
    : grid_(grid),
      tissues_(std::move(tissues)),
      bricks_((grid.size.array() + kBrickEdge - 1) / kBrickEdge),
      brick_count_(bricks_.prod()),
      capacity_(std::min(capacity_bricks + reserve_bricks, static_cast<std::size_t>(brick_count_))),
      directory_(
          std::make_unique<std::atomic<std::int32_t>[]>(static_cast<std::size_t>(brick_count_))),
      versions_(std::make_unique<rt::Version[]>(capacity_)),
      field_(capacity_ * kBrickVoxels),  // zeroed, so the pages are there before the first tick
      tissue_(capacity_ * kBrickVoxels),
      intensity_(with_intensity ? capacity_ * kBrickVoxels : 0) {
  BURR_CHECK(grid.size.minCoeff() > 0 && grid.voxel > 0);
  for (BrickIndex b = 0; b < brick_count_; ++b) directory_[static_cast<std::size_t>(b)] = kNoSlot;
}

std::int32_t Bone::slot_of(int i, int j, int k) const BURR_RT {
  if (!grid_.contains({i, j, k})) return kNoSlot;
  const BrickIndex brick = brick_at(i >> 3, j >> 3, k >> 3);
  return directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
}

Field Bone::field(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = slot_of(i, j, k);
  return slot == kNoSlot ? Field{0} : field_[at(slot) + inside_brick(i, j, k)];
}

TissueId Bone::tissue(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = slot_of(i, j, k);
  return slot == kNoSlot ? TissueId{0} : tissue_[at(slot) + inside_brick(i, j, k)];
}

std::int16_t Bone::intensity(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = slot_of(i, j, k);
  return slot == kNoSlot || intensity_.empty() ? std::int16_t{-1024}
                                               : intensity_[at(slot) + inside_brick(i, j, k)];
}

const TissueId* Bone::brick_tissue(BrickIndex brick) const BURR_RT {
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
  return slot == kNoSlot ? nullptr : tissue_.data() + at(slot);
}

const std::int16_t* Bone::brick_intensity(BrickIndex brick) const BURR_RT {
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
  return slot == kNoSlot || intensity_.empty() ? nullptr : intensity_.data() + at(slot);
}

bool Bone::copy_brick(BrickIndex brick, BrickField& out) const BURR_RT {
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_acquire);
  if (slot == kNoSlot) {
    std::memset(&out, 0, sizeof out);
    return true;
  }
  return rt::versioned_read(versions_[static_cast<std::size_t>(slot)],
                            reinterpret_cast<const std::uint64_t*>(field_.data() + at(slot)),
                            reinterpret_cast<std::uint64_t*>(&out), kBrickWords);
}

TissueId Bone::shared_tissue(int i, int j, int k) const BURR_RT {
  if (!grid_.contains({i, j, k})) return 0;
  const BrickIndex brick = brick_at(i >> 3, j >> 3, k >> 3);
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_acquire);
  if (slot == kNoSlot) return 0;
  // atomic_ref wants a non-const object; it is only read
  auto& voxel = const_cast<TissueId&>(tissue_[at(slot) + inside_brick(i, j, k)]);
  return std::atomic_ref<TissueId>(voxel).load(std::memory_order_relaxed);
}

rt::ChangedBits& Bone::add_watcher() {
  watchers_.push_back(std::make_unique<rt::ChangedBits>(static_cast<std::size_t>(brick_count_)));
  return *watchers_.back();
}

std::int32_t Bone::ensure_slot(BrickIndex brick) BURR_RT {
  std::atomic<std::int32_t>& entry = directory_[static_cast<std::size_t>(brick)];
  const std::int32_t slot = entry.load(std::memory_order_relaxed);
  if (slot != kNoSlot) return slot;
  if (used_ == capacity_) return kNoSlot;
  const auto fresh = static_cast<std::int32_t>(used_++);
  entry.store(fresh, std::memory_order_release);  // readers that see the slot see its zeros
  return fresh;
}

void Bone::write_brick(BrickIndex brick, const BrickField& content) BURR_RT {
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
  BURR_CHECK(slot != kNoSlot);
  rt::versioned_write(versions_[static_cast<std::size_t>(slot)],
                      reinterpret_cast<std::uint64_t*>(field_.data() + at(slot)),
                      reinterpret_cast<const std::uint64_t*>(&content), kBrickWords);
  for (const auto& watcher : watchers_) watcher->mark(static_cast<std::size_t>(brick));
}

void Bone::set_tissue(int i, int j, int k, TissueId tissue) BURR_RT {
  const std::int32_t slot = slot_of(i, j, k);
  BURR_CHECK(slot != kNoSlot);
  std::atomic_ref<TissueId>(tissue_[at(slot) + inside_brick(i, j, k)])
      .store(tissue, std::memory_order_relaxed);
}

Field* Bone::build_field(BrickIndex brick) {
  const std::int32_t slot = ensure_slot(brick);
  BURR_CHECK(slot != kNoSlot);
  return field_.data() + at(slot);
}

TissueId* Bone::build_tissue(BrickIndex brick) {
  const std::int32_t slot = ensure_slot(brick);
  BURR_CHECK(slot != kNoSlot);
  return tissue_.data() + at(slot);
}

std::int16_t* Bone::build_intensity(BrickIndex brick) {
  const std::int32_t slot = ensure_slot(brick);
  BURR_CHECK(slot != kNoSlot && !intensity_.empty());
  return intensity_.data() + at(slot);
}

std::uint64_t Bone::content_hash() const {
  std::uint64_t hash = base::mix(0, static_cast<std::uint64_t>(grid_.size.x()));
  hash = base::mix(hash, static_cast<std::uint64_t>(grid_.size.y()));
  hash = base::mix(hash, static_cast<std::uint64_t>(grid_.size.z()));
  hash = base::mix(hash, grid_.voxel);
  for (BrickIndex b = 0; b < brick_count_; ++b) {
    const Field* field = brick_field(b);
    const TissueId* tissue = brick_tissue(b);
    if (field == nullptr) continue;
    std::uint64_t words[kBrickWords];
    std::memcpy(words, field, sizeof words);
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    if (any == 0) continue;  // a brick cut away whole is the same as none
    hash = base::mix(hash, static_cast<std::uint64_t>(b));
    hash = base::mix(hash, words);
    std::memcpy(words, tissue, kBrickVoxels);
    hash = base::mix(hash, std::span(words, kBrickVoxels / 8));
  }
  return hash;
}

std::unique_ptr<Bone> bone_from_arrays(const Grid& grid, TissueTable tissues,
                                       std::span<const Field> field,
                                       std::span<const TissueId> tissue,
                                       std::span<const std::int16_t> intensity,
                                       std::size_t reserve_bricks) {
  const auto nx = static_cast<std::size_t>(grid.size.x()),
             ny = static_cast<std::size_t>(grid.size.y()),
             nz = static_cast<std::size_t>(grid.size.z());
  BURR_CHECK(field.size() == nx * ny * nz);
  BURR_CHECK(tissue.empty() || tissue.size() == field.size());
  BURR_CHECK(intensity.empty() || intensity.size() == field.size());

  // first find the bricks that hold anything, then take exactly the room they need
  const math::Ijk bricks = (grid.size.array() + kBrickEdge - 1) / kBrickEdge;
  std::vector<std::uint8_t> used(static_cast<std::size_t>(bricks.prod()));
  for (std::size_t k = 0, v = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j) {
      std::uint8_t* row = &used[static_cast<std::size_t>(bricks.x()) *
                                (j / 8 + static_cast<std::size_t>(bricks.y()) * (k / 8))];
      for (std::size_t i = 0; i < nx; ++i, ++v)
        if (field[v] != 0 || (!tissue.empty() && tissue[v] != 0)) row[i / 8] = 1;
    }
  const auto count =
      static_cast<std::size_t>(std::count(used.begin(), used.end(), std::uint8_t{1}));
  auto bone =
      std::make_unique<Bone>(grid, std::move(tissues), count, reserve_bricks, !intensity.empty());

  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    if (used[static_cast<std::size_t>(b)] == 0) continue;
    const math::Ijk first = bone->brick_ijk(b);
    Field* to_field = bone->build_field(b);
    TissueId* to_tissue = bone->build_tissue(b);
    std::int16_t* to_intensity = intensity.empty() ? nullptr : bone->build_intensity(b);
    const int ni = std::min(8, grid.size.x() - first.x());
    for (int k = 0; k < std::min(8, grid.size.z() - first.z()); ++k)
      for (int j = 0; j < std::min(8, grid.size.y() - first.y()); ++j) {
        const std::size_t from = static_cast<std::size_t>(first.x()) +
                                 nx * (static_cast<std::size_t>(first.y() + j) +
                                       ny * static_cast<std::size_t>(first.z() + k));
        const auto n = static_cast<std::size_t>(ni);
        const std::size_t to = inside_brick(0, j, k);
        std::copy_n(&field[from], n, to_field + to);
        if (tissue.empty()) {
          for (std::size_t i = 0; i < n; ++i) to_tissue[to + i] = field[from + i] != 0 ? 1 : 0;
        } else {
          std::copy_n(&tissue[from], n, to_tissue + to);
        }
        if (to_intensity != nullptr) std::copy_n(&intensity[from], n, to_intensity + to);
      }
  }
  return bone;
}

}  // namespace burr::volume
