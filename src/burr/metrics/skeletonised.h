// metrics/skeletonised.h - was the bone over a structure thinned evenly, without laying it bare?
//
//     even = share of the patch with lo < t <= hi        bare = share with t <= lo
//
// met: even >= y and bare <= z. That hardly anything is bare is a merit only of somebody who worked
// (measured.h); what is thin was seen through the cavity, so it needs no such condition. Defaults lo 0.1, hi 1.5 mm, y 0.6, z 0.1: nobody has calibrated
// them. Not assessable: voxels coarser than hi / 2, or than 5 lo, whose error 0.2 h hides lo.
// Thread: any.
#pragma once

#include <span>
#include <string>

#include "burr/math/vec3.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/measured.h"

namespace burr::metrics {

struct ThinSettings {
  double lo = 0.1e-3, hi = 1.5e-3;  // [m]
  double y = 0.6, z = 0.1;          // shares
};

struct Thin {
  Mark even;                // share with lo < t <= hi; its `met` is that of the whole measure
  Mark bare;                // share with t <= lo; met: at most z, and earned
  double median = kUnseen;  // of t, by weight [m]
  math::Vec3 thinnest_at = math::Vec3::Zero(), thickest_at = math::Vec3::Zero();
  double thinnest = kUnseen, thickest = 0;  // kUnseen: not seen through the cavity [m]
};

[[nodiscard]] Assessed<Thin> skeletonised(const Cover& cover, const Worked& worked,
                                          const ThinSettings& settings);

// One place of a layer: how thick it is, and its weight.
struct Layer {
  double thickness = 0;  // [m]
  double weight = 0;
  math::Vec3 at = math::Vec3::Zero();
};
// The same for any layer: the arithmetic that both measures of thin bone share. error: of the
// thickness [m]. The weights must not be all zero.
[[nodiscard]] Thin thin_layer(std::span<const Layer> layers, const Worked& worked,
                              const ThinSettings& settings, double error);

// Why voxels of this size do not do for these thresholds; empty: they do.
[[nodiscard]] std::string too_coarse_for(double voxel, const ThinSettings& settings);

}  // namespace burr::metrics
