// metrics/intact_plate.h - is the bone over a structure without holes: the area that lies bare,
// seen through the cavity.
//
//     area = sum of the areas for which the samples stand that are seen (tau <= 0.1 mm) and over which the plate is
//            gone: along the normal at most 0.1 mm stands of the first layer of bone that was there
//
// met: area <= 1 mm^2 (not calibrated). By the condition on the cavity (metrics/cover.h) the area is
// 0 before the first cut. Samples whose plate was thinner than 2 h before the cut leave the patch,
// because such a plate may have holes of its own in the field; if they are more than half of it, the
// measure is not assessable.
//
// Looks aslant also see 0.15 mm of structure under a hole's rim: the normal tells that from the hole. `error` is 0.6 voxel of
// the hole's border. Make the Cover with many samples (most_samples = 5000).
// Thread: any.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/measured.h"

namespace burr::metrics {

struct IntactPlateSettings {
  double most_area = 1e-6;  // A [m^2]
  double bare = 0.1e-3;     // tau of a bare sample: at most [m]
};

struct IntactPlate {
  Mark mark;  // area [m^2]
  struct Hole {
    double area = 0;                     // [m^2]
    math::Vec3 at = math::Vec3::Zero();  // mean of its samples, world
    std::size_t samples = 0;
  };
  std::vector<Hole> holes;  // connected pieces of the bare area, the largest first
  double thin_share = 0;    // of the weight, left out: plate thinner than 2 h before the cut
};

[[nodiscard]] Assessed<IntactPlate> intact_plate(const Cover& cover, const Worked& worked,
                                                 const IntactPlateSettings& settings);

}  // namespace burr::metrics
