// haptics/scan_kernel_impl.h - the body of the scan kernel; included once per instruction set with
// BURR_KERNEL set to the namespace. Lanes never mix: the bits are the same everywhere.
//
// Distance from the burr's centre c to a disc (q, m, rd): w = c - q, a = m.w, l = w - a m (along
// the disc); beyond the rim the nearest point is on it: f = max(0, 1 - rd / |l|), v = a m + f l,
// distance |v|. rd = 0 is a plain point. Distance to a convex thing is convex, so n.p >= -gap keeps
// the whole straight move free of it (kernel.md).

#include <cmath>
#include <limits>

#include "burr/haptics/scan_kernel.h"

namespace burr::haptics::BURR_KERNEL {

using volume::kLanes;

void scan_blocks(const volume::VertexBlock* blocks, int count, const float* offset, float radius,
                 float within, Candidates& out) noexcept {
  const float reach = radius + within + 1.0F;  // no disc is larger than a voxel
  const float reach2 = reach * reach;
  const float ox = offset[0] - 1.0F, oy = offset[1] - 1.0F, oz = offset[2] - 1.0F;
  constexpr float kPlace = 1.0F / volume::kVertexScale, kNormal = 1.0F / 32767.0F,
                  kDisc = 1.0F / 65535.0F;
  for (int first = 0; first < count; first += kLanes) {
    const volume::VertexBlock& block = blocks[first / kLanes];
    alignas(64) float wx[kLanes], wy[kLanes], wz[kLanes];
    int near = 0;
    for (int l = 0; l < kLanes; ++l) {
      wx[l] = -(ox + static_cast<float>(block.x[l]) * kPlace);
      wy[l] = -(oy + static_cast<float>(block.y[l]) * kPlace);
      wz[l] = -(oz + static_cast<float>(block.z[l]) * kPlace);
      near |= wx[l] * wx[l] + wy[l] * wy[l] + wz[l] * wz[l] < reach2 ? 1 : 0;
    }
    if (near == 0) continue;

    alignas(64) float vx[kLanes], vy[kLanes], vz[kLanes], gap[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const float mx = static_cast<float>(block.nx[l]) * kNormal,
                  my = static_cast<float>(block.ny[l]) * kNormal,
                  mz = static_cast<float>(block.nz[l]) * kNormal;
      const float rd = static_cast<float>(block.rd[l]) * kDisc;
      const float a = mx * wx[l] + my * wy[l] + mz * wz[l];
      const float lx = wx[l] - a * mx, ly = wy[l] - a * my, lz = wz[l] - a * mz;
      const float along = std::sqrt(lx * lx + ly * ly + lz * lz) + 1e-12F;
      const float beyond = 1.0F - rd / along;
      const float f = beyond > 0.0F ? beyond : 0.0F;
      const float ux = a * mx + f * lx, uy = a * my + f * ly, uz = a * mz + f * lz;
      const float distance = std::sqrt(ux * ux + uy * uy + uz * uz) + 1e-12F;
      const float scale = 1.0F / distance;
      vx[l] = ux * scale;
      vy[l] = uy * scale;
      vz[l] = uz * scale;
      gap[l] = distance - radius;
    }
    const int lanes = count - first < kLanes ? count - first : kLanes;
    unsigned chosen = 0;
    for (int l = 0; l < kLanes; ++l) chosen |= (gap[l] < within ? 1U : 0U) << l;
    chosen &= (lanes == kLanes ? 0xFFFFU : (1U << lanes) - 1U);
    if (chosen == 0) continue;
    if (out.count + kLanes > Candidates::kMost) {
      out.full = true;
      return;
    }
    for (; chosen != 0; chosen &= chosen - 1) {
      const int l = __builtin_ctz(chosen);
      const int at = out.count++;
      out.nx[at] = vx[l];
      out.ny[at] = vy[l];
      out.nz[at] = vz[l];
      out.gap[at] = gap[l];
    }
  }
}

int most_violated(const Candidates& all, const float* p, float& worst) noexcept {
  const float px = p[0], py = p[1], pz = p[2];
  alignas(64) float least[kLanes];
  for (int l = 0; l < kLanes; ++l) least[l] = 0.0F;
  const int whole = all.count / kLanes * kLanes;
  for (int first = 0; first < whole; first += kLanes)
    for (int l = 0; l < kLanes; ++l) {
      const int j = first + l;
      const float s = all.nx[j] * px + all.ny[j] * py + all.nz[j] * pz + all.gap[j];
      least[l] = s < least[l] ? s : least[l];
    }
  float low = 0.0F;
  for (int l = 0; l < kLanes; ++l) low = least[l] < low ? least[l] : low;
  int tail = -1;
  for (int j = whole; j < all.count; ++j) {
    const float s = all.nx[j] * px + all.ny[j] * py + all.nz[j] * pz + all.gap[j];
    if (s < low) {
      low = s;
      tail = j;
    }
  }
  if (low >= 0.0F) return -1;
  worst = low;
  if (tail >= 0) return tail;
  for (int j = 0; j < whole; ++j)
    if (all.nx[j] * px + all.ny[j] * py + all.nz[j] * pz + all.gap[j] == low) return j;
  return -1;
}

}  // namespace burr::haptics::BURR_KERNEL
