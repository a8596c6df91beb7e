// volume/iso_kernel_impl.h - the body of the iso-vertex kernel; included once per instruction set
// by iso_kernel_{scalar,avx2,avx512}.cpp with BURR_KERNEL set to the namespace. Every lane does the
// same operations in the same order everywhere, and nothing is summed across lanes: the bits cannot
// differ.

#include <emmintrin.h>

#include <cmath>

#include "burr/volume/iso_kernel.h"

namespace burr::volume::BURR_KERNEL {
namespace {

constexpr int kRowStep = kPadRow, kSliceStep = kPadRow * kPadEdge;
constexpr int kMaxEdges = 3 * 9 * 8 * 8;  // with the border's own, rounded up generously

struct Edges {
  std::int16_t from[kMaxEdges + kLanes];  // index of the first voxel in the padded block
  std::uint8_t axis[kMaxEdges + kLanes];
  int count = 0;
};

// bit x+1: voxel x of the row is inside (the top bit of a field value)
inline unsigned row_mask(const std::uint16_t* row) noexcept {
  const __m128i lo = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row));
  const __m128i hi = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + 8));
  return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(lo, hi)));
}

inline void add_edges(Edges& edges, unsigned crossings, int row_start, std::uint8_t axis) noexcept {
  for (; crossings != 0; crossings &= crossings - 1) {
    edges.from[edges.count] = static_cast<std::int16_t>(row_start + __builtin_ctz(crossings));
    edges.axis[edges.count++] = axis;
  }
}

// Edges whose ends lie on different sides of the surface, in a fixed order.
inline void find_edges(const std::uint16_t* padded, unsigned low_border, Edges& edges) noexcept {
  unsigned mask[kPadEdge][kPadEdge];  // [z + 1][y + 1]
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y) mask[z][y] = row_mask(padded + kSliceStep * z + kRowStep * y);
  const unsigned own = 0x1FEU;                                        // x = 0..7
  const unsigned along_x = (low_border & 1U) != 0 ? 0x1FFU : 0x1FEU;  // x = -1 too at the border
  const int y_low = (low_border & 2U) != 0 ? 0 : 1, z_low = (low_border & 4U) != 0 ? 0 : 1;
  for (int z = z_low; z < 9; ++z)
    for (int y = y_low; y < 9; ++y) {
      const unsigned m = mask[z][y];
      const int start = kSliceStep * z + kRowStep * y;
      if (z > 0 && y > 0) add_edges(edges, (m ^ (m >> 1)) & along_x, start, 0);
      if (z > 0) add_edges(edges, (m ^ mask[z][y + 1]) & own, start, 1);
      if (y > 0) add_edges(edges, (m ^ mask[z + 1][y]) & own, start, 2);
    }
}

}  // namespace

int extract_vertices(const std::uint16_t* padded, unsigned low_border, float disc, VertexBlock* out,
                     int capacity) noexcept {
  Edges edges;
  find_edges(padded, low_border, edges);
  const int found = edges.count;
  if (found == 0) return 0;
  for (int l = 0; l < kLanes; ++l) {  // the last block repeats its last vertex
    edges.from[found + l] = edges.from[found - 1];
    edges.axis[found + l] = edges.axis[found - 1];
  }

  static constexpr int kStep[3] = {1, kRowStep, kSliceStep};
  for (int first = 0; first < found && first < capacity; first += kLanes) {
    alignas(64) float fa[kLanes], fb[kLanes];
    alignas(64) float ax[kLanes], ay[kLanes], az[kLanes], bx[kLanes], by[kLanes], bz[kLanes];
    alignas(64) float px[kLanes], py[kLanes], pz[kLanes], ex[kLanes], ey[kLanes], ez[kLanes];

    // gather: values at both ends, central differences at both ends
    for (int l = 0; l < kLanes; ++l) {
      const int a = edges.from[first + l], axis = edges.axis[first + l];
      const int b = a + kStep[axis];
      const int z = a / kSliceStep, y = (a - z * kSliceStep) / kRowStep,
                x = a - z * kSliceStep - y * kRowStep;
      fa[l] = static_cast<float>(padded[a]);
      fb[l] = static_cast<float>(padded[b]);
      // an edge that comes in from outside the grid has no differences at its outer end
      const int g = (x == 0 || y == 0 || z == 0) ? b : a;
      ax[l] = static_cast<float>(padded[g + 1] - padded[g - 1]);
      ay[l] = static_cast<float>(padded[g + kRowStep] - padded[g - kRowStep]);
      az[l] = static_cast<float>(padded[g + kSliceStep] - padded[g - kSliceStep]);
      bx[l] = static_cast<float>(padded[b + 1] - padded[b - 1]);
      by[l] = static_cast<float>(padded[b + kRowStep] - padded[b - kRowStep]);
      bz[l] = static_cast<float>(padded[b + kSliceStep] - padded[b - kSliceStep]);
      px[l] = static_cast<float>(x);
      py[l] = static_cast<float>(y);
      pz[l] = static_cast<float>(z);
      ex[l] = axis == 0 ? 1.0F : 0.0F;
      ey[l] = axis == 1 ? 1.0F : 0.0F;
      ez[l] = axis == 2 ? 1.0F : 0.0F;
    }

    VertexBlock& block = out[first / kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const float t =
          (32768.0F - fa[l]) / (fb[l] - fa[l]);  // where the edge meets the surface, 0..1
      block.x[l] =
          static_cast<std::uint16_t>(static_cast<int>((px[l] + t * ex[l]) * kVertexScale + 0.5F));
      block.y[l] =
          static_cast<std::uint16_t>(static_cast<int>((py[l] + t * ey[l]) * kVertexScale + 0.5F));
      block.z[l] =
          static_cast<std::uint16_t>(static_cast<int>((pz[l] + t * ez[l]) * kVertexScale + 0.5F));

      // Out of the bone: against the gradient, blended between the ends by how far each can be
      // trusted. A ramp of slope one has differences of kNominal; at a sharp edge they are smaller
      // on the side where the ramp has its kink (inside of a convex edge, outside of a concave
      // one), and the other end alone knows the face.
      constexpr float kNominal = 32768.0F;  // 2 voxels of kFieldPerVoxel
      const float aa = ax[l] * ax[l] + ay[l] * ay[l] + az[l] * az[l];
      const float bb = bx[l] * bx[l] + by[l] * by[l] + bz[l] * bz[l];
      float trust_a = (std::sqrt(aa) / kNominal - 0.75F) * 5.0F;
      float trust_b = (std::sqrt(bb) / kNominal - 0.75F) * 5.0F;
      trust_a = trust_a < 0.02F ? 0.02F : trust_a > 1.0F ? 1.0F : trust_a;
      trust_b = trust_b < 0.02F ? 0.02F : trust_b > 1.0F ? 1.0F : trust_b;
      const float wa = (1.0F - t + 0.05F) * trust_a, wb = (t + 0.05F) * trust_b;
      const float toward_air = fa[l] < fb[l] ? -1.0F : 1.0F;
      const float flat = 1e-3F * toward_air;  // the edge itself where the field is flat
      const float gx = -(wa * ax[l] + wb * bx[l]) + flat * ex[l];
      const float gy = -(wa * ay[l] + wb * by[l]) + flat * ey[l];
      const float gz = -(wa * az[l] + wb * bz[l]) + flat * ez[l];
      const float scale = 32767.0F / std::sqrt(gx * gx + gy * gy + gz * gz);
      block.nx[l] =
          static_cast<std::int16_t>(static_cast<int>(gx * scale + (gx < 0 ? -0.5F : 0.5F)));
      block.ny[l] =
          static_cast<std::int16_t>(static_cast<int>(gy * scale + (gy < 0 ? -0.5F : 0.5F)));
      block.nz[l] =
          static_cast<std::int16_t>(static_cast<int>(gz * scale + (gz < 0 ? -0.5F : 0.5F)));

      // where the two ends disagree (a sharp edge, noise) the disc shrinks to a point: its rim
      // would stand out
      const float ab = ax[l] * bx[l] + ay[l] * by[l] + az[l] * bz[l];
      float agree = (ab / (std::sqrt(aa) * std::sqrt(bb) + 1e-6F) - 0.90F) * 12.0F;
      agree = agree < 0.0F ? 0.0F : agree > 1.0F ? 1.0F : agree;
      block.rd[l] = static_cast<std::uint16_t>(static_cast<int>(disc * agree * 65535.0F));
    }
  }
  return found;
}

}  // namespace burr::volume::BURR_KERNEL
