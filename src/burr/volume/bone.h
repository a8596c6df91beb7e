// volume/bone.h - the bone: a sparse grid of bricks that one thread cuts while other threads read
// it.
//
//     per voxel   field     16 bit  depth into the material: 0 air .. 32768 surface .. 65535 solid,
//                                   a ramp of +-kRamp voxels around the true surface
//                 tissue     8 bit  what it is made of (TissueTable)
//                 intensity 16 bit  HU of the scan, only if the scan had them
//     per brick   8 x 8 x 8 voxels, x fastest; a slot in one pool, or none where all is air
//
//     directory:  [ -1 | 17 | -1 | 1 | ... ]  one entry per brick of the grid -> slot in the pool
//     pool:       [ all 0 | all solid | bricks of their own ... | reserved ]
//     tissue:     the same again, with a shared slot for each tissue that fills whole bricks
//
// After pack() all uniform bricks (one value in every voxel) share a slot. The first write to such
// a brick gives it a slot of its own, whose address was reserved before the session. In a real
// temporal bone half of the bricks are uniform.
//
// Outside the grid is air. Cutting and adding change the field alone; tissue and intensity stay,
// except that added material sets the tissue.
//
// Thread: build on one thread. After that: one writer (the servo), which reads directly, and any
// number of readers through copy_brick(), each with its own ChangedBits that say which bricks to
// read again. Memory: 1 KiB per brick with a field of its own, 0.5 KiB per brick of mixed tissue, 1
// KiB per used brick if intensity is kept; 8 B per brick of the grid. The memory that adding
// material and first writes may need is reserved, and taken a little ahead of use (rt/reserved.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "burr/rt/changed_bits.h"
#include "burr/rt/reserved.h"
#include "burr/rt/rt.h"
#include "burr/rt/versioned.h"
#include "burr/volume/grid.h"
#include "burr/volume/tissue.h"

namespace burr::volume {

using Field = std::uint16_t;

inline constexpr int kBrickEdge = 8;                                       // [voxel]
inline constexpr int kBrickVoxels = kBrickEdge * kBrickEdge * kBrickEdge;  // 512
inline constexpr int kBrickWords = kBrickVoxels * int{sizeof(Field)} / 8;  // 128 words of 64 bit
inline constexpr Field kIso = 32768;  // the surface; field >= kIso is inside
inline constexpr Field kSolid = 65535;
// Half width of the ramp; wide enough for exact central differences  [voxel]
inline constexpr double kRamp = 2.0;
// Field units per voxel of depth.
inline constexpr double kFieldPerVoxel = 65536.0 / (2.0 * kRamp);

// Converts a depth below the surface [voxel], negative in air, to a field value.
[[nodiscard]] constexpr Field field_from_depth(double depth_voxel) {
  const double f = 32768.0 + depth_voxel * kFieldPerVoxel;
  return f <= 0 ? Field{0} : f >= 65535.0 ? kSolid : static_cast<Field>(f + 0.5);
}

// The whole field of one brick, for copies. alignas: it is read and written in words of 64 bits.
struct alignas(64) BrickField {
  Field voxel[kBrickVoxels];  // (8 x 8 x 8), x fastest
};

using BrickIndex = std::int32_t;  // number of a brick in the grid, x fastest
inline constexpr BrickIndex kNoBrick = -1;
inline constexpr std::int32_t kNoSlot = -1;  // all air, or no room left

class Bone {
 public:
  // reserve_bricks: how many bricks may be added later (deposit). with_intensity: keep the scan's
  // values as well. capacity_bricks: how many bricks hold material at the start; the builder must
  // know it.
  Bone(const Grid& grid, TissueTable tissues, std::size_t capacity_bricks,
       std::size_t reserve_bricks, bool with_intensity);

  // ---- what and where
  [[nodiscard]] const Grid& grid() const BURR_RT { return grid_; }
  [[nodiscard]] const TissueTable& tissues() const BURR_RT { return tissues_; }
  // bricks along each axis
  [[nodiscard]] const math::Ijk& bricks() const BURR_RT { return bricks_; }
  [[nodiscard]] BrickIndex brick_count() const BURR_RT { return brick_count_; }
  // Bricks that hold material, and how many more may be added.
  [[nodiscard]] std::size_t used_slots() const BURR_RT { return used_; }
  [[nodiscard]] std::size_t free_slots() const BURR_RT { return capacity_ - used_; }
  [[nodiscard]] bool has_intensity() const BURR_RT { return !intensity_.empty(); }
  // Of what is in use, without reserved memory. Before the session, or on the writer's thread
  // [byte]
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] BrickIndex brick_at(int bi, int bj, int bk) const BURR_RT {
    return bi + bricks_.x() * (bj + bricks_.y() * bk);
  }
  [[nodiscard]] math::Ijk brick_ijk(BrickIndex brick) const BURR_RT {  // first voxel of the brick
    const int bi = brick % bricks_.x(), rest = brick / bricks_.x();
    return math::Ijk(bi, rest % bricks_.y(), rest / bricks_.y()) * kBrickEdge;
  }

  // ---- reading, on the writer's thread or before the session
  // One voxel; outside the grid is air.
  [[nodiscard]] Field field(int i, int j, int k) const BURR_RT;
  [[nodiscard]] TissueId tissue(int i, int j, int k) const BURR_RT;
  [[nodiscard]] std::int16_t intensity(int i, int j, int k) const BURR_RT;
  // (8 x 8 x 8) of a brick; nullptr: all air. Valid until the brick is written.
  [[nodiscard]] const Field* brick_field(BrickIndex brick) const BURR_RT {
    const std::int32_t slot =
        directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
    return slot == kNoSlot ? nullptr
                           : field_.data() + static_cast<std::size_t>(slot) * kBrickVoxels;
  }
  // True: the brick is certainly all 0 or all kSolid. False: it may still be uniform.
  [[nodiscard]] bool is_uniform(BrickIndex brick) const BURR_RT {
    const std::int32_t slot =
        directory_[static_cast<std::size_t>(brick)].load(std::memory_order_relaxed);
    return slot == kZeroSlot || slot == kSolidSlot;
  }
  [[nodiscard]] const TissueId* brick_tissue(BrickIndex brick) const BURR_RT;
  [[nodiscard]] const std::int16_t* brick_intensity(BrickIndex brick) const BURR_RT;

  // ---- reading, from any other thread while the servo cuts
  // Copies the whole field of a brick; zeros for a brick of air. Wait-free. False: the writer was
  // writing this brick; try again.
  [[nodiscard]] bool copy_brick(BrickIndex brick, BrickField& out) const BURR_RT;
  // Copies a part: rows y in [y.first, y.last) of slices z in [z.first, z.last). The rest of `out`
  // is unchanged.
  struct Range {
    int first = 0, last = kBrickEdge;
  };
  [[nodiscard]] bool copy_rows(BrickIndex brick, Range y, Range z, BrickField& out) const BURR_RT;
  // Tissue changes only under added material. Reads one voxel with a relaxed atomic.
  [[nodiscard]] TissueId shared_tissue(int i, int j, int k) const BURR_RT;

  // ---- watching: one ChangedBits per reader, created before the session
  rt::ChangedBits& add_watcher();

  // ---- writing, on the one writer's thread
  // Gives the brick a slot if it has none. kNoSlot: the reserve is used up; raise reserve_bricks.
  std::int32_t ensure_slot(BrickIndex brick) BURR_RT;
  // Replaces the field of a brick, which must have a slot. Marks it for all watchers.
  void write_brick(BrickIndex brick, const BrickField& content) BURR_RT;
  // The voxel must be in a brick with a slot.
  void set_tissue(int i, int j, int k, TissueId tissue) BURR_RT;

  // Takes the memory that writing will need next. Call it every few milliseconds while the servo
  // cuts, from one other thread.
  void commit_ahead();

  // ---- building, before the session; different bricks with slots may be built on different
  // threads
  Field* build_field(BrickIndex brick);  // gives it a slot; (8 x 8 x 8)
  TissueId* build_tissue(BrickIndex brick);
  std::int16_t* build_intensity(BrickIndex brick);
  // Gives the brick a slot and this content, (8 x 8 x 8) each; uniform content takes no memory. Do
  // not build the same brick again before pack().
  void build_brick(BrickIndex brick, const Field* field, const TissueId* tissue);
  // After building, on one thread: uniform bricks share slots, and the other slots close the gaps.
  void pack();

  // Hash of the geometry and of every field and tissue value: equal bones give equal numbers. Slow
  // (reads all bricks).
  [[nodiscard]] std::uint64_t content_hash() const;

 private:
  using Directory = std::unique_ptr<std::atomic<std::int32_t>[]>;  // (brick_count) slot or -1
  [[nodiscard]] std::int32_t slot_of(int i, int j, int k, const Directory& slots) const BURR_RT;
  std::int32_t own_field(BrickIndex brick, bool keep) BURR_RT;
  std::int32_t own_tissue(BrickIndex brick) BURR_RT;
  [[nodiscard]] bool can_share(const Field* field) const;
  [[nodiscard]] bool can_share(const TissueId* tissue) const;

  static constexpr std::int32_t kZeroSlot = 0, kSolidSlot = 1, kFirstField = 2, kFirstTissue = 256;

  Grid grid_;
  TissueTable tissues_;
  math::Ijk bricks_;
  BrickIndex brick_count_ = 0;
  std::size_t capacity_ = 0, used_ = 0;             // [brick]
  std::size_t fields_ = 0, tissues_used_ = 0;       // slots in use, including the shared ones
  Directory directory_, tissue_at_, intensity_at_;  // intensity_at_: only with intensity
  std::unique_ptr<rt::Version[]> versions_;         // (2 + capacity)
  rt::ReservedArray<Field> field_;                  // (2 + capacity) x 512
  rt::ReservedArray<TissueId> tissue_;              // (256 + capacity) x 512
  rt::ReservedArray<std::int16_t> intensity_;       // (capacity x 512) or empty
  std::atomic<std::size_t> fields_published_ = 0, tissues_published_ = 0;  // for commit_ahead()
  std::vector<std::unique_ptr<rt::ChangedBits>> watchers_;
};

// Builds a sparse bone from whole arrays, x fastest, (size.x * size.y * size.z) each; tissue and
// intensity may be empty. Bricks with an all-zero field and no tissue but air take no memory.
[[nodiscard]] std::unique_ptr<Bone> bone_from_arrays(const Grid& grid, TissueTable tissues,
                                                     std::span<const Field> field,
                                                     std::span<const TissueId> tissue,
                                                     std::span<const std::int16_t> intensity,
                                                     std::size_t reserve_bricks);

}  // namespace burr::volume
