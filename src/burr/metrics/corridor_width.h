// metrics/corridor_width.h - how wide a drilled corridor is: where, going out from its axis, half of the bone
// stands again.
//
//     f(r) = removed bone / bone before the cut, in the ring between r and r + h/2 about the axis
//     width = 2 r where f falls through 1/2 for the first time, between two rings by a straight line
//
// Pores and a wall that leans do not count, because f is a share of the bone that was there. Of an uneven corridor it
// is the width that half of its wall reaches.
// Frame: world. Units: m. Thread: any.
#pragma once

#include <functional>
#include <optional>

#include "burr/math/vec3.h"
#include "burr/metrics/main_cut.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct CorridorAxis {
  math::Vec3 point = math::Vec3::Zero(), along = math::Vec3::UnitZ();  // along: unit
  std::function<bool(const math::Vec3&)> counts;  // which places are between the corridor's ends
};

// cut: what was removed for the corridor. none: no bone was there, or all of it in the region is gone.
[[nodiscard]] std::optional<double> corridor_width(const volume::Bone& before, const MainCut& cut,
                                                   const CorridorAxis& axis, const Region& region);

}  // namespace burr::metrics
