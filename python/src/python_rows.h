// python/src/python_rows.h - the rows of ticks as a structured array: names, units and order as in a
// recording (docs/use/recording_fields.md), three numbers of a vector in one field, quaternions w x
// y z.
//
// The layout is fixed; kRowsVersion grows with it.
#pragma once

#include <vector>

#include "burr/tick/rows.h"
#include "common.h"

namespace burr::python {

inline constexpr int kRowsVersion = 2;

struct Row;
[[nodiscard]] py::dtype row_type();
// Needs no GIL.
[[nodiscard]] std::vector<Row> rows_of(const std::vector<tick::TickRow>& rows);
// type: row_type(), which takes longer than a tick to make
[[nodiscard]] py::array rows_array(std::vector<Row>&& rows, const py::dtype& type = row_type());

struct Row {
  std::uint64_t tick;
  double hand[3], q[4], velocity[3], pedal;
  double proxy[3], normal[3], force[3], torque[3], unsent_torque[3], turn[3], depth;
  double asked, removed, debt, not_cut, added, energy, undone, moved;
  double spindle, cutting_torque, cutting_power;
  double tool_radius, tool_full_speed;
  double law_force[3], law_energy, law_torque;
  std::int64_t law_state;
  std::uint64_t hash;
  std::uint32_t buttons, flags;
  std::int32_t active, candidates, tool_number, tool_mode, tool_kind;
  float took, late;
  std::uint8_t valid, touching, coolant, mirrored;  // no gap at the end: numpy.save() keeps none
};

}  // namespace burr::python
