// edit/crossed.h - which voxels crossed the surface of the bone (volume::kIso) since the last look.
//
//     CrossedVoxels crossed(bone);
//     writer.set_watch(&crossed.written());           // tells it which bricks were written
//     ... a tick ...
//     crossed.take([](const math::Ijk& voxel, bool out) { ... });   // out: it was inside
//
// A voxel that left and came back between two looks did not cross. Thread: servo; take() between
// ticks. Memory: 69 B a brick of the grid, at construction; a look costs the bricks that were written.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "burr/edit/changed_queue.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::edit {

class CrossedVoxels {
 public:
  explicit CrossedVoxels(const volume::Bone& bone)
      : bone_(bone), written_(bone), inside_(static_cast<std::size_t>(bone.brick_count())) {
    for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
      inside_[static_cast<std::size_t>(brick)] = look(brick);
  }

  [[nodiscard]] ChangedQueue& written() BURR_RT { return written_; }

  // Calls use(voxel, out) for each: brick by brick as they were written, x fastest within one.
  template <class Use>
  void take(const Use& use) {
    for (volume::BrickIndex brick = written_.pop(); brick != volume::kNoBrick;
         brick = written_.pop()) {
      Inside& was = inside_[static_cast<std::size_t>(brick)];
      const Inside now = look(brick);
      const math::Ijk first = bone_.brick_ijk(brick);
      for (int word = 0; word < kWords; ++word) {
        const auto at = static_cast<std::size_t>(word);
        for (std::uint64_t left = was[at] ^ now[at]; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          use(math::Ijk(first + math::Ijk(bit & 7, bit >> 3, word)), (was[at] >> bit & 1) != 0);
        }
      }
      was = now;
    }
  }

 private:
  static constexpr int kWords = volume::kBrickVoxels / 64;  // one for each slice
  using Inside = std::array<std::uint64_t, kWords>;         // bit: the voxel is inside

  [[nodiscard]] Inside look(volume::BrickIndex brick) const {
    Inside inside = {};
    const volume::Field* field = bone_.brick_field(brick);
    if (field == nullptr) return inside;
    for (int v = 0; v < volume::kBrickVoxels; ++v)
      inside[static_cast<std::size_t>(v >> 6)] |= std::uint64_t{field[v] >= volume::kIso}
                                                  << (v & 63);
    return inside;
  }

  const volume::Bone& bone_;
  ChangedQueue written_;
  std::vector<Inside> inside_;  // (brick_count) as of the last look
};

}  // namespace burr::edit
