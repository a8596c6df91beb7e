#include "burr/metrics/skeletonised.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "burr/metrics/identified.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/shares.h"

namespace burr::metrics {
namespace {

template <class Keep>
double share_of_layers(std::span<const Layer> layers, const Keep& keep) {
  double kept = 0, all = 0;
  for (const Layer& one : layers) {
    all += one.weight;
    if (keep(one.thickness)) kept += one.weight;
  }
  return kept / all;
}

}  // namespace

std::string too_coarse_for(double voxel, const ThinSettings& settings) {
  return too_coarse(voxel, std::min(settings.hi / 2, settings.lo > 0 ? 5 * settings.lo : kUnseen));
}

Thin thin_layer(std::span<const Layer> layers, const Worked& worked, const ThinSettings& settings,
                double error) {
  Thin out;
  const auto even = [&](double lo, double hi) {
    return share_of_layers(layers, [&](double t) { return t > lo && t <= hi; });
  };
  const auto bare = [&](double lo) {
    return share_of_layers(layers, [&](double t) { return t <= lo; });
  };
  out.even.value = even(settings.lo, settings.hi);
  out.even.threshold = settings.y;
  out.even.error = share_error(out.even.value, even(settings.lo + error, settings.hi - error),
                               even(settings.lo - error, settings.hi + error), layers.size());
  const double laid_bare = bare(settings.lo);
  out.bare = intact_mark(
      laid_bare, settings.z,
      share_error(laid_bare, bare(settings.lo - error), bare(settings.lo + error), layers.size()),
      worked);
  out.even.met = out.even.value >= settings.y && laid_bare <= settings.z;
  for (const Layer& one : layers) {
    if (one.thickness < out.thinnest) {
      out.thinnest = one.thickness;
      out.thinnest_at = one.at;
    }
    if (one.thickness > out.thickest) {
      out.thickest = one.thickness;
      out.thickest_at = one.at;
    }
  }
  std::vector<std::pair<double, double>> thickness;
  for (const Layer& one : layers) thickness.emplace_back(one.thickness, one.weight);
  out.median = weighted_quantile(std::move(thickness), 0.5);
  return out;
}

Assessed<Thin> skeletonised(const Cover& cover, const Worked& worked,
                            const ThinSettings& settings) {
  if (std::string reason = too_coarse_for(cover.voxel, settings); !reason.empty())
    return NotAssessable{std::move(reason)};
  std::vector<Layer> layers;
  for (const CoverSample& one : cover.samples)
    layers.push_back({one.thickness, static_cast<double>(one.surface.faces), one.surface.place});
  return thin_layer(layers, worked, settings, cover.error);
}

}  // namespace burr::metrics
