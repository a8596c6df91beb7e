// metrics/cavity_shape.h - depth, walls, floor and outline of a cavity that was cut to a plan.
//
//     floor    new surface with normals within 30 degrees of a;  walls: 60 to 120 degrees
//     depth    median over the floor of the bone that was above it, along a, up to the old surface
//     uneven   rms of the floor off its own plane
//     taper    mean over the walls of the angle of their normal to a, less 90 degrees: below 0 the
//              cavity widens to its mouth, above 0 it narrows
//     outline  95 % of the cavity's rim lie this near to the border of the planned shape
//
// a: from the bone to the surgeon. Normals point out of the bone, so into the cavity. Means and
// medians are weighted by area. Points within two voxels of the old surface count for the rim only,
// and those within two voxels of the floor's edge have normals that round the corner: the mean angle
// of walls therefore leaves out points lower than two voxels above the floor's median.
// Frame: world. Units: m, rad. Thread: any.
#pragma once

#include <optional>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct CavityShape {
  double depth = 0;               // [m]
  double uneven = 0;              // [m]
  double area = 0;                // of the floor [m^2]
  double tilt = 0;                // of the floor's plane to a [rad]
  std::optional<double> taper;    // none: hardly any walls [rad]
  std::optional<double> outline;  // none: no plan, or no rim [m]
  double error = 0;               // of the depth: 0.1 h [m]
  math::Vec3 deepest = math::Vec3::Zero();
};

// plan: the planned cavity, for the outline; empty: none. Not assessable: fewer than kFewestPoints
// points of floor.
[[nodiscard]] Assessed<CavityShape> cavity_shape(const volume::Bone& before,
                                                 const volume::Bone& after,
                                                 const math::Vec3& towards, const Region& region,
                                                 const Region& plan);

}  // namespace burr::metrics
