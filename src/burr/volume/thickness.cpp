#include "burr/volume/thickness.h"

#include <array>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::volume {
namespace {

using math::Vec3;

constexpr double kStep = 0.25;  // [voxel]
constexpr int kTries = 64;      // writing a brick takes less than a microsecond

// Reads the present field, keeping a few bricks.
class Seen {
 public:
  explicit Seen(const Bone& bone) : bone_(bone) {}

  // Trilinear, as a share, like sample().
  double at(const Vec3& p) {
    const Vec3 low = p.array().floor();
    const Vec3 t = p - low;
    const math::Ijk first = low.cast<int>();
    double sum = 0;
    for (int n = 0; n < 8; ++n) {
      const int x = n & 1, y = n >> 1 & 1, z = n >> 2;
      const double weight = (x != 0 ? t.x() : 1 - t.x()) * (y != 0 ? t.y() : 1 - t.y()) *
                            (z != 0 ? t.z() : 1 - t.z());
      sum += weight * voxel(first.x() + x, first.y() + y, first.z() + z);
    }
    return sum / 65536;
  }

 private:
  double voxel(int i, int j, int k) {
    if (!bone_.grid().contains({i, j, k})) return 0;
    const BrickIndex brick = bone_.brick_at(i >> 3, j >> 3, k >> 3);
    // neighbouring bricks along each axis use different entries
    Kept& kept =
        kept_[static_cast<std::size_t>((i >> 3 & 1) + 2 * (j >> 3 & 1) + 4 * (k >> 3 & 1))];
    if (kept.brick != brick) {
      for (int n = 0; n < kTries && !bone_.copy_brick(brick, kept.field); ++n) {
      }
      kept.brick = brick;
    }
    return kept.field.voxel[(i & 7) + 8 * (j & 7) + 64 * (k & 7)];
  }

  struct Kept {
    BrickField field = {};
    BrickIndex brick = kNoBrick;
  };
  const Bone& bone_;
  std::array<Kept, 8> kept_;
};

}  // namespace

std::optional<Span> thickness(const Bone& bone, const Vec3& from, const Vec3& direction,
                              double reach) {
  const Grid& grid = bone.grid();
  const Vec3 start = grid.grid_from_world(from);
  const Vec3 way = grid.frame.q.conjugate() * direction;
  const double near = reach / grid.voxel;
  if (!start.allFinite() || !way.allFinite() || std::abs(math::norm(way) - 1) > 1e-6 || !(near > 0))
    return std::nullopt;
  const math::Aabb box = grid.bounds_grid();
  // longer than any line from here through the whole grid
  const double far = math::norm(start - 0.5 * (box.lo + box.hi)) + math::norm(box.hi - box.lo) + 2;

  Seen seen(bone);
  double before = seen.at(start), entered = before >= 0.5 ? 0 : -1;
  for (double s = kStep; s <= far; s += kStep) {
    const double now = seen.at(start + s * way);
    if ((now >= 0.5) != (before >= 0.5)) {
      const double crossing = s - kStep * (now - 0.5) / (now - before);
      if (entered >= 0)
        return Span{grid.world_from_grid(start + entered * way),
                    grid.world_from_grid(start + crossing * way)};
      entered = crossing;
    }
    if (entered < 0 && s > near) break;
    before = now;
  }
  return std::nullopt;
}

}  // namespace burr::volume
