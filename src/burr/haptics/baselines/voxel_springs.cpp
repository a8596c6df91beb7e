#include "burr/haptics/baselines/voxel_springs.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::haptics {

using math::Vec3;

VoxelSprings::VoxelSprings(const volume::Bone& bone, const ProxySettings& settings,
                           const Vec3& hand)
    : bone_(bone), radius_(settings.radius), proxy_(hand) {}

bool VoxelSprings::set_radius(double radius) BURR_RT {
  radius_ = radius;
  return true;
}

Touch VoxelSprings::step(const Vec3& hand) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const Vec3 x = grid.grid_from_world(hand);
  const double r = radius_ / grid.voxel;
  Touch touch;
  touch.proxy = proxy_ = hand;
  Vec3 sum = Vec3::Zero();
  int voxels = 0;
  const math::Ijk lo = (x.array() - r).ceil().max(0).cast<int>(),
                  hi =
                      (x.array() + r).floor().min(grid.size.cast<double>().array() - 1).cast<int>();
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j) {
      const double dy = x.y() - j, dz = x.z() - k, left = r * r - dy * dy - dz * dz;
      if (left < 0) continue;
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const double dx = x.x() - i;
        if (dx * dx > left) continue;
        // the share of bone in the voxel: the field's ramp is four voxels wide, this one is one
        const double depth = 2 * volume::kRamp * (bone_.field(i, j, k) / 65536.0 - 0.5);
        const double share = std::clamp(depth + 0.5, 0.0, 1.0);
        if (share == 0) continue;
        const Vec3 away(dx, dy, dz);
        const double far = math::norm(away);
        if (far < 1e-9) continue;
        sum += share * (r - far) / far * away;
        ++voxels;
      }
    }
  const double stretch = kShare * math::norm(sum) * grid.voxel;
  touch.candidates = touch.active = voxels;
  touch.touching = stretch > 0;
  if (!touch.touching) return touch;
  touch.normal = grid.frame.q * math::normalized(sum);
  touch.depth = touch.pressing = stretch;
  return touch;
}

}  // namespace burr::haptics
