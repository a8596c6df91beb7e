#include "burr/importing/cubic_labels.h"

#include <algorithm>
#include <cmath>

#include "burr/io/workers.h"

namespace burr::importing {

bool resample_labels(const LabelRegion& region, const Plan& plan,
                     const std::array<bool, 256>& solid, CubicLabels& out, Progress& progress) {
  const ImportSummary& s = plan.summary;
  const std::size_t nx = static_cast<std::size_t>(s.size.x()),
                    ny = static_cast<std::size_t>(s.size.y()),
                    voxels = nx * ny * static_cast<std::size_t>(s.size.z());
  out.labels.resize(voxels);
  const bool same = plan.scale.isOnes(0);
  if (!same) out.share.resize(voxels);
  struct Taps {
    int first = 0;
    std::vector<float> weights;
  };
  // tent weights: linear between voxels, wider where the new grid is coarser
  std::array<std::vector<Taps>, 3> taps;
  for (int a = 0; a < 3; ++a) {
    const double wide = std::max(1.0, plan.scale[a]);
    for (int n = 0; n < s.size[a]; ++n) {
      const double at = plan.first[a] + n * plan.scale[a];
      const int lo = std::clamp(static_cast<int>(std::floor(at - wide)) + 1, 0, s.roi_size[a] - 1),
                hi = std::clamp(static_cast<int>(std::ceil(at + wide)) - 1, lo, s.roi_size[a] - 1);
      Taps tap{lo, {}};
      double total = 0;
      for (int v = lo; v <= hi; ++v) total += std::max(0.0, 1 - std::abs(v - at) / wide);
      for (int v = lo; v <= hi; ++v)
        tap.weights.push_back(static_cast<float>(
            total > 0 ? std::max(0.0, 1 - std::abs(v - at) / wide) / total : 1.0));
      taps[static_cast<std::size_t>(a)].push_back(std::move(tap));
    }
  }
  return io::in_pieces(s.size.z(), progress, "making voxels cubic", [&](int z) {
    const auto k = static_cast<std::size_t>(z);
    std::array<float, 256> weight{};
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) {
        const Taps &tx = taps[0][i], &ty = taps[1][j], &tz = taps[2][k];
        std::array<std::uint8_t, 64> met{};
        std::size_t different = 0;
        float bone = 0;
        for (std::size_t c = 0; c < tz.weights.size(); ++c)
          for (std::size_t b = 0; b < ty.weights.size(); ++b) {
            const float w_row = tz.weights[c] * ty.weights[b];
            const std::uint8_t* row =
                region.row(ty.first + static_cast<int>(b), tz.first + static_cast<int>(c)) +
                tx.first;
            for (std::size_t a = 0; a < tx.weights.size(); ++a) {
              const std::uint8_t label = row[a];
              const float w = w_row * tx.weights[a];
              if (w == 0) continue;
              if (weight[label] == 0 && different < met.size()) met[different++] = label;
              weight[label] += w;
              if (solid[label]) bone += w;
            }
          }
        const std::size_t v = i + nx * (j + ny * k);
        const bool is_solid = bone >= 0.5F;
        float most = -1;
        for (std::size_t d = 0; d < different; ++d) {
          const std::uint8_t label = met[d];
          if (solid[label] == is_solid &&
              (weight[label] > most || (weight[label] == most && label > out.labels[v]))) {
            most = weight[label];
            out.labels[v] = label;
          }
        }
        for (std::size_t d = 0; d < different; ++d) weight[met[d]] = 0;
        if (!same)
          out.share[v] = static_cast<std::uint8_t>(
              std::clamp(std::lround(bone * 255.0F), is_solid ? 128L : 0L, is_solid ? 255L : 127L));
      }
  });
}

}  // namespace burr::importing
