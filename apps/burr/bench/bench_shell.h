// apps/burr/bench/bench_shell.h - the bone for the surface benchmarks: a bumpy hollow shell like
// the vault of a skull, 3.6 million triangles at 512^3, 7 % of the voxels near its surface.
//
// Plain C++17 without burr headers: the independent program used for comparison makes exactly the
// same numbers from it. Units: voxels, field values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burr::bench {

// (size x size x size), x fastest; 0 air .. 32768 surface .. 65535 solid, a ramp of +-2 voxels
inline std::vector<std::uint16_t> shell_field(int size) {
  const auto n = static_cast<std::size_t>(size);
  std::vector<std::uint16_t> field(n * n * n);
  const float half = 0.5F * static_cast<float>(size - 1), outer = 0.455F * static_cast<float>(size);
  const float middle = 0.915F * outer, thick = 0.075F * outer, bump = 0.012F * outer;
  std::vector<float> wave(n);
  for (std::size_t i = 0; i < n; ++i)
    wave[i] = std::sin(static_cast<float>(i) * 40.0F / static_cast<float>(size));
  std::size_t at = 0;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i, ++at) {
        const float x = static_cast<float>(i) - half, y = static_cast<float>(j) - half,
                    z = static_cast<float>(k) - half;
        const float r2 = x * x + y * y + z * z;
        if (r2 > (outer + 4) * (outer + 4)) continue;
        const float r = std::sqrt(r2) + bump * wave[i] * wave[j] * wave[k];
        const float depth = thick - std::abs(r - middle);
        field[at] =
            static_cast<std::uint16_t>(std::clamp(32768.0F + depth * 16384.0F, 0.0F, 65535.0F));
      }
  return field;
}

}  // namespace burr::bench
