#include "burr/metrics/divided.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burr::metrics {
namespace {

using math::Ijk;
using volume::Bone;

// The voxels of a grid, one byte each.
class Marks {
 public:
  explicit Marks(const Ijk& size)
      : size_(size),
        marks_(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
               static_cast<std::size_t>(size.z())) {}
  [[nodiscard]] bool inside(const Ijk& v) const {
    return (v.array() >= 0).all() && (v.array() < size_.array()).all();
  }
  std::uint8_t& at(const Ijk& v) { return marks_[index(v)]; }

 private:
  [[nodiscard]] std::size_t index(const Ijk& v) const {
    return static_cast<std::size_t>(v.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(v.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(v.z()));
  }
  Ijk size_;
  std::vector<std::uint8_t> marks_;
};

Ijk beside(const Ijk& v, int side) {
  Ijk next = v;
  next[side / 2] += side % 2 == 0 ? 1 : -1;
  return next;
}

// Marks the core of the bone in the region; its voxels, in the order of the bricks.
std::vector<Ijk> core_of(const Bone& bone, const Region& region, Marks& marks) {
  std::vector<Ijk> all;
  const auto is_bone = [&](const Ijk& v) {
    return marks.inside(v) && bone.field(v.x(), v.y(), v.z()) >= volume::kIso;
  };
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::Field* field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const Ijk first = bone.brick_ijk(brick);
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      const Ijk v = first + Ijk(n & 7, (n >> 3) & 7, n >> 6);
      if (field[n] < volume::kIso || !marks.inside(v)) continue;
      if (!contains(region, bone.grid().world_from_grid(v.cast<double>()))) continue;
      bool core = true;
      for (int side = 0; core && side < 6; ++side) core = is_bone(beside(v, side));
      if (!core) continue;
      marks.at(v) = 1;
      all.push_back(v);
    }
  }
  return all;
}

// Shares of the two largest pieces.
Divided pieces_of(const Bone& bone, const Region& region) {
  Marks marks(bone.grid().size);
  const std::vector<Ijk> core = core_of(bone, region, marks);
  std::size_t largest = 0, second = 0;
  std::vector<Ijk> open;
  for (const Ijk& seed : core) {
    if (marks.at(seed) == 0) continue;
    std::size_t count = 0;
    marks.at(seed) = 0;
    open.push_back(seed);
    while (!open.empty()) {
      const Ijk v = open.back();
      open.pop_back();
      ++count;
      for (int side = 0; side < 6; ++side) {
        const Ijk next = beside(v, side);
        if (!marks.inside(next) || marks.at(next) == 0) continue;
        marks.at(next) = 0;
        open.push_back(next);
      }
    }
    second = std::max(second, std::min(largest, count));
    largest = std::max(largest, count);
  }
  if (core.empty()) return {};
  const auto all = static_cast<double>(core.size());
  return {static_cast<double>(second) / all, static_cast<double>(largest) / all};
}

}  // namespace

Assessed<Divided> divided(const Bone& before, const Bone& after, const Region& region,
                          double least) {
  const Divided was = pieces_of(before, region);
  if (was.first <= 0) return NotAssessable{"there was no bone in this region before the first cut"};
  if (was.share >= least)
    return NotAssessable{"the bone in this region was in two pieces before the first cut"};
  return pieces_of(after, region);
}

}  // namespace burr::metrics
