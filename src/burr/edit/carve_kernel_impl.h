// edit/carve_kernel_impl.h - the body of the carve kernel; included once per instruction set with
// BURR_KERNEL set to the namespace.
//
// A ball of radius r leaves at most floor = 1/2 + (|p - c| - r) / (2 kRamp) of a voxel; the excess
// is what stands above.

#include <cmath>

#include "burr/edit/carve_kernel.h"

namespace burr::edit::BURR_KERNEL {
namespace {

constexpr int kEdge = 8, kRow = 16;  // two rows of voxels at a time

// volume_of.h, on an int lane
inline std::int32_t volume_units(std::int32_t field) noexcept {
  std::int32_t d = field - 32768;
  d = d < -16384 ? -16384 : d;
  d = d > 16384 ? 16384 : d;
  const std::int32_t y = (d * d) >> 14;
  std::int32_t slope = 11141 + ((-1638 * y) >> 14);
  slope = -23425 + ((slope * y) >> 14);
  slope = 22114 + ((slope * y) >> 14);
  return 98304 + ((3 * d * slope) >> 12);
}

// field value a ball's own material would have at distance d from its centre
constexpr float kPerVoxel = 16384.0F;  // kFieldPerVoxel

inline float left_by(float x, float y, float z, const float* ball) noexcept {
  const float dx = x + ball[0], dy = y + ball[1], dz = z + ball[2];
  float f = 32768.0F + (std::sqrt(dx * dx + dy * dy + dz * dz) - ball[3]) * kPerVoxel;
  f = f < 0.0F ? 0.0F : f;
  return f > 65535.0F ? 65535.0F : f;
}

}  // namespace

Excess find_excess(const std::uint16_t* field, const float* ball, const float* keep_out,
                   int deposit, std::uint16_t* out) noexcept {
  Excess total;
  alignas(64) std::int32_t units[kRow] = {}, most[kRow] = {};
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; y += 2) {
      const std::uint16_t* from = field + kEdge * (y + kEdge * z);
      std::uint16_t* to = out + kEdge * (y + kEdge * z);
      if (deposit == 0) {
        for (int l = 0; l < kRow; ++l) {
          const auto floor_value = static_cast<std::int32_t>(
              left_by(static_cast<float>(l & 7), static_cast<float>(y + (l >> 3)),
                      static_cast<float>(z), ball) +
              0.5F);
          const std::int32_t have = from[l];
          std::int32_t excess = have - floor_value;
          excess = excess < 0 ? 0 : excess;
          to[l] = static_cast<std::uint16_t>(excess);
          units[l] += volume_units(have) - volume_units(have - excess);
          most[l] = excess > most[l] ? excess : most[l];
        }
      } else {
        for (int l = 0; l < kRow; ++l) {
          const float x = static_cast<float>(l & 7), yy = static_cast<float>(y + (l >> 3)),
                      zz = static_cast<float>(z);
          float ceiling = 65535.0F - left_by(x, yy, zz, ball);
          const float beside = keep_out[3] >= 0.0F ? left_by(x, yy, zz, keep_out) : 65535.0F;
          ceiling = beside < ceiling ? beside : ceiling;
          const std::int32_t have = from[l];
          std::int32_t lack = static_cast<std::int32_t>(ceiling + 0.5F) - have;
          lack = lack < 0 ? 0 : lack;
          to[l] = static_cast<std::uint16_t>(lack);
          units[l] += volume_units(have + lack) - volume_units(have);
          most[l] = lack > most[l] ? lack : most[l];
        }
      }
    }
  for (int l = 0; l < kRow; ++l) {
    total.units += units[l];
    total.most = most[l] > total.most ? most[l] : total.most;
  }
  return total;
}

Applied apply_excess(const std::uint16_t* field, const std::uint16_t* excess, std::int32_t share,
                     int deposit, std::uint16_t* to) noexcept {
  Applied total;
  alignas(64) std::int32_t units[kRow] = {}, most[kRow] = {}, highest[kRow] = {}, column[kRow] = {};
  const std::int32_t sign = deposit == 0 ? -1 : 1;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; y += 2) {
      const int at = kEdge * (y + kEdge * z);
      alignas(64) std::int32_t step[kRow];
      std::int32_t lower = 0, upper = 0;
      for (int l = 0; l < kRow; ++l) {
        // 65535 * 65536 + 32768 just fits an unsigned 32-bit number
        step[l] = static_cast<std::int32_t>(
            (static_cast<std::uint32_t>(excess[at + l]) * static_cast<std::uint32_t>(share) +
             32768U) >>
            16);
        const std::int32_t have = field[at + l], now = have + sign * step[l];
        to[at + l] = static_cast<std::uint16_t>(now);
        units[l] += sign * (volume_units(now) - volume_units(have));
        most[l] = step[l] > most[l] ? step[l] : most[l];
        highest[l] = now > highest[l] ? now : highest[l];
        column[l] |= step[l];
      }
      for (int l = 0; l < kEdge; ++l) {
        lower |= step[l];
        upper |= step[l + kEdge];
      }
      total.rows |= (lower != 0 ? 1ULL : 0ULL) << (y + kEdge * z);
      total.rows |= (upper != 0 ? 1ULL : 0ULL) << (y + 1 + kEdge * z);
    }
  for (int l = 0; l < kRow; ++l) {
    total.units += units[l];
    total.most = most[l] > total.most ? most[l] : total.most;
    total.highest = highest[l] > total.highest ? highest[l] : total.highest;
    total.columns |= (column[l] != 0 ? 1U : 0U) << (l & 7);
  }
  return total;
}

}  // namespace burr::edit::BURR_KERNEL
