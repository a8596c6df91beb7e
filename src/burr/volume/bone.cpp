#include "burr/volume/bone.h"

#include <algorithm>
#include <cstring>

#include "burr/base/check.h"
#include "burr/base/hash.h"
#include "burr/rt/atoms.h"

namespace burr::volume {
namespace {

std::size_t at(std::int32_t slot) { return static_cast<std::size_t>(slot) * kBrickVoxels; }

std::size_t inside_brick(int i, int j, int k) {
  return static_cast<std::size_t>((i & 7) + 8 * ((j & 7) + 8 * (k & 7)));
}

std::unique_ptr<std::atomic<std::int32_t>[]> no_slots(BrickIndex bricks) {
  auto made = std::make_unique<std::atomic<std::int32_t>[]>(static_cast<std::size_t>(bricks));
  for (BrickIndex b = 0; b < bricks; ++b)
    made[static_cast<std::size_t>(b)].store(kNoSlot, std::memory_order_relaxed);
  return made;
}

// How many bricks can be written for the first time between two calls of commit_ahead().
constexpr std::size_t kAhead = 1024;

template <class T>
bool same_throughout(const T* brick) {
  return std::memcmp(brick, brick + 1, (kBrickVoxels - 1) * sizeof(T)) == 0;
}

// Moves the slots in use down over the unused ones, keeping their order, and gives the rest back.
// Returns the number of slots in use.
template <class T>
std::size_t close_gaps(std::atomic<std::int32_t>* slot_of, BrickIndex bricks, std::int32_t first,
                       std::size_t used, rt::ReservedArray<T>& pool) {
  std::vector<BrickIndex> owner(used, kNoBrick);
  for (BrickIndex b = 0; b < bricks; ++b)
    if (const std::int32_t slot = slot_of[b]; slot >= first)
      owner[static_cast<std::size_t>(slot)] = b;
  auto next = static_cast<std::size_t>(first);
  for (std::size_t slot = next; slot < used; ++slot) {
    if (owner[slot] == kNoBrick) continue;
    if (next != slot)
      std::memcpy(pool.data() + next * kBrickVoxels, pool.data() + slot * kBrickVoxels,
                  kBrickVoxels * sizeof(T));
    slot_of[owner[slot]].store(static_cast<std::int32_t>(next++), std::memory_order_relaxed);
  }
  pool.decommit(next * kBrickVoxels);
  return next;
}

}  // namespace

Bone::Bone(const Grid& grid, TissueTable tissues, std::size_t capacity_bricks,
           std::size_t reserve_bricks, bool with_intensity)
    : grid_(grid),
      tissues_(std::move(tissues)),
      bricks_((grid.size.array() + kBrickEdge - 1) / kBrickEdge),
      brick_count_(bricks_.prod()),
      capacity_(std::min(capacity_bricks + reserve_bricks, static_cast<std::size_t>(brick_count_))),
      fields_(kFirstField),
      tissues_used_(kFirstTissue),
      directory_(no_slots(brick_count_)),
      tissue_at_(no_slots(brick_count_)),
      intensity_at_(with_intensity ? no_slots(brick_count_) : nullptr),
      versions_(std::make_unique<rt::Version[]>(kFirstField + capacity_)),
      field_((kFirstField + capacity_) * kBrickVoxels),
      tissue_((kFirstTissue + capacity_) * kBrickVoxels),
      intensity_(with_intensity ? capacity_ * kBrickVoxels : 0) {
  BURR_CHECK(grid.size.minCoeff() > 0 && grid.voxel > 0);
  std::fill_n(field_.data() + at(kSolidSlot), kBrickVoxels, kSolid);
  for (std::size_t id = 1; id < std::min<std::size_t>(tissues_.tissues.size(), kFirstTissue); ++id)
    std::fill_n(tissue_.data() + id * kBrickVoxels, kBrickVoxels, static_cast<TissueId>(id));
}

std::int32_t Bone::slot_of(int i, int j, int k, const Directory& slots) const BURR_RT {
  if (!grid_.contains({i, j, k})) return kNoSlot;
  const BrickIndex brick = brick_at(i >> 3, j >> 3, k >> 3);
  return slots[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
}

Field Bone::field(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = slot_of(i, j, k, directory_);
  return slot == kNoSlot ? Field{0} : field_[at(slot) + inside_brick(i, j, k)];
}

TissueId Bone::tissue(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = slot_of(i, j, k, tissue_at_);
  return slot == kNoSlot ? TissueId{0} : tissue_[at(slot) + inside_brick(i, j, k)];
}

std::int16_t Bone::intensity(int i, int j, int k) const BURR_RT {
  const std::int32_t slot = intensity_.empty() ? kNoSlot : slot_of(i, j, k, intensity_at_);
  return slot == kNoSlot ? std::int16_t{-1024} : intensity_[at(slot) + inside_brick(i, j, k)];
}

const TissueId* Bone::brick_tissue(BrickIndex brick) const BURR_RT {
  const std::int32_t slot =
      tissue_at_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
  return slot == kNoSlot ? nullptr : tissue_.data() + at(slot);
}

const std::int16_t* Bone::brick_intensity(BrickIndex brick) const BURR_RT {
  if (intensity_.empty()) return nullptr;
  const std::int32_t slot =
      intensity_at_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
  return slot == kNoSlot ? nullptr : intensity_.data() + at(slot);
}

bool Bone::copy_brick(BrickIndex brick, BrickField& out) const BURR_RT {
  return copy_rows(brick, {}, {}, out);
}

bool Bone::copy_rows(BrickIndex brick, Range y, Range z, BrickField& out) const BURR_RT {
  constexpr int kRowWords = kBrickWords / (kBrickEdge * kBrickEdge);
  const std::int32_t slot =
      directory_[static_cast<std::size_t>(brick)].load(std::memory_order_acquire);
  auto* to = reinterpret_cast<std::uint64_t*>(&out);
  const std::uint64_t* shared =
      slot == kNoSlot ? nullptr : reinterpret_cast<const std::uint64_t*>(field_.data() + at(slot));
  const auto copy = [&] {
    for (int k = z.first; k < z.last; ++k)
      for (int w = kRowWords * (kBrickEdge * k + y.first),
               end = kRowWords * (kBrickEdge * k + y.last);
           w < end; ++w)
        to[w] = shared == nullptr ? 0 : rt::StdAtoms::load(shared[w]);
  };
  if (shared != nullptr) return rt::versioned_read(versions_[static_cast<std::size_t>(slot)], copy);
  copy();
  return true;
}

TissueId Bone::shared_tissue(int i, int j, int k) const BURR_RT {
  if (!grid_.contains({i, j, k})) return 0;
  const BrickIndex brick = brick_at(i >> 3, j >> 3, k >> 3);
  const std::int32_t slot =
      tissue_at_[static_cast<std::size_t>(brick)].load(std::memory_order_acquire);
  if (slot == kNoSlot) return 0;
  return rt::load_relaxed(tissue_[at(slot) + inside_brick(i, j, k)]);
}

std::size_t Bone::memory_bytes() const {
  // of the shared tissue slots only those of tissues in the table were ever written
  const std::size_t tissues = tissues_used_ - kFirstTissue + tissues_.tissues.size();
  return fields_ * (sizeof(BrickField) + sizeof(rt::Version)) + tissues * kBrickVoxels +
         (intensity_.empty() ? 0 : used_ * kBrickVoxels * sizeof(std::int16_t)) +
         static_cast<std::size_t>(brick_count_) * sizeof(std::int32_t) *
             (intensity_.empty() ? 2 : 3);
}

rt::ChangedBits& Bone::add_watcher() {
  watchers_.push_back(std::make_unique<rt::ChangedBits>(static_cast<std::size_t>(brick_count_)));
  return *watchers_.back();
}

std::int32_t Bone::ensure_slot(BrickIndex brick) BURR_RT {
  const auto b = static_cast<std::size_t>(brick);
  const std::int32_t slot = directory_[b].load(std::memory_order_relaxed);
  if (slot != kNoSlot) return slot;
  if (used_ == capacity_) return kNoSlot;
  const auto fresh = static_cast<std::int32_t>(fields_++);
  if (!intensity_.empty())
    intensity_at_[b].store(static_cast<std::int32_t>(used_), std::memory_order_relaxed);
  ++used_;
  // release: a reader that sees the slot sees its zeros
  tissue_at_[b].store(static_cast<std::int32_t>(tissues_used_++), std::memory_order_release);
  directory_[b].store(fresh, std::memory_order_release);
  fields_published_.store(fields_, std::memory_order_relaxed);
  tissues_published_.store(tissues_used_, std::memory_order_relaxed);
  return fresh;
}

// Gives the brick a slot of its own. There is one for each brick: every used brick shares a slot or
// has at most one. keep: copies the content; otherwise the caller fills and publishes the slot.
std::int32_t Bone::own_field(BrickIndex brick, bool keep) BURR_RT {
  std::atomic<std::int32_t>& entry = directory_[static_cast<std::size_t>(brick)];
  const std::int32_t slot = entry.load(std::memory_order_relaxed);
  BURR_CHECK(slot != kNoSlot);
  if (slot >= kFirstField) return slot;
  BURR_CHECK(fields_ < kFirstField + capacity_);
  const auto fresh = static_cast<std::int32_t>(fields_++);
  fields_published_.store(fields_, std::memory_order_relaxed);
  if (!keep) return fresh;
  std::memcpy(field_.data() + at(fresh), field_.data() + at(slot), sizeof(BrickField));
  entry.store(fresh, std::memory_order_release);
  return fresh;
}

std::int32_t Bone::own_tissue(BrickIndex brick) BURR_RT {
  std::atomic<std::int32_t>& entry = tissue_at_[static_cast<std::size_t>(brick)];
  const std::int32_t slot = entry.load(std::memory_order_relaxed);
  BURR_CHECK(slot != kNoSlot);
  if (slot >= kFirstTissue) return slot;
  BURR_CHECK(tissues_used_ < kFirstTissue + capacity_);
  const auto fresh = static_cast<std::int32_t>(tissues_used_++);
  tissues_published_.store(tissues_used_, std::memory_order_relaxed);
  std::memcpy(tissue_.data() + at(fresh), tissue_.data() + at(slot), kBrickVoxels);
  entry.store(fresh, std::memory_order_release);  // readers that see the slot see its tissue
  return fresh;
}

void Bone::write_brick(BrickIndex brick, const BrickField& content) BURR_RT {
  const std::int32_t slot = own_field(brick, false);
  rt::versioned_write(versions_[static_cast<std::size_t>(slot)],
                      reinterpret_cast<std::uint64_t*>(field_.data() + at(slot)),
                      reinterpret_cast<const std::uint64_t*>(&content), kBrickWords);
  directory_[static_cast<std::size_t>(brick)].store(slot, std::memory_order_release);
  for (const auto& watcher : watchers_) watcher->mark(static_cast<std::size_t>(brick));
}

void Bone::set_tissue(int i, int j, int k, TissueId tissue) BURR_RT {
  BURR_CHECK(grid_.contains({i, j, k}));
  const std::int32_t slot = own_tissue(brick_at(i >> 3, j >> 3, k >> 3));
  rt::store_relaxed(tissue_[at(slot) + inside_brick(i, j, k)], tissue);
}

void Bone::commit_ahead() {
  field_.commit((fields_published_.load(std::memory_order_relaxed) + kAhead) * kBrickVoxels);
  tissue_.commit((tissues_published_.load(std::memory_order_relaxed) + kAhead) * kBrickVoxels);
}

Field* Bone::build_field(BrickIndex brick) {
  BURR_CHECK(ensure_slot(brick) != kNoSlot);
  return field_.data() + at(own_field(brick, true));
}

TissueId* Bone::build_tissue(BrickIndex brick) {
  BURR_CHECK(ensure_slot(brick) != kNoSlot);
  return tissue_.data() + at(own_tissue(brick));
}

std::int16_t* Bone::build_intensity(BrickIndex brick) {
  BURR_CHECK(ensure_slot(brick) != kNoSlot && !intensity_.empty());
  return intensity_.data() +
         at(intensity_at_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed));
}

bool Bone::can_share(const Field* field) const {
  return (field[0] == 0 || field[0] == kSolid) && same_throughout(field);
}

bool Bone::can_share(const TissueId* tissue) const {
  return (tissue[0] == 0 || tissue[0] < tissues_.tissues.size()) && same_throughout(tissue);
}

void Bone::build_brick(BrickIndex brick, const Field* field, const TissueId* tissue) {
  BURR_CHECK(ensure_slot(brick) != kNoSlot);
  const auto b = static_cast<std::size_t>(brick);
  if (can_share(field))
    directory_[b].store(field[0] == 0 ? kZeroSlot : kSolidSlot, std::memory_order_relaxed);
  else
    std::copy_n(field, kBrickVoxels, build_field(brick));
  if (can_share(tissue))
    tissue_at_[b].store(tissue[0], std::memory_order_relaxed);
  else
    std::copy_n(tissue, kBrickVoxels, build_tissue(brick));
}

void Bone::pack() {
  // first share what can be shared
  for (std::size_t b = 0; b < static_cast<std::size_t>(brick_count_); ++b) {
    if (const std::int32_t slot = directory_[b]; slot >= kFirstField)
      if (const Field* field = field_.data() + at(slot); can_share(field))
        directory_[b] = field[0] == 0 ? kZeroSlot : kSolidSlot;
    if (const std::int32_t slot = tissue_at_[b]; slot >= kFirstTissue)
      if (const TissueId* tissue = tissue_.data() + at(slot); can_share(tissue))
        tissue_at_[b] = tissue[0];
  }
  // then close the gaps
  fields_ = close_gaps(directory_.get(), brick_count_, kFirstField, fields_, field_);
  tissues_used_ = close_gaps(tissue_at_.get(), brick_count_, kFirstTissue, tissues_used_, tissue_);
  for (std::size_t slot = 0; slot < kFirstField + capacity_; ++slot)
    versions_[slot].store(0, std::memory_order_relaxed);
  fields_published_ = fields_;
  tissues_published_ = tissues_used_;
  commit_ahead();
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
    if (any == 0) continue;  // a brick cut away entirely equals no brick
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

  // first find the bricks that hold something, then reserve exactly the memory they need
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
  bone->pack();
  return bone;
}

}  // namespace burr::volume
