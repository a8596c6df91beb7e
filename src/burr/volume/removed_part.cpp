#include "burr/volume/removed_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "burr/base/check.h"
#include "burr/volume/volume_of.h"

namespace burr::volume {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr std::size_t kBrickBytes = kBrickVoxels * (sizeof(Field) + sizeof(TissueId));

bool same_place(const Grid& a, const Grid& b) {
  return a.size == b.size && a.voxel == b.voxel && a.frame.p == b.frame.p &&
         a.frame.q.coeffs() == b.frame.q.coeffs();
}

bool lowered(const Bone& before, const Bone& after, BrickIndex brick) {
  const Field* b = before.brick_field(brick);
  const Field* a = after.brick_field(brick);
  if (b == nullptr) return false;
  for (int v = 0; v < kBrickVoxels; ++v)
    if ((a == nullptr ? Field{0} : a[v]) < b[v]) return true;
  return false;
}

// The cut at a voxel: -d_after where the field changed; otherwise continued from the changed
// neighbours.
Field cut_at(const Bone& before, const Bone& after, const math::Ijk& at) {
  const Field b = before.field(at.x(), at.y(), at.z()), now = after.field(at.x(), at.y(), at.z());
  if (now < b) return static_cast<Field>(kSolid - now);
  static const std::array<double, 4> away = {0, kFieldPerVoxel, std::sqrt(2.0) * kFieldPerVoxel,
                                             std::sqrt(3.0) * kFieldPerVoxel};
  double best = 0;
  for (int dk = -1; dk <= 1; ++dk)
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const math::Ijk near = at + math::Ijk(di, dj, dk);
        const Field a = after.field(near.x(), near.y(), near.z());
        if (a >= before.field(near.x(), near.y(), near.z())) continue;
        const int steps = std::abs(di) + std::abs(dj) + std::abs(dk);
        best = std::max(best, kSolid - a - away[static_cast<std::size_t>(steps)]);
      }
  return static_cast<Field>(std::min(best, static_cast<double>(kSolid - b)));
}

// The depth of each voxel inside the cut, for the bricks that were cut and those around them.
class CutField {
 public:
  CutField(const Bone& before, const Bone& after)
      : bone_(before), slot_(static_cast<std::size_t>(before.brick_count()), kNoSlot) {
    const math::Ijk& bricks = before.bricks();
    for (BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
      if (!lowered(before, after, brick)) continue;
      const math::Ijk at = before.brick_ijk(brick) / kBrickEdge;
      for (int k = std::max(at.z() - 1, 0); k <= std::min(at.z() + 1, bricks.z() - 1); ++k)
        for (int j = std::max(at.y() - 1, 0); j <= std::min(at.y() + 1, bricks.y() - 1); ++j)
          for (int i = std::max(at.x() - 1, 0); i <= std::min(at.x() + 1, bricks.x() - 1); ++i)
            add(before.brick_at(i, j, k));
    }
    for (std::size_t s = 0; s < touched_.size(); ++s) {
      const math::Ijk first = before.brick_ijk(touched_[s]);
      for (int v = 0; v < kBrickVoxels; ++v)
        field_[s].voxel[v] = cut_at(before, after, first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6));
    }
  }

  [[nodiscard]] const std::vector<BrickIndex>& touched() const { return touched_; }
  [[nodiscard]] const BrickField& brick(std::size_t touched) const { return field_[touched]; }
  [[nodiscard]] Field at(int i, int j, int k) const {
    if (!bone_.grid().contains({i, j, k})) return 0;
    const std::int32_t slot =
        slot_[static_cast<std::size_t>(bone_.brick_at(i >> 3, j >> 3, k >> 3))];
    return slot == kNoSlot ? Field{0}
                           : field_[static_cast<std::size_t>(slot)]
                                 .voxel[(i & 7) + 8 * ((j & 7) + 8 * (k & 7))];
  }

 private:
  void add(BrickIndex brick) {
    std::int32_t& slot = slot_[static_cast<std::size_t>(brick)];
    if (slot != kNoSlot) return;
    slot = static_cast<std::int32_t>(touched_.size());
    touched_.push_back(brick);
    field_.emplace_back();
  }
  const Bone& bone_;
  std::vector<std::int32_t> slot_;  // (bricks of the grid)
  std::vector<BrickIndex> touched_;
  std::vector<BrickField> field_;
};

std::unique_ptr<Bone> on_the_same_grid(const Bone& before, const CutField& cut, bool& any) {
  auto removed = std::make_unique<Bone>(before.grid(), before.tissues(), cut.touched().size(), 0,
                                        before.has_intensity());
  for (std::size_t s = 0; s < cut.touched().size(); ++s) {
    const BrickIndex brick = cut.touched()[s];
    const Field* old_field = before.brick_field(brick);
    if (old_field == nullptr) continue;
    BrickField content{};
    bool holds = false;
    for (int v = 0; v < kBrickVoxels; ++v) {
      content.voxel[v] = std::min(old_field[v], cut.brick(s).voxel[v]);
      holds |= content.voxel[v] != 0;
      any |= content.voxel[v] >= kIso;
    }
    if (!holds) continue;
    std::copy_n(content.voxel, kBrickVoxels, removed->build_field(brick));
    TissueId* tissue = removed->build_tissue(brick);
    const TissueId* old_tissue = before.brick_tissue(brick);
    for (int v = 0; v < kBrickVoxels; ++v)
      tissue[v] = content.voxel[v] != 0 ? old_tissue[v] : TissueId{0};
    if (before.has_intensity())
      std::copy_n(before.brick_intensity(brick), kBrickVoxels, removed->build_intensity(brick));
  }
  return removed;
}

// The corner values of one cell of the old grid, for interpolation.
struct Cell {
  std::array<float, 8> b{}, c{};  // before, cut

  // False: nothing was removed in this cell.
  bool fill(const Bone& before, const CutField& cut, const math::Ijk& at) {
    float most_b = 0, most_c = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const math::Ijk v = at + math::Ijk(corner & 1, (corner >> 1) & 1, corner >> 2);
      const auto n = static_cast<std::size_t>(corner);
      b[n] = static_cast<float>(before.field(v.x(), v.y(), v.z()));
      c[n] = static_cast<float>(cut.at(v.x(), v.y(), v.z()));
      most_b = std::max(most_b, b[n]);
      most_c = std::max(most_c, c[n]);
    }
    return most_b > 0 && most_c > 0;
  }
  static float between(const std::array<float, 8>& f, float x, float y, float z) {
    const auto mix = [](float low, float high, float t) { return low + t * (high - low); };
    return mix(mix(mix(f[0], f[1], x), mix(f[2], f[3], x), y),
               mix(mix(f[4], f[5], x), mix(f[6], f[7], x), y), z);
  }
};

// Calls each(lower voxel of the cell) for every cell with a corner in a changed brick.
template <class Each>
void for_each_cell(const Bone& before, const CutField& cut, const Each& each) {
  for (const BrickIndex brick : cut.touched()) {
    const math::Ijk first = before.brick_ijk(brick);
    const auto from = [](int voxel) { return voxel == 0 ? -1 : voxel; };  // the grid's low border
    for (int k = from(first.z()); k < first.z() + kBrickEdge; ++k)
      for (int j = from(first.y()); j < first.y() + kBrickEdge; ++j)
        for (int i = from(first.x()); i < first.x() + kBrickEdge; ++i) each(math::Ijk(i, j, k));
  }
}

Result<std::unique_ptr<Bone>> on_a_finer_grid(const Bone& before, const CutField& cut, int finer) {
  // fine voxel (0,0,0) lies at old voxel (-1,-1,-1)
  Grid grid = before.grid();
  grid.frame.p = grid.world_from_grid({-1, -1, -1});
  grid.voxel /= finer;
  grid.size = (grid.size.array() + 1) * finer + 1;
  const math::Ijk bricks = (grid.size.array() + kBrickEdge - 1) / kBrickEdge;
  if (static_cast<double>(bricks.x()) * bricks.y() * bricks.z() > 1e9)
    return error(
        "the difference between the two bones cannot be computed on a finer grid, because the grid "
        "would be too large");
  const auto brick_of = [&](const math::Ijk& fine) {
    const math::Ijk at = fine / kBrickEdge;
    return static_cast<std::size_t>(at.x()) +
           static_cast<std::size_t>(bricks.x()) *
               (static_cast<std::size_t>(at.y()) +
                static_cast<std::size_t>(bricks.y()) * static_cast<std::size_t>(at.z()));
  };

  // first find the bricks that will hold something, then reserve exactly the memory they need
  std::vector<bool> used(static_cast<std::size_t>(bricks.x()) *
                         static_cast<std::size_t>(bricks.y()) *
                         static_cast<std::size_t>(bricks.z()));
  Cell cell;
  for_each_cell(before, cut, [&](const math::Ijk& at) {
    if (!cell.fill(before, cut, at)) return;
    const math::Ijk low = (at.array() + 1) * finer;
    for (int corner = 0; corner < 8; ++corner)
      used[brick_of(low + (finer - 1) * math::Ijk(corner & 1, (corner >> 1) & 1, corner >> 2))] =
          true;
  });
  const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  if (count * kBrickBytes > kMostBytes)
    return error(
        "the difference between the two bones cannot be computed on a finer grid, because it would "
        "need more than 1 GB");

  auto removed = std::make_unique<Bone>(grid, before.tissues(), count, 0, false);
  bool any = false;
  for_each_cell(before, cut, [&](const math::Ijk& at) {
    if (!cell.fill(before, cut, at)) return;
    const math::Ijk low = (at.array() + 1) * finer;
    const auto scale = static_cast<float>(finer), iso = static_cast<float>(kIso);
    for (int z = 0; z < finer; ++z)
      for (int y = 0; y < finer; ++y)
        for (int x = 0; x < finer; ++x) {
          const auto part = [&](int step) { return static_cast<float>(step) / scale; };
          const float depth = std::min(Cell::between(cell.b, part(x), part(y), part(z)),
                                       Cell::between(cell.c, part(x), part(y), part(z)));
          const float value = std::clamp(iso + (depth - iso) * scale, 0.0F, 65535.0F);
          const auto field = static_cast<Field>(value + 0.5F);
          if (field == 0) continue;
          any |= field >= kIso;
          const math::Ijk fine = low + math::Ijk(x, y, z);
          const auto brick = static_cast<BrickIndex>(brick_of(fine));
          const int v = (fine.x() & 7) + 8 * ((fine.y() & 7) + 8 * (fine.z() & 7));
          removed->build_field(brick)[v] = field;
          // the tissue of the nearest old voxel, or of its neighbour if that one is air
          TissueId tissue = before.tissue(at.x() + (2 * x >= finer), at.y() + (2 * y >= finer),
                                          at.z() + (2 * z >= finer));
          for (int c = 0; c < 8 && tissue == 0; ++c)
            tissue = before.tissue(at.x() + (c & 1), at.y() + ((c >> 1) & 1), at.z() + (c >> 2));
          removed->build_tissue(brick)[v] = tissue;
        }
  });
  if (!any) return error("the difference between the two bones is too thin to have a surface");
  return removed;
}

}  // namespace

Result<std::unique_ptr<Bone>> removed_part(const Bone& before, const Bone& after, int finer) {
  BURR_CHECK(finer >= 1 && finer <= 8);
  if (!same_place(before.grid(), after.grid()))
    return error("the two bones are not on the same grid, so their difference cannot be computed");
  const CutField cut(before, after);
  if (cut.touched().empty())
    return error("nothing has been removed from this bone yet; export `part` bone instead");
  if (finer > 1) return on_a_finer_grid(before, cut, finer);
  bool any = false;
  auto removed = on_the_same_grid(before, cut, any);
  if (!any) return error("the difference between the two bones is too thin to have a surface");
  return removed;
}

double removed_volume(const Bone& before, const Bone& after) {
  BURR_CHECK(before.grid().size == after.grid().size);
  std::int64_t units = 0;
  for (BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const Field* b = before.brick_field(brick);
    const Field* a = after.brick_field(brick);
    if (b == nullptr) continue;
    for (int v = 0; v < kBrickVoxels; ++v) {
      const Field now = a == nullptr ? Field{0} : a[v];
      if (now < b[v]) units += volume_units(std::int32_t{b[v]}) - volume_units(std::int32_t{now});
    }
  }
  const double voxel = before.grid().voxel;
  return static_cast<double>(units) / static_cast<double>(kVoxelUnits) * (voxel * voxel * voxel);
}

}  // namespace burr::volume
