// metrics/plane_fit.h - how well a cut follows a planned plane.
//
// The plane is fitted by total least squares, weights by area, to the new surface within 3 mm of the
// planned plane. A saw or a burr leaves two faces; `side` tells which one the plan means.
//
//     offset   of the fitted plane from the planned one, along the plan's normal, at the plan's point
//     angle    between the two normals
//     uneven   95 % of the area lie this near to the fitted plane
//
// Frame: world. Units: m, rad. Not assessable: fewer than kFewestPoints points. Thread: any.
#pragma once

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct PlannedPlane {
  math::Vec3 point = math::Vec3::Zero();
  math::Vec3 normal = math::Vec3::UnitZ();  // unit
};

struct PlaneFitSettings {
  double near = 3e-3;  // farther surface is another cut [m]
  // Only the face whose normal is within 60 degrees of the plan's; false: both faces.
  bool one_face = true;
};

struct PlaneFit {
  double offset = 0;                         // signed, along the plan's normal [m]
  double angle = 0;                          // 0 .. pi/2 [rad]
  double uneven = 0;                         // [m]
  double rms = 0;                            // [m]
  double area = 0;                           // that was fitted [m^2]
  double error = 0;                          // of the offset: 0.1 h [m]
  math::Vec3 normal = math::Vec3::Zero();    // of the fit, towards the plan's
  math::Vec3 worst_at = math::Vec3::Zero();  // the point farthest from the fitted plane
};

[[nodiscard]] Assessed<PlaneFit> plane_fit(const volume::Bone& before, const volume::Bone& after,
                                           const PlannedPlane& plan, const Region& region,
                                           const PlaneFitSettings& settings);

}  // namespace burr::metrics
