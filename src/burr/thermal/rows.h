// thermal/rows.h - what the servo tells about heat: one row a tick, or one for several ticks.
//
// A row also says that time has passed: push one at least every 50 ms while the session runs, with
// no energy when nothing was cut. Thread: written by the servo, read by thermal/worker.h.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::thermal {

// What heats: decides how much stays in the bone (StayingShare).
enum class Edge : std::uint8_t { flute, diamond, rubbing };

struct HeatRow {
  std::int64_t time_ns = 0;  // of the session; does not pass while the session pauses
  math::Vec3 place =
      math::Vec3::Zero();  // of the contact, on the bone, world; of the coolant too [m]
  double energy = 0;       // spent by the burr since the row before  [J]
  double radius = 0;       // of the burr  [m]
  Edge edge = Edge::flute;
  bool irrigated = false;
  bool start_over = false;  // the session begins anew: all is as warm as at the start
};

}  // namespace burr::thermal
