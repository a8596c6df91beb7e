// report/evidence.h - where and when the evidence of an item is seen best.
//
// The moment that decided; otherwise the place and when it was cut; what was never cut is seen at the end. How it was
// worked (strokes, coolant) cannot be seen at one moment. Thread: any. Cost: a pass over the track, below 10 ms.
#pragma once

#include <cstddef>
#include <optional>

#include "burr/math/vec3.h"
#include "burr/report/scored.h"

namespace burr::report {

struct Evidence {
  std::optional<double> at_s;       // none: it cannot be seen at one moment
  bool at_end = false;              // that is the end of the session
  std::optional<math::Vec3> place;  // world, LPS [m]
};
// Of item n of the rubric. What was not assessable has none.
[[nodiscard]] Evidence evidence_of(const Scored& scored, std::size_t n);

}  // namespace burr::report
