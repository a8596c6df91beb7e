#include "burr/haptics/thin.h"

#include <algorithm>
#include <cmath>

namespace burr::haptics {
namespace {

constexpr int kEdge = 16;  // bins along an edge of the cube of directions
constexpr int kBins = 6 * kEdge * kEdge;

// The bin of a direction: which face of the cube it passes through, and where.
int bin_of(float x, float y, float z) BURR_RT {
  const float ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
  int face = 0;
  float along = x, u = y, v = z, most = ax;
  if (ay >= ax && ay >= az) {
    face = 2;
    along = y;
    u = x;
    v = z;
    most = ay;
  } else if (az >= ax && az >= ay) {
    face = 4;
    along = z;
    u = x;
    v = y;
    most = az;
  }
  if (along < 0) ++face;
  const float scale = most > 0 ? 0.5F * kEdge / most : 0.0F;
  const auto cell = [scale](float w) {
    return std::clamp(static_cast<int>(w * scale + 0.5F * kEdge), 0, kEdge - 1);
  };
  return (face * kEdge + cell(u)) * kEdge + cell(v);
}

}  // namespace

void thin(Candidates& all) BURR_RT {
  int nearest[kBins];
  std::fill_n(nearest, kBins, -1);
  for (int j = 0; j < all.count; ++j) {
    int& best = nearest[bin_of(all.nx[j], all.ny[j], all.nz[j])];
    if (best < 0 || all.gap[j] < all.gap[best]) best = j;
  }
  int kept = 0;
  for (int j = 0; j < all.count; ++j) {
    if (nearest[bin_of(all.nx[j], all.ny[j], all.nz[j])] != j) continue;
    all.nx[kept] = all.nx[j];
    all.ny[kept] = all.ny[j];
    all.nz[kept] = all.nz[j];
    all.gap[kept] = all.gap[j];
    ++kept;
  }
  all.count = kept;
}

}  // namespace burr::haptics
