#include "python_rows.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace burr::python {
namespace {

struct Field {
  const char* name;
  const char* type;  // of numpy
  int count;
  std::size_t at;
};
// NOLINTBEGIN(cppcoreguidelines-macro-usage)
#define BURR_FIELD(name, type, count, member) \
  { name, type, count, offsetof(Row, member) }
const Field kFields[] = {
    BURR_FIELD("tick", "u8", 1, tick),
    BURR_FIELD("hand_m", "f8", 3, hand),
    BURR_FIELD("hand_q", "f8", 4, q),
    BURR_FIELD("hand_v_m_per_s", "f8", 3, velocity),
    BURR_FIELD("pedal", "f8", 1, pedal),
    BURR_FIELD("buttons", "u4", 1, buttons),
    BURR_FIELD("hand_valid", "?", 1, valid),
    BURR_FIELD("proxy_m", "f8", 3, proxy),
    BURR_FIELD("normal", "f8", 3, normal),
    BURR_FIELD("force_n", "f8", 3, force),
    BURR_FIELD("torque_nm", "f8", 3, torque),
    BURR_FIELD("unsent_torque_nm", "f8", 3, unsent_torque),
    BURR_FIELD("turn_rad", "f8", 3, turn),
    BURR_FIELD("depth_m", "f8", 1, depth),
    BURR_FIELD("active", "i4", 1, active),
    BURR_FIELD("candidates", "i4", 1, candidates),
    BURR_FIELD("touching", "?", 1, touching),
    BURR_FIELD("flags", "u4", 1, flags),
    BURR_FIELD("asked_m3", "f8", 1, asked),
    BURR_FIELD("removed_m3", "f8", 1, removed),
    BURR_FIELD("debt_m3", "f8", 1, debt),
    BURR_FIELD("not_cut_m3", "f8", 1, not_cut),
    BURR_FIELD("added_m3", "f8", 1, added),
    BURR_FIELD("cutting_energy_j", "f8", 1, energy),
    BURR_FIELD("undone_m3", "f8", 1, undone),
    BURR_FIELD("moved_m3", "f8", 1, moved),
    BURR_FIELD("spindle_rad_per_s", "f8", 1, spindle),
    BURR_FIELD("cutting_torque_nm", "f8", 1, cutting_torque),
    BURR_FIELD("cutting_power_w", "f8", 1, cutting_power),
    BURR_FIELD("tool_radius_m", "f8", 1, tool_radius),
    BURR_FIELD("tool_full_speed_rad_per_s", "f8", 1, tool_full_speed),
    BURR_FIELD("tool_kind", "i4", 1, tool_kind),
    BURR_FIELD("tool_mode", "i4", 1, tool_mode),
    BURR_FIELD("tool_number", "i4", 1, tool_number),
    BURR_FIELD("coolant", "?", 1, coolant),
    BURR_FIELD("mirrored", "?", 1, mirrored),
    BURR_FIELD("law_state", "i8", 1, law_state),
    BURR_FIELD("law_force_n", "f8", 3, law_force),
    BURR_FIELD("law_energy_j", "f8", 1, law_energy),
    BURR_FIELD("law_torque_nm", "f8", 1, law_torque),
    BURR_FIELD("took_us", "f4", 1, took),
    BURR_FIELD("late_us", "f4", 1, late),
    BURR_FIELD("hash", "u8", 1, hash),
};
#undef BURR_FIELD
// NOLINTEND(cppcoreguidelines-macro-usage)

void put(const math::Vec3& from, double* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

Row row_of(const tick::TickRow& row) {
  Row out = {};
  out.tick = row.tick;
  put(row.hand.world_from_tool.p, out.hand);
  const math::Quat& q = row.hand.world_from_tool.q;
  const double turn[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(turn, turn + 4, out.q);
  put(row.hand.velocity, out.velocity);
  out.pedal = row.hand.pedal;
  out.buttons = row.hand.buttons;
  out.valid = row.hand.valid ? 1 : 0;
  put(row.contact.proxy, out.proxy);
  put(row.contact.normal, out.normal);
  put(row.contact.force, out.force);
  put(row.contact.torque, out.torque);
  put(row.contact.unsent_torque, out.unsent_torque);
  put(row.contact.turn, out.turn);
  out.depth = row.contact.depth;
  out.active = row.contact.active;
  out.candidates = row.contact.candidates;
  out.touching = row.contact.touching ? 1 : 0;
  out.flags = row.contact.flags;
  out.asked = row.ledger.asked;
  out.removed = row.ledger.removed;
  out.debt = row.ledger.debt;
  out.not_cut = row.ledger.not_cut;
  out.added = row.ledger.added;
  out.energy = row.ledger.energy;
  out.undone = row.ledger.undone;
  out.moved = row.ledger.moved;
  out.spindle = row.spindle_rad_s;
  out.cutting_torque = row.cutting_nm;
  out.cutting_power = row.cutting_w;
  out.tool_radius = row.tool.radius;
  out.tool_full_speed = row.tool.full_speed;
  out.tool_kind = static_cast<std::int32_t>(row.tool.kind);
  out.tool_mode = static_cast<std::int32_t>(row.tool.mode);
  out.tool_number = row.tool.number;
  out.coolant = row.tool.irrigated ? 1 : 0;
  out.mirrored = row.tool.mirror_axis >= 0 ? 1 : 0;
  out.law_state = row.law.state;
  put(row.law.force, out.law_force);
  out.law_energy = row.law.energy;
  out.law_torque = row.law.torque;
  out.took = row.took_us;
  out.late = row.late_us;
  out.hash = row.hash;
  return out;
}

}  // namespace

py::dtype row_type() {
  py::list names, types, places;
  // numpy.save() wants them as they lie in memory
  std::vector<Field> fields(std::begin(kFields), std::end(kFields));
  std::sort(fields.begin(), fields.end(),
            [](const Field& a, const Field& b) { return a.at < b.at; });
  for (const Field& field : fields) {
    names.append(field.name);
    types.append(field.count == 1 ? py::object(py::str(field.type))
                                  : py::make_tuple(field.type, py::make_tuple(field.count)));
    places.append(field.at);
  }
  return py::dtype(names, types, places, sizeof(Row));
}

std::vector<Row> rows_of(const std::vector<tick::TickRow>& rows) {
  std::vector<Row> out;
  out.reserve(rows.size());
  for (const tick::TickRow& row : rows) out.push_back(row_of(row));
  return out;
}

py::array rows_array(std::vector<Row>&& rows, const py::dtype& type) {
  const auto count = static_cast<py::ssize_t>(rows.size());
  return as_array(std::move(rows), {count}, type);
}

}  // namespace burr::python
