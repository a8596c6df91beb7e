#include "burr/edit/laws/thesis_law.h"

#include <algorithm>

#include "burr/math/sums.h"
#include "burr/rt/flags.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
using volume::kBrickEdge;
using volume::kBrickVoxels;

// What each voxel of a brick whose middle lies in the ball loses. first: the brick's first voxel
// less the ball's centre; layers: of the brick, across the mirror, that may change.
Excess find_inside(const volume::Field* field, const Vec3& first, double radius, int amount,
                   const Half& half, unsigned layers, std::uint16_t* out) BURR_RT {
  Excess excess;
  for (int v = 0; v < kBrickVoxels; ++v) {
    const Vec3 p = first + Vec3(v & 7, v >> 3 & 7, v >> 6);
    const bool in =
        math::squared_norm(p) <= radius * radius && in_layers(v, half.mirror.axis, layers);
    const int loses = in ? std::min(int{field[v]}, amount) : 0;
    out[v] = static_cast<std::uint16_t>(loses);
    if (loses == 0) continue;
    excess.most = std::max(excess.most, loses);
    excess.pairs |= 1U << (v >> 4);
    excess.units +=
        volume::volume_units(std::int32_t{field[v]}) - volume::volume_units(int{field[v]} - loses);
  }
  return excess;
}

// The bricks of one side that the ball reaches.
void gather_inside(Carver& carver, const Vec3& centre, double radius, int amount, const Half& half,
                   std::uint32_t& flags) BURR_RT {
  const BoneWriter& writer = carver.writer();
  const volume::Bone& bone = writer.bone();
  Reached& reached = carver.reached();
  reached.begin_side();
  const math::Ijk last = bone.bricks().array() - 1;
  const math::Ijk lo = ((centre.array() - radius) / kBrickEdge)
                           .floor()
                           .max(0)
                           .min(last.cast<double>().array() + 1)
                           .cast<int>();
  const math::Ijk hi = ((centre.array() + radius) / kBrickEdge)
                           .floor()
                           .max(-1)
                           .min(last.cast<double>().array())
                           .cast<int>();
  for (int bk = lo.z(); bk <= hi.z(); ++bk)
    for (int bj = lo.y(); bj <= hi.y(); ++bj)
      for (int bi = lo.x(); bi <= hi.x(); ++bi) {
        const unsigned layers = layers_of({bi, bj, bk}, half, 1, 0);
        const BrickIndex brick = bone.brick_at(bi, bj, bk);
        if (layers == 0 || writer.highest(brick) == 0) continue;
        std::uint16_t* out = reached.next();
        if (out == nullptr) {
          flags |= rt::kFlagPutOff;
          return;
        }
        const Vec3 first = Vec3(kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk) - centre;
        const Excess excess =
            find_inside(bone.brick_field(brick), first, radius, amount, half, layers, out);
        if (excess.most > 0) reached.add(brick, excess, half);
      }
}

}  // namespace

void lower(Carver& carver, const Cut& cut, double amount, std::uint32_t& flags) BURR_RT {
  const Sides sides = sides_of(cut.centre + carver.advance() * cut.push, cut.mirror);
  Reached& reached = carver.reached();
  reached.begin();
  for (int s = 0; s < sides.count; ++s)
    gather_inside(carver, sides.centre[s], cut.radius + carver.least_margin(),
                  static_cast<int>(std::clamp(amount, 0.0, 65535.0)), sides.half[s], flags);
  reached.end(cut.mirror);
  const double energy_density = reached.mean_energy();
  const Reached::Done removed = reached.take(1, flags);
  Account& account = carver.writer().account();
  account.took(removed.hand, removed.image);
  account.asked += static_cast<double>(removed.hand);
  account.energy += static_cast<double>(removed.hand) * carver.writer().unit_m3() * energy_density;
}

}  // namespace burr::edit
