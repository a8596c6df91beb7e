// thermal/heat_rows.h - what the servo reports about heat: one row per tick, or one for several ticks.
//
// A row also reports that time has passed: push one at least every 50 ms while the session runs,
// without energy if nothing was cut. Thread: written by the servo, read by thermal/heat_worker.h.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::thermal {

// What the heat comes from; decides how much of it stays in the bone (HeatShare).
enum class Edge : std::uint8_t { flute, diamond, rubbing };

struct HeatRow {
  std::int64_t time_ns = 0;  // of the session; stands still while it is paused
  math::Vec3 place =
      math::Vec3::Zero();  // of the contact (and of the coolant), on the bone, world [m]
  double energy = 0;       // spent by the burr since the previous row [J]
  double radius = 0;       // of the burr, or half the thickness of another tool  [m]
  Edge edge = Edge::flute;
  bool irrigated = false;
  bool beside = false;      // of another place in the same moment: the coolant runs as it did
  bool start_over = false;  // the session is reset: all at start temperature
};

}  // namespace burr::thermal
