#include "burr/metrics/skeletonised.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "burr/metrics/identified.h"
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

double median_of(std::span<const Layer> layers) {
  std::vector<std::pair<double, double>> sorted;
  double all = 0, sum = 0;
  for (const Layer& one : layers) {
    sorted.emplace_back(one.thickness, one.weight);
    all += one.weight;
  }
  std::sort(sorted.begin(), sorted.end());
  for (const auto& [thickness, weight] : sorted) {
    sum += weight;
    if (2 * sum >= all) return thickness;
  }
  return kUnseen;
}

}  // namespace

Thin thin_layer(std::span<const Layer> layers, const ThinSettings& settings, double error) {
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
  out.bare.value = bare(settings.lo);
  out.bare.threshold = settings.z;
  out.bare.error = share_error(out.bare.value, bare(settings.lo - error), bare(settings.lo + error),
                               layers.size());
  out.bare.met = out.bare.value <= settings.z;
  out.even.met = out.even.value >= settings.y && out.bare.met;
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
  out.median = median_of(layers);
  return out;
}

Assessed<Thin> skeletonised(const Cover& cover, const ThinSettings& settings) {
  const double needed = std::min(settings.hi / 2, settings.lo > 0 ? 5 * settings.lo : kUnseen);
  if (std::string reason = too_coarse(cover.voxel, needed); !reason.empty())
    return NotAssessable{std::move(reason)};
  std::vector<Layer> layers;
  for (const CoverSample& one : cover.samples)
    layers.push_back({one.thickness, static_cast<double>(one.surface.faces), one.surface.place});
  return thin_layer(layers, settings, cover.error);
}

}  // namespace burr::metrics
