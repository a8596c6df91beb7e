// metrics/identified.h - was a structure found: seen through a thin layer of bone that was reached
// by cutting?
//
//     faces   share = weight of the samples with tau <= x  /  weight of the patch
//     along   the course is divided into slices of 1 mm; a slice is found if tau <= x over half of what faces the
//             surgeon (`field`): one opened cell shows a spot, not the nerve. share = slices found / slices. For tubes,
//             whose far side is never seen.
//
// met: share >= y. x = 1.0 mm, y = 0.3 (faces) or 0.6 (along) are defaults that nobody has
// calibrated. Not assessable: voxels coarser than x / 2. Thread: any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/tube_course.h"

namespace burr::metrics {

struct IdentifiedSettings {
  double x = 1.0e-3;                  // most bone over it       [m]
  std::optional<double> y = {};       // share required; not given: 0.3, or 0.6 with a course
  std::optional<Course> course = {};  // of a tube
  double field = 0.5;                 // with a course: share of a slice's patch that must be seen
};

struct Identified {
  Mark mark;  // share
  struct Slice {
    double from = 0;               // along the course [m]
    double cover = kUnseen;        // the least tau in it [m]
    double field_cover = kUnseen;  // tau is no more over `field` of it [m]
  };
  std::vector<Slice> slices;                 // with a course: those that hold samples
  double least_cover = kUnseen;              // tau [m]
  math::Vec3 least_at = math::Vec3::Zero();  // where; only if least_cover is finite
  math::Vec3 worst_at = math::Vec3::Zero();  // the sample, or the slice's best one, with most cover
  double worst_cover = 0;                    // kUnseen: not seen through the cavity at all
};

[[nodiscard]] Assessed<Identified> identified(const Cover& cover,
                                              const IdentifiedSettings& settings);

// Why voxels of this size do not do for a length; empty: they do.
[[nodiscard]] std::string too_coarse(double voxel, double needed);

}  // namespace burr::metrics
